"""No managing system: every action counts as feasible, and nothing adapts."""

from __future__ import annotations

from task_layer.bt import Condition, SkillAction, TreeRunner
from task_layer.skill import Skill, SkillStatus
from uav_example import nodes, skills
from uav_example.managers.manager import ManagedMission
from uav_example.missions.tree import mission_tree
from uav_example.robot import UavRobot

_NODES = {
    skills.SEARCH: (nodes.SEARCH_PATH, nodes.CONTROL_MOTION),
    skills.ANALYZE: (nodes.PICK_PATH, nodes.CONTROL_MOTION),
    skills.ANALYZE_IN_SITU: (nodes.ANALYZE_PATH, nodes.CONTROL_MOTION),
    skills.RETURN_BASE: (nodes.HOME_PATH, nodes.CONTROL_MOTION),
    skills.LAND_FOLD: (nodes.LAND_PATH, nodes.FOLD_GRIPPER, nodes.CONTROL_MOTION),
}


class _WithNodes(Skill):
    """A skill that itself starts and stops the nodes which do the work."""

    def __init__(self, skill: Skill, robot: UavRobot, names: tuple[str, ...]) -> None:
        self._skill, self._robot, self._names = skill, robot, names

    def start(self) -> None:
        for name in self._names:
            self._robot.activate(name)
        self._skill.start()

    def update(self) -> SkillStatus:
        return self._skill.update()

    def stop(self) -> None:
        self._skill.stop()
        for name in self._names:
            self._robot.deactivate(name)


def no_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree, with nobody to ask what is feasible."""
    robot = mission.robot
    tree = mission_tree(
        robot,
        is_feasible=lambda action: Condition(f"is_{action}_feasible", lambda: True),
        perform=lambda action: SkillAction(action, _WithNodes(mission.skills[action], robot, _NODES[action])),
    )
    return mission.runner(tree)
