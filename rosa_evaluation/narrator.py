"""Tells a mission as it happens: each line is a cause and what followed from it at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from rosa_core import Status
from rosa_core.clock import SimulationClock
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

_TOLD_KINDS = (ElementKind.ACTION, ElementKind.FUNCTION_DESIGN)


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

    What follows in a knowledge base it hears by itself; what happens to the robot it is told.

    Args:
        clock: simulated time.
        tell: hears each event.
        lasting: how long after its cause something still belongs to it, s: as long as calls to components take.
        began: when the mission began, in s of the clock; told times count from there.
    """

    def __init__(
        self,
        clock: SimulationClock,
        tell: Callable[[MissionEvent], None],
        *,
        lasting: float,
        began: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self._clock = clock
        self._tell = tell
        self._lasting = lasting
        self._began = began
        self._moments: deque[_Moment] = deque()
        self._callers: dict[str, _Moment] = {}

    def cause(self, text: str) -> None:
        """Something happened that is worth telling."""
        self._begin(text).worth_telling = True

    def measurement(self, text: str) -> None:
        """Something was measured; it is told only if something follows from it."""
        self._begin(text)

    def call(self, component: str) -> None:
        """A component is called: what it does then belongs to the present cause, though it comes later."""
        self._callers[component] = self._moment()

    def effect(self, text: str, component: str | None = None) -> None:
        """Something followed, be it from what was last called of a component."""
        _effect(self._moment_of(component), text)

    def fact(self, fact: str, component: str | None = None, **details: Any) -> None:
        """The same for programs: not told in words, but kept with the event."""
        _fact(self._moment_of(component), fact, **details)

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

    def _begin(self, cause: str) -> _Moment:
        moment = _Moment(self._clock.now(), cause)
        self._moments.append(moment)
        self._clock.call_later(self._lasting, self._tell_oldest)
        return moment

    def _moment(self) -> _Moment:
        """The present moment; something that no cause precedes begins one of its own."""
        if self._moments and self._moments[-1].time == self._clock.now():
            return self._moments[-1]
        return self._begin("")

    def _moment_of(self, component: str | None) -> _Moment:
        return (self._callers.get(component) if component is not None else None) or self._moment()

    def _tell_oldest(self) -> None:
        if not self._moments:
            return
        moment = self._moments.popleft()
        if moment.worth_telling:
            text = ": ".join(filter(None, (moment.cause, ", ".join(moment.effects))))
            time = max(0.0, moment.time - self._began())
            self._tell(MissionEvent(round(time, 6), text, tuple(moment.facts)))


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
