"""The mission as a behaviour tree: to one goal after the other, each as long as it takes.

The tree does not know who manages the robot: ``perform(goal)`` makes the node that drives there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from py_trees.behaviour import Behaviour

from agv_example.world import AgvRobot
from task_layer.bt import Condition, Fallback, RetryUntilSuccessful, SequenceWithMemory

Perform = Callable[[str], Behaviour]


def delivery(robot: AgvRobot, goals: Sequence[str], perform: Perform) -> Behaviour:
    """Drive to all goals in turn; what cannot be done now is tried again until time is up."""
    drives = SequenceWithMemory("all goals in turn", [perform(goal) for goal in goals])
    over = Condition("is_mission_over", lambda: robot.over)
    return RetryUntilSuccessful("until done", Fallback("mission", [over, drives]), num_attempts=-1)
