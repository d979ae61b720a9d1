"""The robot's monitors: they publish what they see as ROS diagnostics."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray, diagnostic

COMPONENT_STATUS = "Component status"
"""The message of a diagnostic status about a component; the others are measurements."""


def water_visibility(stamp: float, visibility: float) -> DiagnosticArray:
    """How far one sees in the water, m.

    Args:
        stamp: the time, s.
        visibility: m.
    """
    return diagnostic(stamp, "water_visibility_observer", "EA measurement", "water_visibility", repr(visibility))


def battery_level(stamp: float, level: float) -> DiagnosticArray:
    """The charge of the battery, 0 to 1.

    Args:
        stamp: the time, s.
        level: 0, empty, to 1, full.
    """
    return diagnostic(stamp, "battery_monitor", "QA measurement", "battery_level", repr(level))


def thruster(stamp: float, number: int, works: bool) -> DiagnosticArray:
    """A thruster (1 to 6) failed or recovered.

    Args:
        stamp: the time, s.
        number: 1 to 6.
        works: False when it failed, True when it recovered.
    """
    value = "RECOVERED" if works else "FALSE"
    return diagnostic(stamp, "thruster_monitor", COMPONENT_STATUS, f"c_thruster_{number}", value)
