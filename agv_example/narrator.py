"""Tells a mission as it happens: each line is a cause and what followed from it at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from agv_example.navigator import RouteDecision
from agv_example.planning import Leg
from agv_example.world import AgvRobot, RobotEvent
from rosa_core.kb import Event
from rosa_evaluation.moments import Moment, tell_kb_event
from rosa_evaluation.run_record import MissionEvent

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


class Narrator:
    """Makes one :class:`MissionEvent` of each cause and what follows from it at the same time."""

    def __init__(self, robot: AgvRobot, tell: Callable[[MissionEvent], None]) -> None:
        self._robot = robot
        self._tell = tell
        self._began = robot.clock.now()
        self._moment: Moment | None = None
        robot.on_event.append(self._on_robot_event)

    def on_kb_event(self, event: Event) -> None:
        """Something followed in the knowledge base."""
        tell_kb_event(self._now(), event)

    def on_route(self, decision: RouteDecision) -> None:
        """A way was decided on: it is told with the configuration for each corridor."""
        moment = self._now()
        route = decision.route
        moment.effect(f"no way to {decision.goal}" if route is None else f"route to {decision.goal}: {route}")
        moment.fact(
            "route",
            start=str(decision.start),
            goal=decision.goal,
            legs=None if route is None else _told(route.legs),
            before=_told(decision.before),
        )

    def close(self) -> None:
        """Tell what has not been told yet."""
        moment, self._moment = self._moment, None
        if moment is not None and moment.worth_telling:
            time = max(0.0, moment.time - self._began)
            self._tell(MissionEvent(round(time, 6), moment.text, tuple(moment.facts)))

    def _on_robot_event(self, event: RobotEvent) -> None:
        subject = {"subject": event.subject} if event.subject else {}
        if event.what in _CAUSES:
            moment = self._begin(_CAUSES[event.what].format(event.subject))
            moment.worth_telling = True
        else:
            moment = self._now()
            if event.what == "driving":
                running = self._robot.running()
                moment.effect(f"drives {event.subject}" + ("" if running is None else f" with {running.name}"))
            elif event.what not in _QUIET:
                moment.effect(f"{event.what} {event.subject}".strip())
        moment.fact(event.what, **subject)

    def _now(self) -> Moment:
        """The present moment; something that no cause precedes begins one of its own."""
        moment = self._moment
        return moment if moment is not None and moment.time == self._robot.clock.now() else self._begin("")

    def _begin(self, cause: str) -> Moment:
        self.close()
        moment = self._moment = Moment(self._robot.clock.now(), cause)
        return moment


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
