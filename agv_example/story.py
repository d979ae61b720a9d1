"""Tells a mission: what happens to the robot and which routes are decided on, in words."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from agv_example.navigator import RouteDecision
from agv_example.planning import Leg
from agv_example.world import AgvRobot, RobotEvent
from rosa_simulation.narrator import Narrator

_CAUSES = {
    "departed": "at {}: the mission begins",
    "component failed": "{} failed",
    "component recovered": "{} works again",
    "corridor closed": "{} is closed",
    "corridor opened": "{} is open again",
    "light changed": "the light in {} changes",
    "arrived": "at {}",
    "collision": "hit something in {}",
    "stranded": "stands in {} and cannot go on",
    "battery empty": "the battery is empty",
    "time limit": "time limit reached",
}
_QUIET = ("activated", "deactivated", "parameters")


class AgvStory:
    """Tells a narrator what happens to the robot; routes it is told of."""

    def __init__(self, robot: AgvRobot, narrator: Narrator) -> None:
        self._robot = robot
        self._narrator = narrator
        robot.on_event.append(self._on_event)

    def on_route(self, decision: RouteDecision) -> None:
        """A way was decided on: it is told with the configuration for each corridor."""
        route = decision.route
        way = f"no way to {decision.goal}" if route is None else f"route to {decision.goal}: {route}"
        self._narrator.effect(way)
        self._narrator.fact(
            "route",
            start=str(decision.start),
            goal=decision.goal,
            legs=None if route is None else _told(route.legs),
            before=_told(decision.before),
        )

    def _on_event(self, event: RobotEvent) -> None:
        narrator, details = self._narrator, {"subject": event.subject} if event.subject else {}
        if event.what in _CAUSES:
            narrator.cause(_CAUSES[event.what].format(event.subject))
        elif event.what == "driving":
            running = self._robot.running()
            narrator.effect(f"drives {event.subject}" + ("" if running is None else f" with {running.name}"))
        elif event.what not in _QUIET:
            narrator.effect(f"{event.what} {event.subject}".strip())
        narrator.fact(event.what, None, **details)


def _told(legs: Iterable[Leg]) -> list[dict[str, Any]]:
    return [
        {
            "corridor": leg.corridor,
            "start": leg.start,
            "end": leg.end,
            "back": leg.back,
            "configuration": leg.configuration.name,
            "energy": round(leg.costs.energy, 6),
            "time_s": round(leg.costs.time, 6),
            "risk": round(leg.costs.risk, 9),
        }
        for leg in legs
    ]
