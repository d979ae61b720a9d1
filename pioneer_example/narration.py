"""The words for what happens to the Pioneer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pioneer_example.events import PioneerEvent
from pioneer_example.robot import PioneerRobot
from rosa_simulation.narration import narrate
from rosa_simulation.narrator import Narrator
from rosa_simulation.preemptions import narrate_gate
from rosa_simulation.robot_event import RobotEvent

_CAUSES = {
    PioneerEvent.DEPARTED: "at {}: the mission begins",
    PioneerEvent.ROUTE: "{}",
    PioneerEvent.SONAR_FAILED: "the sonar ring fails: {}",
    PioneerEvent.COLLISION: "hits something",
    PioneerEvent.ORIGIN_REACHED: "the origin is reached",
    PioneerEvent.TIME_LIMIT: "time limit reached; {why}",
}

_MEASUREMENTS = {
    "range_rate": "ranges are measured {:.0f} times a second",
    "preemptions_per_minute": "{:.0f} preemptions in the last minute",
}


def narrate_mission(robot: PioneerRobot, narrator: Narrator) -> None:
    """Describe what happens to the robot and at its gate."""

    def details(event: RobotEvent) -> Mapping[str, Any]:
        place = {"x_m": round(robot.pose[0], 4), "y_m": round(robot.pose[1], 4)}
        return {**place, "why": robot.why()} if event.kind is PioneerEvent.TIME_LIMIT else place

    narrate(robot, narrator, _CAUSES, details=details, measurements=_MEASUREMENTS)
    robot.on_gate_event.append(lambda event: narrate_gate(narrator, event))
