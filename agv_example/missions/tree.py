"""The mission as a behaviour tree: what the names in ``agv.xml`` stand for."""

from __future__ import annotations

from importlib.resources import as_file, files

from py_trees.behaviour import Behaviour

from agv_example.skills import Arrive, GoalQueue
from task_layer.bt import Registry, load_tree


def mission_tree(registry: Registry) -> Behaviour:
    """Load the mission; the registry has its conditions and its actions."""
    with as_file(files("agv_example.missions").joinpath("agv.xml")) as path:
        return load_tree(path, registry)


def goal_queue_leaves(goal_queue: GoalQueue) -> Registry:
    """A registry with what is the same whoever manages the robot; driving, and whether it can, are to be added."""

    def are_all_goals_reached() -> bool:
        return goal_queue.done

    registry = Registry({"are_all_goals_reached": are_all_goals_reached})
    return registry.add("arrive", Arrive(goal_queue), request=False)
