"""No managing system: every action counts as feasible, and nothing adapts."""

from __future__ import annotations

from task_layer.bt import TreeRunner, load_tree
from task_layer.skill import Skill, WithHooks
from uav_example import nodes, skills
from uav_example.managers.manager import ManagedMission
from uav_example.missions.leaves import conditions
from uav_example.robot import UavRobot

_NODES = {
    skills.SEARCH: (nodes.SEARCH_PATH, nodes.CONTROL_MOTION),
    skills.ANALYZE: (nodes.PICK_PATH, nodes.CONTROL_MOTION),
    skills.ANALYZE_IN_SITU: (nodes.ANALYZE_PATH, nodes.CONTROL_MOTION),
    skills.RETURN_BASE: (nodes.HOME_PATH, nodes.CONTROL_MOTION),
    skills.LAND_FOLD: (nodes.LAND_PATH, nodes.FOLD_GRIPPER, nodes.CONTROL_MOTION),
}


def no_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree, with nobody to ask what is feasible."""
    registry = conditions(mission.robot).count_all_as_feasible()
    for action, skill in mission.skills.items():
        registry.add(action, _with_nodes(skill, mission.robot, _NODES[action]), request=False)
    return mission.runner(load_tree(mission.tree_file, registry))


def _with_nodes(skill: Skill, robot: UavRobot, names: tuple[str, ...]) -> Skill:
    """A skill that itself starts and stops the nodes which do the work."""

    def start() -> None:
        for name in names:
            robot.activate(name)

    def stop() -> None:
        for name in names:
            robot.deactivate(name)

    return WithHooks(skill, start, stop)
