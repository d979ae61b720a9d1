"""What the names of leaves in a mission file stand for; the actions are the managing system's to add."""

from __future__ import annotations

from task_layer.bt import Registry
from uav_example.robot import UavRobot


def conditions(robot: UavRobot) -> Registry:
    """A registry with what the mission asks of the world; the actions are the managing system's to add."""
    world = robot.world

    def is_sample_waiting() -> bool:
        return world.waiting is not None

    def is_gripper_folded() -> bool:
        return world.gripper.folded

    def is_survey_done() -> bool:
        return robot.survey_done

    return Registry(
        {condition.__name__: condition for condition in (is_sample_waiting, is_gripper_folded, is_survey_done)}
    )
