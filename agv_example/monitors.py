"""The robot's monitors: they publish what they see as ROS diagnostics."""

from __future__ import annotations

from typing import Any

DiagnosticArray = dict[str, Any]


def _diagnostic(stamp: float, name: str, message: str, key: str, value: str) -> DiagnosticArray:
    status = {"level": 0, "name": name, "message": message, "values": [{"key": key, "value": value}]}
    return {"header": {"stamp": stamp}, "status": [status]}


def light(stamp: float, level: float) -> DiagnosticArray:
    """How light it is, from 0, dark, to 1."""
    return _diagnostic(stamp, "light_monitor", "EA measurement", "light", repr(level))


def battery_level(stamp: float, level: float) -> DiagnosticArray:
    """The charge of the battery, 0 to 1."""
    return _diagnostic(stamp, "battery_monitor", "QA measurement", "battery_level", repr(level))


def component(stamp: float, name: str, *, works: bool) -> DiagnosticArray:
    """A component failed or recovered."""
    return _diagnostic(stamp, "component_monitor", "Component status", name, "RECOVERED" if works else "FALSE")
