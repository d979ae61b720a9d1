"""Tells a mission as it happens: each line is a cause and what followed from it at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from rosa_core.kb import Event
from rosa_evaluation.moments import Moment, tell_kb_event
from rosa_evaluation.run_record import MissionEvent
from suave.monitors import DiagnosticArray
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


class Narrator:
    """Makes one :class:`MissionEvent` of each cause and what follows from it, and tells it when that is over.

    A periodic measurement from which nothing follows is not told. What a node does is told with the cause of the
    call that made it do so.
    """

    def __init__(self, robot: SuaveRobot, tell: Callable[[MissionEvent], None]) -> None:
        self._robot = robot
        self._tell = tell
        self._altitude: float | None = None
        self._moments: deque[Moment] = deque()
        self._callers: dict[str, Moment] = {}
        robot.on_event.append(self._on_robot_event)
        robot.on_call.append(self._on_call)
        robot.on_diagnostics.append(self._on_diagnostics)

    def on_kb_event(self, event: Event) -> None:
        """Something followed in the knowledge base."""
        tell_kb_event(self._moment(), event)

    def close(self) -> None:
        """Tell what has not been told yet."""
        while self._moments:
            self._tell_oldest()

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        for status in array["status"]:
            for pair in status["values"]:
                key, value = pair["key"], pair["value"]
                if key in _MEASUREMENTS:
                    self._begin(_MEASUREMENTS[key].format(float(value)))
                self._moment().fact("diagnostic", key=key, value=value, message=status["message"])

    def _on_call(self, component: str) -> None:
        self._callers[component] = self._moment()

    def _on_robot_event(self, event: RobotEvent) -> None:
        if event.what in _CAUSES:
            moment = self._begin(_CAUSES[event.what].format(event.subject))
            moment.worth_telling = True
        else:
            moment = self._callers.get(event.subject) or self._moment()
            if event.what != "parameters":
                moment.effect(f"{event.subject} {event.what}")
            elif self._robot.search.altitude != self._altitude:
                before = "" if self._altitude is None else f"{self._altitude:.1f} -> "
                self._altitude = self._robot.search.altitude
                moment.effect(f"altitude {before}{self._altitude:.1f}")
        moment.fact(event.what, **({"subject": event.subject} if event.subject else {}))

    def _begin(self, cause: str) -> Moment:
        moment = Moment(self._robot.clock.now(), cause)
        self._moments.append(moment)
        # A moment lasts as long as calls to components take: what they bring about belongs to it.
        self._robot.clock.call_later(2.0 * self._robot.parameters.service_time, self._tell_oldest)
        return moment

    def _moment(self) -> Moment:
        """The present moment; something that no cause precedes begins one of its own."""
        if self._moments and self._moments[-1].time == self._robot.clock.now():
            return self._moments[-1]
        return self._begin("")

    def _tell_oldest(self) -> None:
        if not self._moments:
            return
        moment = self._moments.popleft()
        if moment.worth_telling:
            time = max(0.0, moment.time - (self._robot.guided_at or 0.0))
            self._tell(MissionEvent(round(time, 6), moment.text, tuple(moment.facts)))


_MEASUREMENTS = {"water_visibility": "visibility {:.1f}", "battery_level": "battery {:.2f}"}
