"""The mission as a behaviour tree: to one goal after the other, each as long as it takes.

The tree does not know who manages the robot: ``perform(goal)`` makes the node that drives there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from py_trees.behaviour import Behaviour

from task_layer.bt import ReactiveFallback, SequenceWithMemory, SkillAction
from task_layer.skill import Skill, SkillStatus

Perform = Callable[[str], Behaviour]


class _Wait(Skill):
    """Waits until the node before it in a reactive fallback can do something."""

    def update(self) -> SkillStatus:
        return SkillStatus.RUNNING


def delivery(goals: Sequence[str], perform: Perform) -> Behaviour:
    """Drive to all goals in turn; when one cannot be driven to now, wait until it can."""
    drives = [
        ReactiveFallback(f"{goal}, or wait", [perform(goal), SkillAction("wait for a way", _Wait())]) for goal in goals
    ]
    return SequenceWithMemory("all goals in turn", drives)
