"""The plain and the extended mission as behaviour trees (ROSA paper, figure 7).

The trees do not know who manages the robot: ``perform(action)`` makes the node that performs an action, be it guarded
by its feasibility and managed by the knowledge base, or neither.
"""

from __future__ import annotations

from collections.abc import Callable

from py_trees.behaviour import Behaviour

from suave.robot import SuaveRobot
from task_layer.bt import (
    Condition,
    Fallback,
    InstantAction,
    ReactiveSequence,
    RetryUntilSuccessful,
    SequenceWithMemory,
)

Perform = Callable[[str], Behaviour]


def plain_mission(robot: SuaveRobot, perform: Perform) -> Behaviour:
    """Search for the pipeline, then inspect it: 10 nodes, and those that guard the actions."""
    return _mission(robot, _search_and_inspect(perform))


def extended_mission(robot: SuaveRobot, perform: Perform) -> Behaviour:
    """The same, with recharging when neither can be done: 16 nodes, and those that guard the actions."""
    task = Fallback("task or recharge", [_search_and_inspect(perform), perform("recharge")])
    found = Condition("is_pipeline_found", lambda: robot.pipeline_found)
    inspected = Condition("is_pipeline_inspected", lambda: robot.pipeline_inspected)
    done = ReactiveSequence("is mission done", [found, inspected])
    return _mission(robot, ReactiveSequence("task until done", [task, done]))


def _search_and_inspect(perform: Perform) -> Behaviour:
    return SequenceWithMemory("search, then inspect", [perform("search_pipeline"), perform("inspect_pipeline")])


def _mission(robot: SuaveRobot, task: Behaviour) -> Behaviour:
    arm = InstantAction("arm_thrusters", robot.arm)
    guided = InstantAction("set_guided_mode", robot.set_guided)
    start = SequenceWithMemory("start", [arm, guided])
    aborted = Condition("is_mission_aborted", lambda: robot.over)
    mission = Fallback("mission", [aborted, SequenceWithMemory("start, then task", [start, task])])
    return RetryUntilSuccessful("until done", mission, num_attempts=-1)
