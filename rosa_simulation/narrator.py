"""Describes a mission as it happens: each line is a cause and what followed from it at once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rosa_core.clock import SimulationClock
from rosa_core.kb import Event
from rosa_simulation.run_record import MissionEvent
from rosa_simulation.timeline_entries import TimelineEntry, add_kb_event

if TYPE_CHECKING:
    from task_layer.pddl import PlanRecord


class Narrator:
    """Makes one :class:`MissionEvent` of each cause and what follows from it, and publishes it when that is over.

    Args:
        clock: simulated time.
        publish: called with each event.
        effect_time: how long after its cause an effect still belongs to it, s: as long as calls to components take.
        start_time: gives the time at which the mission began, in s of the clock; events count from there.
    """

    def __init__(
        self,
        clock: SimulationClock,
        publish: Callable[[MissionEvent], None],
        *,
        effect_time: float,
        start_time: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self._clock = clock
        self._publish = publish
        self.effect_time = effect_time
        self._start_time = start_time
        self._entries: deque[TimelineEntry] = deque()
        self._callers: dict[str, TimelineEntry] = {}

    def cause(self, text: str) -> None:
        """Begin an entry that is reported whatever follows."""
        self._begin(text).reported = True

    def measurement(self, text: str) -> None:
        """Begin an entry that is reported only if something follows."""
        self._begin(text)

    def call(self, component: str) -> None:
        """Note that a component is called: what it does then belongs to the present cause, though it comes later."""
        self._callers[component] = self._present()

    def effect(self, text: str, component: str | None = None) -> None:
        """Add an effect.

        Args:
            text: the effect in words.
            component: whose doing it is; the effect belongs to the cause of the latest call to that component.
        """
        self._entry_of(component).effect(text)

    def fact(self, fact: str, component: str | None = None, **details: Any) -> None:
        """Add a fact for programs, which is kept with the event but not in its words.

        Args:
            fact: what it is.
            component: as in :meth:`effect`.
            details: values that JSON can hold.
        """
        self._entry_of(component).fact(fact, **details)

    def on_kb_event(self, event: Event) -> None:
        """Add what an event of the knowledge base says."""
        add_kb_event(self._present(), event)

    def on_plan(self, record: PlanRecord) -> None:
        """Add the plan that the task layer has made, or that there is none."""
        entry = self._present()
        steps = ", ".join(step.strip("()").split()[0] for step in record.steps)
        entry.effect(f"plan: {steps}" if steps else f"no plan: {record.no_plan}")
        entry.fact("plan", steps=list(record.steps), reason=record.reason, no_plan=record.no_plan)

    def close(self) -> None:
        """Publish what has not been published yet."""
        while self._entries:
            self._publish_oldest()

    def _begin(self, cause: str) -> TimelineEntry:
        entry = TimelineEntry(self._clock.now(), cause)
        self._entries.append(entry)
        self._clock.call_later(self.effect_time, self._publish_oldest)
        return entry

    def _present(self) -> TimelineEntry:
        """The entry of the present time; what no cause precedes begins one of its own."""
        if self._entries and self._entries[-1].time == self._clock.now():
            return self._entries[-1]
        return self._begin("")

    def _entry_of(self, component: str | None) -> TimelineEntry:
        return (self._callers.get(component) if component is not None else None) or self._present()

    def _publish_oldest(self) -> None:
        if not self._entries:
            return
        entry = self._entries.popleft()
        if entry.reported:
            time = max(0.0, entry.time - self._start_time())
            self._publish(MissionEvent(round(time, 6), entry.text, tuple(entry.facts)))
