"""The mission as a behaviour tree."""

from __future__ import annotations

from collections.abc import Callable

from py_trees.behaviour import Behaviour

from task_layer.bt import (
    Condition,
    Delay,
    Fallback,
    IfThenElse,
    Inverter,
    ReactiveSequence,
    RetryUntilSuccessful,
    Sequence,
    SequenceWithMemory,
)
from uav_example import skills
from uav_example.robot import UavRobot

Leaf = Callable[[str], Behaviour]


def mission_tree(robot: UavRobot, *, is_feasible: Leaf, perform: Leaf) -> Behaviour:
    """Survey the area, then return to the base and land."""

    def if_feasible(action: str) -> Behaviour:
        return ReactiveSequence(f"{action} if feasible", [is_feasible(action), perform(action)])

    folded = Condition("is_gripper_folded", lambda: robot.world.gripper.folded)
    fold_first = Fallback("fold the gripper first", [folded, if_feasible(skills.LAND_FOLD)])
    on_site = Sequence("analyse on site", [fold_first, if_feasible(skills.ANALYZE_IN_SITU)])
    analyse = Fallback("analyse the sample", [if_feasible(skills.ANALYZE), on_site])
    waiting = Condition("is_sample_waiting", lambda: robot.world.waiting is not None)
    survey = IfThenElse("analyse or search", [waiting, analyse, if_feasible(skills.SEARCH)])
    recharge = Sequence(
        "recharge",
        [Inverter("search is not feasible", is_feasible(skills.SEARCH)), if_feasible(skills.RETURN_BASE)],
    )
    wait = Delay("wait", Condition("no more", lambda: True), 1000)
    what_next = Fallback("what next", [survey, recharge, wait])
    done = Condition("is_survey_done", lambda: robot.survey_done)
    until_done = RetryUntilSuccessful("until the survey is done", Sequence("go on", [what_next, done]), -1)
    home = [if_feasible(skills.RETURN_BASE), if_feasible(skills.LAND_FOLD)]
    return SequenceWithMemory("survey, then home", [until_done, *home])
