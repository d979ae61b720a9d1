"""Tells a mission as it happens: each line is a cause and what followed from it at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rosa_core.clock import SimulationClock
from rosa_core.kb import Event
from rosa_simulation.run_record import MissionEvent
from rosa_simulation.timeline_entries import TimelineEntry, tell_kb_event

if TYPE_CHECKING:
    from task_layer.pddl import PlanRecord


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
        self.lasting = lasting
        self._began = began
        self._moments: deque[TimelineEntry] = deque()
        self._callers: dict[str, TimelineEntry] = {}

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
        self._moment_of(component).effect(text)

    def fact(self, fact: str, component: str | None = None, **details: Any) -> None:
        """The same for programs: not told in words, but kept with the event."""
        self._moment_of(component).fact(fact, **details)

    def on_kb_event(self, event: Event) -> None:
        """Something followed in the knowledge base."""
        tell_kb_event(self._moment(), event)

    def on_plan(self, record: PlanRecord) -> None:
        """The task layer has a plan for the mission, or none."""
        moment = self._moment()
        told = ", ".join(step.strip("()").split()[0] for step in record.steps)
        moment.effect(f"plan: {told}" if told else f"no plan: {record.no_plan}")
        moment.fact("plan", steps=list(record.steps), reason=record.reason, no_plan=record.no_plan)

    def close(self) -> None:
        """Tell what has not been told yet."""
        while self._moments:
            self._tell_oldest()

    def _begin(self, cause: str) -> TimelineEntry:
        moment = TimelineEntry(self._clock.now(), cause)
        self._moments.append(moment)
        self._clock.call_later(self.lasting, self._tell_oldest)
        return moment

    def _moment(self) -> TimelineEntry:
        """The present moment; something that no cause precedes begins one of its own."""
        if self._moments and self._moments[-1].time == self._clock.now():
            return self._moments[-1]
        return self._begin("")

    def _moment_of(self, component: str | None) -> TimelineEntry:
        return (self._callers.get(component) if component is not None else None) or self._moment()

    def _tell_oldest(self) -> None:
        if not self._moments:
            return
        moment = self._moments.popleft()
        if moment.worth_telling:
            time = max(0.0, moment.time - self._began())
            self._tell(MissionEvent(round(time, 6), moment.text, tuple(moment.facts)))
