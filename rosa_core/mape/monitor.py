"""Monitoring data in, as ROS diagnostics: what a status means, and what of it the knowledge base learns.

Accepted is a ``diagnostic_msgs/DiagnosticArray``, or anything with the same attributes, or the same as dicts:
``{"header": {"stamp": ...}, "status": [{"message": ..., "values": [{"key": ..., "value": ...}]}]}``.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Iterable, Mapping
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
            for status in _sequence(_get(diagnostic_array, "status")):
                meaning = _MEANINGS.get(_text(_get(status, "message")).strip().lower())
                if meaning is None:
                    ignored += 1
                    continue
                for pair in _sequence(_get(status, "values")):
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


def _get(thing: Any, field: str) -> Any:
    """A field of a message or of a dict; None if it is not there."""
    if isinstance(thing, Mapping):
        return thing.get(field)
    return getattr(thing, field, None)


def _text(value: Any) -> str:
    try:
        return "" if value is None else str(value)
    except ValueError:  # an integer of thousands of digits
        return f"a {type(value).__name__} too large to read"


def _sequence(value: Any) -> Iterable[Any]:
    return value if isinstance(value, Iterable) and not isinstance(value, str | bytes | Mapping) else ()


def _stamp(stamp: Any) -> float | None:
    """Seconds from a ``builtin_interfaces/Time``, a dict of the same, or a number; None when there is no stamp."""
    try:
        if isinstance(stamp, int | float):
            seconds = float(stamp)
        else:
            seconds = float(_get(stamp, "sec")) + float(_get(stamp, "nanosec") or 0) * 1e-9
    except (TypeError, ValueError, OverflowError):
        return None
    return seconds if math.isfinite(seconds) else None
