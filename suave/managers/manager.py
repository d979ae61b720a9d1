"""What a managing system is given, and what it must do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from py_trees.behaviour import Behaviour

from rosa_core import KnowledgeBase
from rosa_core.clock import Stopwatch
from rosa_core.kb import Event
from suave.missions.trees import Perform
from suave.robot import SuaveRobot
from task_layer.bt import TreeRunner
from task_layer.skill import Skill, SkillStatus

if TYPE_CHECKING:
    from task_layer.pddl.execution import Named

TICK_PERIOD = 0.5
"""Seconds between ticks when nothing happens; whatever ends an action ticks at once."""


@dataclass(frozen=True, slots=True)
class ManagedMission:
    """A mission to be managed.

    Attributes:
        robot: the managed system; its diagnostics are in ``robot.on_diagnostics``.
        extended: whether the robot has a battery to look after.
        make_tree: makes the mission's tree from what performs its actions.
        skills: how each action is carried out.
        stopwatch: everything that the managing system does runs inside ``stopwatch.running()``.
        on_kb_event: hears the events of a knowledge base, if the managing system has one.
        on_raise: hears of a behaviour, a step or a sensor that raised, and of the exception.
        rng: for whatever a managing system leaves to chance; the run's seed decides it.
    """

    robot: SuaveRobot
    extended: bool
    make_tree: Callable[[SuaveRobot, Perform], Behaviour]
    skills: dict[str, Skill]
    stopwatch: Stopwatch
    on_kb_event: Callable[[Event], None]
    on_raise: Callable[[Named, Exception], None]
    rng: np.random.Generator

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


class Accompanied(Skill):
    """A skill with something to do when it begins and when it is over.

    Args:
        skill: how the action is carried out.
        begin: called before the skill starts.
        end: called after it has stopped.
    """

    def __init__(self, skill: Skill, begin: Callable[[], object], end: Callable[[], object]) -> None:
        self._skill, self._begin, self._end = skill, begin, end

    def start(self) -> None:
        """Begin both."""
        self._begin()
        self._skill.start()

    def update(self) -> SkillStatus:
        """What the skill says."""
        return self._skill.update()

    def stop(self) -> None:
        """End both."""
        self._skill.stop()
        self._end()
