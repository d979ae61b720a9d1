"""The words for what happens to the AGV, and for the routes that are decided on."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from agv_example.events import AgvEvent
from agv_example.navigator import RouteDecision
from agv_example.planning import Leg
from agv_example.world import AgvRobot
from rosa_simulation.narration import narrate
from rosa_simulation.narrator import Narrator
from rosa_simulation.robot_event import NodeChange, RobotEvent

_CAUSES = {
    AgvEvent.DEPARTED: "at {}: the mission begins",
    AgvEvent.COMPONENT_FAILED: "{} failed",
    AgvEvent.COMPONENT_RECOVERED: "{} works again",
    AgvEvent.CORRIDOR_CLOSED: "{} is closed",
    AgvEvent.CORRIDOR_OPENED: "{} is open again",
    AgvEvent.LIGHT_CHANGED: "the light in {} changes",
    AgvEvent.ARRIVED: "at {}",
    AgvEvent.COLLISION: "hit something in {}",
    AgvEvent.STRANDED: "stands in {} and cannot go on",
    AgvEvent.BATTERY_EMPTY: "the battery is empty",
    AgvEvent.TIME_LIMIT: "time limit reached",
}


def narrate_mission(robot: AgvRobot, narrator: Narrator) -> None:
    """Describe what happens to the robot; changes of components are facts only.

    Args:
        robot: whose events and diagnostics are described.
        narrator: takes the words and facts.
    """

    def effects(event: RobotEvent) -> str | None:
        if isinstance(event.kind, NodeChange):
            return None
        if event.kind is AgvEvent.DRIVING:
            running = robot.running()
            return f"drives {event.subject}" + ("" if running is None else f" with {running.name}")
        return f"{event.kind.value} {event.subject}".strip()

    narrate(robot, narrator, _CAUSES, effects=effects)


def narrate_route(narrator: Narrator, decision: RouteDecision) -> None:
    """Describe a route that was decided on, with the configuration for each corridor.

    Args:
        narrator: takes the words and facts.
        decision: the route, if there is one, and what was driven before.
    """
    route = decision.route
    narrator.effect(f"no way to {decision.goal}" if route is None else f"route to {decision.goal}: {route}")
    narrator.fact(
        "route",
        start=str(decision.start),
        goal=decision.goal,
        legs=None if route is None else _legs(route.legs),
        before=_legs(decision.before),
    )


def _legs(legs: Iterable[Leg]) -> list[dict[str, Any]]:
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
