"""No managing system: the task is performed, and nothing adapts."""

from __future__ import annotations

from suave.managers.manager import ManagedMission
from suave.mission_config import SPIRAL_ALTITUDES
from task_layer.bt import TreeRunner
from task_layer.skill import Skill, WithHooks

_NODES = {
    "search_pipeline": "f_generate_search_path_node",
    "inspect_pipeline": "f_follow_pipeline_node",
    "recharge": "generate_recharge_path_node",
}


def no_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree, every action counting as feasible, at the altitude of the mission configuration."""
    robot = mission.robot

    def skill_of(action: str) -> Skill:
        """A skill that itself starts and stops the node which does the work."""
        node = _NODES[action]

        def begin() -> None:
            robot.activate(node)
            if action == "search_pipeline":
                altitude = SPIRAL_ALTITUDES[robot.config.f_generate_search_path_mode]
                robot.set_parameters(node, {"spiral_altitude": altitude})

        return WithHooks(mission.skills[action], begin, lambda: robot.deactivate(node))

    return mission.runner(mission.unguarded_tree(skill_of))
