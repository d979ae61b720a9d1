"""What a managing system is given, and what it must do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from os import PathLike
from typing import TYPE_CHECKING, Protocol

import numpy as np
from py_trees.behaviour import Behaviour

from rosa_core import KnowledgeBase
from rosa_core.clock import Stopwatch
from rosa_core.kb import Event
from suave.missions.leaves import mission_leaves
from suave.robot import SuaveRobot
from task_layer.bt import SkillAction, TreeRunner, load_tree
from task_layer.skill import Skill

if TYPE_CHECKING:
    from task_layer.mission_part import MissionPart

TICK_PERIOD = 0.5
"""Seconds between ticks when nothing happens; whatever ends an action ticks at once."""


@dataclass(frozen=True, slots=True)
class ManagedMission:
    """A mission to be managed.

    Attributes:
        robot: the managed system; its diagnostics are in ``robot.on_diagnostics``.
        extended: whether the robot has a battery to look after.
        tree_file: the mission as a tree, in BehaviorTree.CPP XML.
        skills: how each action is carried out.
        stopwatch: everything that the managing system does runs inside ``stopwatch.running()``.
        on_kb_event: hears the events of a knowledge base, if the managing system has one.
        on_raise: hears of a behaviour, a step or a sensor that raised, and of the exception.
        rng: for whatever a managing system leaves to chance; the run's seed decides it.
    """

    robot: SuaveRobot
    extended: bool
    tree_file: PathLike[str]
    skills: dict[str, Skill]
    stopwatch: Stopwatch
    on_kb_event: Callable[[Event], None]
    on_raise: Callable[[MissionPart, Exception], None]
    rng: np.random.Generator

    def managed_tree(self) -> Behaviour:
        """The mission's tree on a knowledge base: actions are requested of it, and it says which are feasible."""
        leaves = mission_leaves(self.robot)
        for action in self.actions:
            leaves.add(action, self.skills[action])
        return load_tree(self.tree_file, leaves)

    def unguarded_tree(self, skill_of: Callable[[str], Skill]) -> Behaviour:
        """The mission's tree without a knowledge base: every action counts as feasible.

        Args:
            skill_of: gives the skill that performs an action; asked for the actions that the tree names.
        """
        leaves = mission_leaves(self.robot).count_all_as_feasible()
        for action in self.actions:
            leaves.add(action, partial(_performing, skill_of, action), ports=())
        return load_tree(self.tree_file, leaves)

    @property
    def actions(self) -> tuple[str, ...]:
        """The actions that are the managing system's to perform."""
        return tuple(action for action in self.skills if action != "start_robot")

    def runner(self, tree: Behaviour, kb: KnowledgeBase | None = None, *, period: float = TICK_PERIOD) -> TreeRunner:
        """The runner of a tree, whose ticks are timed as the managing system's."""
        return TreeRunner(
            tree,
            kb,
            period=period,
            clock=self.robot.clock,
            around_tick=self.stopwatch.running,
            on_raise=self.on_raise,
        )

    def call_every(self, period: float, act: Callable[[], None]) -> None:
        """Call a part of the managing system every ``period`` seconds, at a phase left to chance.

        Nothing in a real system keeps a managing system in step with the monitors. In step, all its reactions would
        take equally long, no time or a whole period, by an accident of the simulation.
        """
        clock = self.robot.clock

        def timed() -> None:
            with self.stopwatch.running():
                act()

        clock.call_every(period, timed, start=clock.now() + period * self.rng.random())


class Manager(Protocol):
    """A managing system: makes the runner that flies the mission."""

    def __call__(self, mission: ManagedMission) -> TreeRunner:
        """Connect to the robot; the runner's ticks are the managing system's only other occasion to act."""
        ...


def _performing(skill_of: Callable[[str], Skill], action: str, name: str) -> Behaviour:
    return SkillAction(name, skill_of(action))
