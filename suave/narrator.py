"""Tells a mission as it happens: each line is a cause and what followed from it at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from rosa_core import Status
from rosa_core.kb import (
    ActionUpdate,
    ConfigurationSelected,
    Event,
    ReconfigurationPlanEnded,
    Result,
    StatusesChanged,
)
from rosa_core.model import ElementKind
from rosa_evaluation.run_record import MissionEvent
from suave.monitors import DiagnosticArray
from suave.robot import RobotEvent, SuaveRobot

_TOLD_KINDS = (ElementKind.ACTION, ElementKind.FUNCTION_DESIGN)
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


@dataclass(slots=True)
class _Moment:
    """A cause, and what follows from it at once."""

    time: float
    cause: str = ""
    worth_telling: bool = False
    effects: dict[str, None] = field(default_factory=dict)
    facts: list[Mapping[str, Any]] = field(default_factory=list)


class Narrator:
    """Makes one :class:`MissionEvent` of each cause and what follows from it, and tells it when that is over.

    A periodic measurement from which nothing follows is not told. What a node does is told with the cause of the
    call that made it do so.
    """

    def __init__(self, robot: SuaveRobot, tell: Callable[[MissionEvent], None]) -> None:
        self._robot = robot
        self._tell = tell
        self._altitude: float | None = None
        self._moments: deque[_Moment] = deque()
        self._callers: dict[str, _Moment] = {}
        robot.on_event.append(self._on_robot_event)
        robot.on_call.append(self._on_call)
        robot.on_diagnostics.append(self._on_diagnostics)

    def on_kb_event(self, event: Event) -> None:
        """Something followed in the knowledge base."""
        moment = self._moment()
        if isinstance(event, StatusesChanged):
            _tell_statuses(moment, event)
        elif isinstance(event, ConfigurationSelected):
            _tell_selection(moment, event)
        elif isinstance(event, ActionUpdate):
            _tell_actions(moment, event)
        elif isinstance(event, ReconfigurationPlanEnded):
            _tell_plan(moment, event)

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
                _fact(self._moment(), "diagnostic", key=key, value=value, message=status["message"])

    def _on_call(self, component: str) -> None:
        self._callers[component] = self._moment()

    def _on_robot_event(self, event: RobotEvent) -> None:
        if event.what in _CAUSES:
            moment = self._begin(_CAUSES[event.what].format(event.subject))
            moment.worth_telling = True
        else:
            moment = self._callers.get(event.subject) or self._moment()
            if event.what != "parameters":
                _effect(moment, f"{event.subject} {event.what}")
            elif event.subject == self._robot.search.name and self._robot.search.altitude != self._altitude:
                before = "" if self._altitude is None else f"{self._altitude:.1f} -> "
                self._altitude = self._robot.search.altitude
                _effect(moment, f"altitude {before}{self._altitude:.1f}")
        _fact(moment, event.what, **({"subject": event.subject} if event.subject else {}))

    def _begin(self, cause: str) -> _Moment:
        moment = _Moment(self._robot.clock.now(), cause)
        self._moments.append(moment)
        # A moment lasts as long as calls to components take: what they bring about belongs to it.
        self._robot.clock.call_later(2.0 * self._robot.parameters.service_time, self._tell_oldest)
        return moment

    def _moment(self) -> _Moment:
        """The present moment; something that no cause precedes begins one of its own."""
        if self._moments and self._moments[-1].time == self._robot.clock.now():
            return self._moments[-1]
        return self._begin("")

    def _tell_oldest(self) -> None:
        if not self._moments:
            return
        moment = self._moments.popleft()
        if moment.worth_telling:
            text = ": ".join(filter(None, (moment.cause, ", ".join(moment.effects))))
            time = max(0.0, moment.time - (self._robot.guided_at or 0.0))
            self._tell(MissionEvent(round(time, 6), text, tuple(moment.facts)))


_MEASUREMENTS = {"water_visibility": "visibility {:.1f}", "battery_level": "battery {:.2f}"}


def _tell_statuses(moment: _Moment, event: StatusesChanged) -> None:
    for change in event.changes:
        if change.kind in _TOLD_KINDS and Status.UNFEASIBLE in (change.new, change.old):
            feasible = change.new is not Status.UNFEASIBLE
            _effect(moment, f"{change.name} {'feasible' if feasible else 'unfeasible'}")
    _fact(moment, "statuses", changes=[[c.kind.value, c.name, c.old.value, c.new.value] for c in event.changes])


def _tell_selection(moment: _Moment, event: ConfigurationSelected) -> None:
    for name in event.function_designs:
        _effect(moment, f"{name} selected")
    designs, configurations = list(event.function_designs), list(event.component_configurations)
    _fact(moment, "selected", function_designs=designs, component_configurations=configurations)


def _tell_actions(moment: _Moment, event: ActionUpdate) -> None:
    ended = [[action.action, str(action.result)] for action in event.ended]
    requested = [action.action for action in event.requested]
    for name, result in ended:
        _effect(moment, f"{name} {result}")
    for name in requested:
        _effect(moment, f"{name} requested")
    _fact(moment, "actions", requested=requested, ended=ended)


def _tell_plan(moment: _Moment, event: ReconfigurationPlanEnded) -> None:
    plan = event.plan
    if event.result is not Result.COMPLETED:
        _effect(moment, f"reconfiguration {event.result}")
    _fact(
        moment,
        "reconfiguration plan",
        id=plan.id,
        activate=list(plan.activate),
        deactivate=list(plan.deactivate),
        parameter_adaptations=list(plan.parameter_adaptations),
        result=event.result.value,
    )


def _effect(moment: _Moment, effect: str) -> None:
    moment.effects.setdefault(effect)
    moment.worth_telling = True


def _fact(moment: _Moment, fact: str, **details: Any) -> None:
    moment.facts.append({"fact": fact, **details})
