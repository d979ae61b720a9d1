"""What has happened, as far as memory is kept for it."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

from rosa_core.errors import InvalidValueError
from rosa_core.kb.events import (
    ActionUpdate,
    EndedPlan,
    Event,
    Measurement,
    MonitoringData,
    ReconfigurationPlanEnded,
    RequiredAction,
    StatusChange,
    StatusesChanged,
)

TOPICS = ("measurements", "statuses", "required_actions", "reconfiguration_plans")


@dataclass(frozen=True, slots=True)
class TimedStatusChange:
    """A status change and when it happened (seconds)."""

    change: StatusChange
    time: float


HistoryEntry = Measurement | TimedStatusChange | RequiredAction | EndedPlan


class History:
    """The latest entries of each topic, at most ``length`` of each."""

    def __init__(self, length: int) -> None:
        self._topics: dict[str, deque[HistoryEntry]] = {topic: deque(maxlen=length) for topic in TOPICS}

    def record(self, events: Iterable[Event]) -> None:
        """Keep what the events of a write say."""
        for event in events:
            if isinstance(event, MonitoringData):
                self._topics["measurements"].extend(event.measurements)
            elif isinstance(event, StatusesChanged):
                self._topics["statuses"].extend(TimedStatusChange(c, event.time) for c in event.changes)
            elif isinstance(event, ActionUpdate):
                self._topics["required_actions"].extend(event.ended)
            elif isinstance(event, ReconfigurationPlanEnded):
                self._topics["reconfiguration_plans"].append(EndedPlan(event.plan, event.time, event.result))

    def of(self, topic: str, name: str | None) -> tuple[HistoryEntry, ...]:
        """The entries of a topic, oldest first; with a name, those about that measure, element or action.

        Raises:
            InvalidValueError: if there is no such topic.
        """
        if topic not in self._topics:
            raise InvalidValueError(f"there is no history of '{topic}'; there is: {', '.join(TOPICS)}")
        return tuple(entry for entry in self._topics[topic] if name is None or name in _names(entry))


def _names(entry: HistoryEntry) -> tuple[str, ...]:
    if isinstance(entry, Measurement):
        return (entry.measure,)
    if isinstance(entry, TimedStatusChange):
        return (entry.change.name,)
    if isinstance(entry, RequiredAction):
        return (entry.action,)
    plan = entry.plan
    return (*plan.activate, *plan.deactivate, *plan.parameter_adaptations)
