"""What a managing system is given, and what it must do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Protocol

from py_trees.behaviour import Behaviour

from agv_example.missions.mission_config import MissionConfig
from agv_example.navigator import RouteDecision
from agv_example.skills import GoalQueue
from agv_example.world import AgvRobot
from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.kb import Event
from rosa_simulation.run_recorder import RunRecorder
from task_layer.bt import TreeRunner

TICK_PERIOD = 0.5
"""Seconds between ticks when nothing happens; whatever ends a leg ticks at once."""


@dataclass(frozen=True, slots=True)
class ManagedMission:
    """A mission to be managed.

    Attributes:
        robot: the managed system; its diagnostics are in ``robot.on_diagnostics``.
        config: the mission.
        model: what the robot knows of itself.
        recorder: everything that the managing system does runs inside ``recorder.stopwatch.running()``.
        on_kb_event: hears the events of a knowledge base, if the managing system has one.
        on_route: hears of every route that is decided on.
    """

    robot: AgvRobot
    config: MissionConfig
    model: KnowledgeModel
    recorder: RunRecorder
    on_kb_event: Callable[[Event], None]
    on_route: Callable[[RouteDecision], None]

    @property
    def goal_queue(self) -> GoalQueue:
        """The mission's goals in turn."""
        return GoalQueue(self.robot, self.config.goals)

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
    """A managing system: makes the runner that carries out the mission."""

    def __call__(self, mission: ManagedMission) -> TreeRunner:
        """Connect to the robot; the runner's ticks are the managing system's only other occasion to act."""
        ...


def load_agv_model(config: MissionConfig) -> KnowledgeModel:
    """The counted model of the paper, what missions need besides, and what this one adds."""
    models = Path(str(files("agv_example.models")))
    ours = [models / name for name in ("agv.yaml", "agv_move.yaml", "agv_mission.yaml")]
    return KnowledgeModel.load(*ours, *config.models)
