"""The words for what happens in a UAV mission."""

from __future__ import annotations

from collections.abc import Mapping

from rosa_simulation.narration import narrate
from rosa_simulation.narrator import Narrator
from rosa_simulation.robot_event import RobotEvent
from uav_example import monitors
from uav_example.events import UavEvent
from uav_example.robot import UavRobot

_CAUSES = {
    UavEvent.SAMPLE_FOUND: "sample {} found",
    UavEvent.SAMPLE_ANALYSED: "sample {} analysed ({analysis})",
    UavEvent.AREA_SEARCHED: "the whole area is searched",
    UavEvent.GRIPPER_FAILED: "the gripper failed",
    UavEvent.GRIPPER_FOLDED: "gripper folded",
    UavEvent.CHARGED: "battery charged",
    UavEvent.BATTERY_EMPTY: "the battery is empty: the aircraft falls",
    UavEvent.TIME_LIMIT: "time limit reached",
}


def narrate_mission(robot: UavRobot, narrator: Narrator) -> None:
    """Describe what happens to the aircraft, and how each sample is analysed.

    Args:
        robot: whose events and diagnostics are described.
        narrator: takes the words and facts.
    """
    analyses = robot.world.analyses

    def details(event: RobotEvent) -> Mapping[str, str]:
        if event.kind is not UavEvent.SAMPLE_ANALYSED:
            return {}
        return {"analysis": analyses[int(event.subject)].value}

    narrate(robot, narrator, _CAUSES, details=details, measurements={monitors.BATTERY_LEVEL: "battery {:.3f}"})
