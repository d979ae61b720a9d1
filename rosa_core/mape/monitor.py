"""Monitoring data in, as ROS diagnostics: what a status means, and what of it the knowledge base learns.

Accepted is a ``diagnostic_msgs/DiagnosticArray``, or anything with the same attributes, or the same as dicts:
``{"header": {"stamp": ...}, "status": [{"message": ..., "values": [{"key": ..., "value": ...}]}]}``.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

from rosa_core.errors import KnowledgeBaseError
from rosa_core.kb.knowledge_base import KnowledgeBase

logger = logging.getLogger(__name__)


class _Meaning(Enum):
    MEASUREMENT = "measurement"
    COMPONENT_STATUS = "component status"


_MEANINGS = {
    "qa status": _Meaning.MEASUREMENT,
    "qa measurement": _Meaning.MEASUREMENT,
    "ea status": _Meaning.MEASUREMENT,
    "ea measurement": _Meaning.MEASUREMENT,
    "attribute measurement": _Meaning.MEASUREMENT,
    "component status": _Meaning.COMPONENT_STATUS,
    "component": _Meaning.COMPONENT_STATUS,
}
MOST_ITEMS = 10_000
"""Statuses of an array, or values of a status, that are read."""

_FAILURES = frozenset({"false", "failure", "error"})
_RECOVERIES = frozenset({"recovered", "ok"})


@dataclass(frozen=True, slots=True)
class MonitorReport:
    """What became of one diagnostic array.

    Attributes:
        written: how many values the knowledge base took.
        ignored: how many statuses are not about what it knows.
        rejected: for each value that could not be used, why not.
    """

    written: int
    ignored: int
    rejected: tuple[str, ...]


class DiagnosticsMonitor:
    """Writes diagnostics to the knowledge base (ROSA paper, section 6.2.2).

    Args:
        kb: the knowledge base.

    Attributes:
        rejected: how many values could not be used so far.

    Example:
        >>> from rosa_core import KnowledgeBase, KnowledgeModel
        >>> from rosa_core.mape.diagnostics import diagnostic
        >>> from rosa_core.model.elements import Measure
        >>> kb = KnowledgeBase(KnowledgeModel(measures=(Measure("battery"),)))
        >>> monitor = DiagnosticsMonitor(kb)
        >>> monitor.update(diagnostic(2.5, "battery monitor", "QA measurement", "battery", "0.75"))
        MonitorReport(written=1, ignored=0, rejected=())
        >>> kb.measurement("battery")
        Measurement(measure='battery', value=0.75, time=2.5)
    """

    def __init__(self, kb: KnowledgeBase) -> None:
        self._kb = kb
        self.rejected = 0

    def update(self, diagnostic_array: Any) -> MonitorReport:
        """Write everything in the array as one transaction.

        Every value is taken on its own, in order. Unknown names and unreadable values are counted and logged; the
        rest is still written.

        Args:
            diagnostic_array: a ``diagnostic_msgs/DiagnosticArray``, or anything with the same attributes or keys. Its
                stamp, in seconds, is the time of all that it says; without one, now is.

        Returns:
            what became of its values.
        """
        time = _stamp(_get(_get(diagnostic_array, "header"), "stamp"))
        written = ignored = 0
        rejected: list[str] = []
        with self._kb.transaction():
            for status in _sequence(_get(diagnostic_array, "status"), "statuses", rejected):
                meaning = _meaning(status)
                if meaning is None:
                    ignored += 1
                    continue
                for pair in _sequence(_get(status, "values"), "values", rejected):
                    try:
                        self._write(meaning, _text(_get(pair, "key")), _text(_get(pair, "value")), time)
                        written += 1
                    except KnowledgeBaseError as error:
                        rejected.append(str(error))
        for reason in rejected:
            logger.warning("a diagnostic value is not used: %s", reason)
        self.rejected += len(rejected)
        return MonitorReport(written, ignored, tuple(rejected))

    def _write(self, meaning: _Meaning, key: str, value: str, time: float | None) -> None:
        if meaning is _Meaning.MEASUREMENT:
            self._kb.add_measurement(key, _number(key, value), time)
            return
        word = value.strip().lower()
        if word in _FAILURES:
            self._kb.set_component_failure(key, time)
        elif word in _RECOVERIES:
            self._kb.clear_component_failure(key)
        else:
            raise KnowledgeBaseError(f"'{value}' of component '{key}' means neither failure nor recovery")


def _number(key: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise KnowledgeBaseError(f"the measurement of '{key}' is not a number: {text!r}") from None


def _meaning(status: Any) -> _Meaning | None:
    """What the values of a status are; None if they are nothing that the knowledge base is about."""
    try:
        return _MEANINGS.get(_text(_get(status, "message")).strip().lower())
    except KnowledgeBaseError:
        return None


# What comes from outside may be any object, and each of these steps may run code of its class: whatever that raises
# concerns one value, and the others are written.


def _get(thing: Any, field: str) -> Any:
    """A field of a message or of a dict; None if it is not there, or cannot be read."""
    try:
        return thing.get(field) if isinstance(thing, Mapping) else getattr(thing, field, None)
    except Exception:
        return None


def _text(value: Any) -> str:
    """A value as text.

    Raises:
        KnowledgeBaseError: if it has none.
    """
    try:
        return "" if value is None else str(value)
    except Exception as error:
        what = f"a value of type {type(value).__name__} cannot be read: {type(error).__name__}"
        raise KnowledgeBaseError(what) from None


def _sequence(value: Any, of_what: str, rejected: list[str]) -> Iterator[Any]:
    """The items of a sequence, as far as they can be read and are not too many; what stopped them is added."""
    try:
        if not isinstance(value, Iterable) or isinstance(value, str | bytes | Mapping):
            return
        for number, item in enumerate(value):
            if number == MOST_ITEMS:
                rejected.append(f"there are more than {MOST_ITEMS} {of_what}: the others are not read")
                return
            yield item
    except Exception as error:
        rejected.append(f"the {of_what} of type {type(value).__name__} cannot be read: {type(error).__name__}")


def _stamp(stamp: Any) -> float | None:
    """Seconds from a ``builtin_interfaces/Time``, a dict of the same, or a number; None when there is no stamp."""
    try:
        if isinstance(stamp, int | float):
            seconds = float(stamp)
        else:
            seconds = float(_get(stamp, "sec")) + float(_get(stamp, "nanosec") or 0) * 1e-9
    except Exception:
        return None
    return seconds if math.isfinite(seconds) else None
