"""No managing system: the task is performed, and nothing adapts."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from suave.managers.manager import ManagedMission
from suave.mission_config import SPIRAL_ALTITUDES
from suave.robot import SuaveRobot
from task_layer.bt import SkillAction, TreeRunner
from task_layer.skill import Skill, SkillStatus

_NODES = {
    "search_pipeline": "f_generate_search_path_node",
    "inspect_pipeline": "f_follow_pipeline_node",
    "recharge": "generate_recharge_path_node",
}


class _WithNode(Skill):
    """A skill that itself starts and stops the node which does the work."""

    def __init__(self, skill: Skill, robot: SuaveRobot, node: str) -> None:
        self._skill, self._robot, self._node = skill, robot, node

    def start(self) -> None:
        self._robot.activate(self._node)
        if self._node == "f_generate_search_path_node":
            altitude = SPIRAL_ALTITUDES[self._robot.config.f_generate_search_path_mode]
            self._robot.set_parameters(self._node, {"spiral_altitude": altitude})
        self._skill.start()

    def update(self) -> SkillStatus:
        return self._skill.update()

    def stop(self) -> None:
        self._skill.stop()
        self._robot.deactivate(self._node)


def no_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree without feasibility guards, at the altitude of the mission configuration."""

    def perform(action: str) -> Behaviour:
        return SkillAction(action, _WithNode(mission.skills[action], mission.robot, _NODES[action]))

    return mission.runner(mission.make_tree(mission.robot, perform))
