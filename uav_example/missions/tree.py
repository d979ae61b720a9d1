"""The mission as a behaviour tree: what the names in ``uav.xml`` stand for."""

from __future__ import annotations

from importlib.resources import as_file, files

from py_trees.behaviour import Behaviour

from task_layer.bt import Registry, load_tree
from uav_example.robot import UavRobot


def mission_tree(registry: Registry) -> Behaviour:
    """Load the mission; the registry has its conditions and its actions."""
    with as_file(files("uav_example.missions").joinpath("uav.xml")) as path:
        return load_tree(path, registry)


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
