"""Tells a SUAVE mission: what happens to the robot, in words."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray, values_of
from rosa_simulation.narrator import Narrator
from suave.robot import RobotEvent, SuaveRobot

_CAUSES = {
    "thruster failed": "thruster {} failed",
    "thruster recovered": "thruster {} recovered",
    "guided": "GUIDED: the mission begins",
    "pipeline found": "pipeline found",
    "pipeline inspected": "pipeline inspected to its end and back",
    "recharged": "battery recharged",
    "battery empty": "the battery is empty: no thruster works",
    "time limit": "time limit reached",
}
_MEASUREMENTS = {"water_visibility": "visibility {:.1f}", "battery_level": "battery {:.2f}"}


class SuaveStory:
    """Tells a narrator what happens to the robot.

    A periodic measurement from which nothing follows is not told. What a node does is told with the cause of the
    call that made it do so.
    """

    def __init__(self, robot: SuaveRobot, narrator: Narrator) -> None:
        self._robot = robot
        self._narrator = narrator
        self._altitude: float | None = None
        robot.on_event.append(self._on_robot_event)
        robot.on_call.append(narrator.call)
        robot.on_diagnostics.append(self._on_diagnostics)

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        for key, value, message in values_of(array):
            if key in _MEASUREMENTS:
                self._narrator.measurement(_MEASUREMENTS[key].format(float(value)))
            self._narrator.fact("diagnostic", key=key, value=value, message=message)

    def _on_robot_event(self, event: RobotEvent) -> None:
        narrator, details = self._narrator, {"subject": event.subject} if event.subject else {}
        if event.what in _CAUSES:
            narrator.cause(_CAUSES[event.what].format(event.subject))
            narrator.fact(event.what, **details)
            return
        if event.what != "parameters":
            narrator.effect(f"{event.subject} {event.what}", event.subject)
        elif event.subject == self._robot.search.name and self._robot.search.altitude != self._altitude:
            before = "" if self._altitude is None else f"{self._altitude:.1f} -> "
            self._altitude = self._robot.search.altitude
            narrator.effect(f"altitude {before}{self._altitude:.1f}", event.subject)
        narrator.fact(event.what, event.subject, **details)
