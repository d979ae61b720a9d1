"""What has happened, as far as memory is kept for it."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from rosa_core.errors import InvalidValueError
from rosa_core.kb.events import ActionUpdate, Event, MonitoringData, ReconfigurationPlanEnded, StatusesChanged
from rosa_core.model.records import TOPICS, EndedPlan, HistoryEntry, TimedStatusChange, concerns


class History:
    """The latest entries of each topic, at most ``length`` of each."""

    def __init__(self, length: int) -> None:
        self.length = length
        self._topics: dict[str, deque[HistoryEntry]] = {topic: deque(maxlen=length) for topic in TOPICS}

    def record(self, events: Iterable[Event]) -> None:
        """Keep what the events of a write say."""
        for event in events:
            if isinstance(event, MonitoringData):
                self._topics["measurements"].extend(event.measurements)
            elif isinstance(event, StatusesChanged):
                self._topics["statuses"].extend([TimedStatusChange(c, event.time) for c in event.changes])
            elif isinstance(event, ActionUpdate):
                self._topics["required_actions"].extend(event.ended)
            elif isinstance(event, ReconfigurationPlanEnded):
                self._topics["reconfiguration_plans"].append(EndedPlan(event.plan, event.time, event.result))

    def restore(self, topic: str, entries: Iterable[HistoryEntry]) -> None:
        """Take in entries from before, such as those of a journal.

        Args:
            topic: one of ``TOPICS``.
            entries: oldest first; of more than fit, the latest stay.
        """
        self._topics[topic].extend(entries)

    def of(self, topic: str, name: str | None, limit: int | None = None) -> tuple[HistoryEntry, ...]:
        """The entries of a topic, oldest first; with a name, those about that measure, element or action.

        Args:
            topic: one of ``TOPICS``.
            name: of a measure, element or action; None for all.
            limit: at most so many, the latest.

        Raises:
            InvalidValueError: if there is no such topic, or the limit is negative.
        """
        if topic not in self._topics:
            raise InvalidValueError(f"there is no history of '{topic}'; there is: {', '.join(TOPICS)}")
        if limit is not None and limit < 0:
            raise InvalidValueError(f"a limit cannot be negative: {limit}")
        entries = tuple(entry for entry in self._topics[topic] if concerns(entry, name))
        return entries if limit is None else entries[max(len(entries) - limit, 0) :]
