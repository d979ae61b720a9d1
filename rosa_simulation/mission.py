"""A mission as it is handed to a managing system: the robot, what the task layer performs, and how it is recorded."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from py_trees.behaviour import Behaviour

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.clock import Stopwatch
from rosa_core.kb import Event
from rosa_simulation.managed_robot import knowledge_base_for
from rosa_simulation.models import load_models
from rosa_simulation.reaction_times import ReactionTimes
from rosa_simulation.robot import SimulatedRobot
from rosa_simulation.run_recorder import RunRecorder
from rosa_simulation.simulation import Simulation
from rosa_simulation.system_modes.mode_control import ModeControl
from task_layer.bt import Registry, SkillAction, TreeRunner, load_tree
from task_layer.skill import Skill, WithHooks

if TYPE_CHECKING:
    from task_layer.pddl import ExecutionLimits, Sensor
    from task_layer.pddl.execution.running_step import SkillSource

TICK_PERIOD = 0.5
"""Seconds between ticks when nothing happens; events that end an action tick at once."""


@dataclass(frozen=True, kw_only=True)
class TaskParts:
    """What the task layer performs a mission with.

    Attributes:
        skills: how each action of the knowledge model is carried out.
        own_skills: skills that are no actions of the knowledge model: nobody is asked whether they are feasible.
        leaves: makes a registry of what else a tree may name, such as conditions.
        sensors: how each predicate that is sensed in a plan is sensed.
        plan_skills: how the actions of a plan are carried out, where that differs from ``skills`` and ``own_skills``.
    """

    skills: Mapping[str, Skill]
    own_skills: Mapping[str, Skill] = field(default_factory=dict)
    leaves: Callable[[], Registry] = Registry
    sensors: Mapping[str, Sensor] = field(default_factory=dict)
    plan_skills: Mapping[str, SkillSource] | None = None


def _as_it_is(_action: str, skill: Skill) -> Skill:
    return skill


def _whatever_was_achieved(_failed: bool) -> bool:
    return True


def _nothing() -> None:
    return None


def _until_the_end(duration: float) -> float:
    return duration


@dataclass(frozen=True, kw_only=True)
class Mission:
    """One mission of a robot, assembled and ready to be run under any managing system.

    Attributes:
        simulation: the run that it was assembled for.
        recorder: records the run.
        robot: the managed system.
        models: files of the knowledge model; later ones extend earlier ones.
        task_parts: gives what the task layer performs the mission with, on a knowledge base or (None) without one.
        summary: gives the metrics by name, from the mission's duration in s.
        reaction_times: how fast the managing system reacts.
        inputs: everything that the run is made of, as values that JSON can hold.
        time_limit: the longest that the mission may take, s; the robot's ``over`` says when it is reached.
        ended_by: how the mission ended, in words, from whether the task layer says that it has failed.
        completed: whether it ran to its designed end, from whether the task layer says that it has failed; a mission
            for which the planner gives up has not.
        sample: gives the values of the scenario's ``columns``.
        sample_period: s between two samples.
        unmanaged: makes a skill for the manager ``none`` of an action's name and its skill; it sets up by itself what
            the action needs.
        begin: called when the managing system is ready, and the world begins to move.
        duration: how long the mission took, s, made of how long it ran.
        timeout: when the run is broken off if the robot's ``over`` does not become true, s of the clock.
        make_problem: makes the mission's PDDL problem, where there is no file of it.
        limits: when the executor of plans gives up; None: its own defaults.
        modes: what managing systems over system modes know; None: there are none for this robot.
        on_kb_event: called with the events of a knowledge base, if the managing system has one.
    """

    simulation: Simulation
    recorder: RunRecorder
    robot: SimulatedRobot
    models: tuple[Path, ...]
    task_parts: Callable[[KnowledgeBase | None], TaskParts]
    summary: Callable[[float], Mapping[str, Any]]
    reaction_times: ReactionTimes
    inputs: Mapping[str, Any]
    time_limit: float
    ended_by: Callable[[bool], str]
    sample: Callable[[], tuple[float, ...]]
    sample_period: float = 1.0
    completed: Callable[[bool], bool] = _whatever_was_achieved
    unmanaged: Callable[[str, Skill], Skill] = _as_it_is
    begin: Callable[[], None] = _nothing
    duration: Callable[[float], float] = _until_the_end
    timeout: float = math.inf
    make_problem: Callable[[], str] | None = None
    limits: ExecutionLimits | None = None
    modes: ModeControl | None = None
    on_kb_event: Callable[[Event], None] | None = None

    # -- for managing systems --

    @property
    def stopwatch(self) -> Stopwatch:
        """Everything that a managing system does belongs into ``stopwatch.running()``."""
        return self.recorder.stopwatch

    @property
    def model(self) -> KnowledgeModel:
        """What the robot knows of itself."""
        return load_models(self.models)

    @cached_property
    def parts(self) -> TaskParts:
        """What the task layer performs the mission with where there is no knowledge base."""
        return self.task_parts(None)

    @property
    def skills(self) -> Mapping[str, Skill]:
        """How each action is carried out, where there is no knowledge base."""
        return self.parts.skills

    def knowledge_base(self) -> KnowledgeBase:
        """A knowledge base that the monitors inform, and by which the adaptation loop configures the robot."""
        kb = knowledge_base_for(
            self.robot, self.model, stopwatch=self.stopwatch, on_event=self.recorder.narrator.on_kb_event
        )
        if self.on_kb_event is not None:
            kb.subscribe(self.on_kb_event)
        return kb

    def managed_leaves(self, kb: KnowledgeBase) -> Registry:
        """The leaves of the mission's tree on a knowledge base, of which its actions are requested."""
        parts = self.task_parts(kb)
        registry = _leaves(parts)
        for action, skill in parts.skills.items():
            registry.add(action, skill)
        return registry

    def managed_tree(self, kb: KnowledgeBase) -> Behaviour:
        """The mission's tree on a knowledge base, which says what is feasible."""
        return load_tree(self._tree_file, self.managed_leaves(kb))

    def unguarded_tree(self, skill_of: Callable[[str], Skill]) -> Behaviour:
        """The mission's tree without a knowledge base: every action counts as feasible.

        Args:
            skill_of: gives the skill that performs an action; called for each place of the tree where one is named.
        """
        registry = self.unguarded_leaves().count_all_as_feasible()
        for action in self.skills:
            registry.add(action, partial(_performing, skill_of, action), ports=())
        return load_tree(self._tree_file, registry)

    def unguarded_leaves(self) -> Registry:
        """The leaves of a tree without a knowledge base, but for the actions."""
        return _leaves(self.parts)

    def runner(self, tree: Behaviour, kb: KnowledgeBase | None = None, *, period: float = TICK_PERIOD) -> TreeRunner:
        """The runner of a tree, whose ticks are timed as the managing system's.

        Args:
            tree: the mission.
            kb: the knowledge base, if the tree asks one.
            period: s between ticks when nothing happens.
        """
        return TreeRunner(
            tree,
            kb,
            period=period,
            clock=self.simulation.clock,
            around_tick=self.stopwatch.running,
            on_raise=self.recorder.on_raise,
        )

    def call_every(self, period: float, act: Callable[[], None]) -> None:
        """Call a part of the managing system periodically, at a phase left to chance.

        Nothing in a real system keeps a managing system in step with the monitors. In step, all its reactions would
        take equally long, no time or a whole period, by an accident of the simulation.

        Args:
            period: s between two calls.
            act: what is called; it is timed as the managing system's.
        """
        clock = self.simulation.clock

        def timed() -> None:
            with self.stopwatch.running():
                act()

        clock.call_every(period, timed, start=clock.now() + period * self.simulation.manager_rng.random())

    @property
    def _tree_file(self) -> PathLike[str]:
        tree = self.simulation.files.tree
        if tree is None:
            raise ValueError("this scenario has no mission as a tree")
        return tree


def with_nodes(skill: Skill, robot: SimulatedRobot, *nodes: str) -> Skill:
    """A skill that itself starts and stops the nodes which do the work, for :attr:`Mission.unmanaged`.

    Args:
        skill: how the action is carried out.
        robot: the robot of the nodes.
        nodes: in the order in which they are started and stopped.
    """

    def start() -> None:
        for node in nodes:
            robot.activate(node)

    def stop() -> None:
        for node in nodes:
            robot.deactivate(node)

    return WithHooks(skill, start, stop)


def _leaves(parts: TaskParts) -> Registry:
    registry = parts.leaves()
    for name, skill in parts.own_skills.items():
        registry.add(name, skill, request=False)
    return registry


def _performing(skill_of: Callable[[str], Skill], action: str, name: str) -> Behaviour:
    return SkillAction(name, skill_of(action))
