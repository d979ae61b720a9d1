"""Tells a mission: what happens to the aircraft, in words."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray, values_of
from rosa_simulation.narrator import Narrator
from uav_example import monitors
from uav_example.robot import UavRobot
from uav_example.world.world import WorldEvent

_CAUSES = {
    "sample found": "sample {} found",
    "sample analysed": "sample {} analysed",
    "area searched": "the whole area is searched",
    "gripper failed": "the gripper failed",
    "gripper folded": "gripper folded",
    "charged": "battery charged",
    "battery empty": "the battery is empty: the aircraft falls",
    "time limit": "time limit reached",
}


class UavStory:
    """Tells a narrator what happens to the robot.

    A measurement of the battery from which nothing follows is not told. What a node does is told with the cause of
    the call that made it do so.
    """

    def __init__(self, robot: UavRobot, narrator: Narrator) -> None:
        self._world = robot.world
        self._narrator = narrator
        robot.on_event.append(self._on_event)
        robot.on_call.append(narrator.call)
        robot.on_diagnostics.append(self._on_diagnostics)

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        for key, value, message in values_of(array):
            if key == monitors.BATTERY_LEVEL:
                self._narrator.measurement(f"battery {float(value):.3f}")
            self._narrator.fact("diagnostic", key=key, value=value, message=message)

    def _on_event(self, event: WorldEvent) -> None:
        narrator, details = self._narrator, {"subject": event.subject} if event.subject else {}
        if event.what not in _CAUSES:
            narrator.effect(f"{event.subject} {event.what}", event.subject)
            narrator.fact(event.what, event.subject, **details)
            return
        text = _CAUSES[event.what].format(event.subject)
        if event.what == "sample analysed":
            details["analysis"] = self._world.analyses[int(event.subject)].value
            text += f" ({details['analysis']})"
        narrator.cause(text)
        narrator.fact(event.what, None, **details)
