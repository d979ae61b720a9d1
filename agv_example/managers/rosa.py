"""ROSA: the knowledge base says what is feasible, path and configuration are planned together, the loop configures."""

from __future__ import annotations

from agv_example.drive_configurations import ACTION
from agv_example.managers.manager import ManagedMission
from agv_example.missions.tree import goal_queue_leaves, mission_tree
from agv_example.navigator import Navigator
from agv_example.skills import Navigate
from rosa_core import KnowledgeBase
from rosa_simulation.managed_robot import knowledge_base_for
from task_layer.bt import TreeRunner


def knowledge_base_of(mission: ManagedMission) -> KnowledgeBase:
    """The knowledge base of a mission, which configures the robot."""
    return knowledge_base_for(
        mission.robot, mission.model, stopwatch=mission.recorder.stopwatch, on_event=mission.on_kb_event
    )


def rosa_tree(mission: ManagedMission) -> TreeRunner:
    """The mission's tree: the pattern of figure 5 of the paper before every drive, and a way there."""
    robot, goal_queue, kb = mission.robot, mission.goal_queue, knowledge_base_of(mission)
    navigator = Navigator(kb, robot, mission.config.objective, mission.on_route)

    def is_there_a_way() -> bool:
        return goal_queue.due is None or navigator.has_way(goal_queue.due)

    registry = goal_queue_leaves(goal_queue)
    registry.add(is_there_a_way.__name__, is_there_a_way)
    registry.add(ACTION, Navigate(navigator, robot, lambda: goal_queue.due))
    return mission.runner(mission_tree(registry), kb)
