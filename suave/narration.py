"""The words for what happens in a SUAVE mission."""

from __future__ import annotations

from rosa_simulation.narration import kind_and_subject, narrate
from rosa_simulation.narrator import Narrator
from rosa_simulation.robot_event import NodeChange, RobotEvent
from suave.events import SuaveEvent
from suave.robot import SuaveRobot

_CAUSES = {
    SuaveEvent.THRUSTER_FAILED: "thruster {} failed",
    SuaveEvent.THRUSTER_RECOVERED: "thruster {} recovered",
    SuaveEvent.GUIDED: "GUIDED: the mission begins",
    SuaveEvent.PIPELINE_FOUND: "pipeline found",
    SuaveEvent.PIPELINE_INSPECTED: "pipeline inspected to its end and back",
    SuaveEvent.RECHARGED: "battery recharged",
    SuaveEvent.BATTERY_EMPTY: "the battery is empty: no thruster works",
    SuaveEvent.TIME_LIMIT: "time limit reached",
}
_MEASUREMENTS = {"water_visibility": "visibility {:.1f}", "battery_level": "battery {:.2f}"}


def narrate_mission(robot: SuaveRobot, narrator: Narrator) -> None:
    """Describe what happens to the robot; of parameters only changes of the search altitude (m) are put into words.

    Args:
        robot: whose events and diagnostics are described.
        narrator: takes the words and facts.
    """
    altitude: float | None = None

    def effects(event: RobotEvent) -> str | None:
        nonlocal altitude
        if event.kind is not NodeChange.PARAMETERS:
            return kind_and_subject(event)
        if event.subject != robot.search.name or robot.search.altitude == altitude:
            return None
        before = "" if altitude is None else f"{altitude:.1f} -> "
        altitude = robot.search.altitude
        return f"altitude {before}{altitude:.1f}"

    narrate(robot, narrator, _CAUSES, effects=effects, measurements=_MEASUREMENTS)
