"""Diagnostics as a monitor publishes them, for robots without ROS."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

DiagnosticArray = dict[str, Any]
"""A ``diagnostic_msgs/DiagnosticArray`` as dicts."""


def diagnostic(stamp: float, name: str, message: str, key: str, value: str) -> DiagnosticArray:
    """An array with one value.

    Args:
        stamp: when it was observed, s.
        name: the monitor's name.
        message: what the value is: ``QA measurement``, ``EA measurement`` or ``Component status``
            (ROSA paper, section 6.2.2).
        key: the measure or the component.
        value: the measured number; ``FALSE`` for a component that has failed, ``RECOVERED`` for one that works again.

    Returns:
        the array, as :class:`~rosa_core.mape.DiagnosticsMonitor` takes it.

    Example:
        >>> array = diagnostic(2.5, "battery monitor", "QA measurement", "battery", "0.75")
        >>> [str(pair.key) for pair in values_of(array)]
        ['battery']
    """
    status = {"level": 0, "name": name, "message": message, "values": [{"key": key, "value": value}]}
    return {"header": {"stamp": stamp}, "status": [status]}


class DiagnosticValue(NamedTuple):
    """One value of an array: of which key, and what it is."""

    key: str
    value: str
    message: str


def values_of(array: DiagnosticArray) -> Iterator[DiagnosticValue]:
    """All values of an array, in order."""
    for status in array["status"]:
        for pair in status["values"]:
            yield DiagnosticValue(pair["key"], pair["value"], status["message"])
