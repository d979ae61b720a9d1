"""What a managing system is given, and what it must do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Protocol

from py_trees.behaviour import Behaviour

from rosa_core import KnowledgeBase
from rosa_simulation.run_recorder import RunRecorder
from task_layer.bt import TreeRunner
from task_layer.skill import Skill
from uav_example.missions import TREE_FILE
from uav_example.robot import UavRobot

TICK_PERIOD = 0.5
"""Seconds between ticks when nothing happens; whatever ends an action ticks at once."""


@dataclass(frozen=True, slots=True)
class ManagedMission:
    """A mission to be managed.

    Attributes:
        robot: the managed system; its diagnostics are in ``robot.on_diagnostics``.
        skills: how each action is carried out.
        recorder: everything that the managing system does runs inside ``recorder.stopwatch.running()``; the events of
            a knowledge base go to ``recorder.narrator.on_kb_event``.
        tree_file: the mission as a tree, in BehaviorTree.CPP XML.
    """

    robot: UavRobot
    skills: Mapping[str, Skill]
    recorder: RunRecorder
    tree_file: PathLike[str] = TREE_FILE

    def runner(self, tree: Behaviour, kb: KnowledgeBase | None = None) -> TreeRunner:
        """The runner of a tree, whose ticks are timed as the managing system's."""
        return TreeRunner(
            tree,
            kb,
            period=TICK_PERIOD,
            clock=self.robot.clock,
            around_tick=self.recorder.stopwatch.running,
            on_raise=self.recorder.on_raise,
        )


class Manager(Protocol):
    """A managing system: makes the runner that flies the mission."""

    def __call__(self, mission: ManagedMission) -> TreeRunner:
        """Connect to the robot; the runner's ticks are the managing system's only other occasion to act."""
        ...
