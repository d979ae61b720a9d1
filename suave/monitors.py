"""The robot's monitors: they publish what they see as ROS diagnostics."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray
from rosa_simulation.monitors import component_status, environment, quality


def water_visibility(stamp: float, visibility: float) -> DiagnosticArray:
    """How far one sees in the water, m.

    Args:
        stamp: the time, s.
        visibility: m.
    """
    return environment(stamp, "water_visibility_observer", "water_visibility", visibility)


def battery_level(stamp: float, level: float) -> DiagnosticArray:
    """The charge of the battery, 0 to 1.

    Args:
        stamp: the time, s.
        level: 0, empty, to 1, full.
    """
    return quality(stamp, "battery_monitor", "battery_level", level)


def thruster(stamp: float, number: int, works: bool) -> DiagnosticArray:
    """A thruster (1 to 6) failed or recovered.

    Args:
        stamp: the time, s.
        number: 1 to 6.
        works: False when it failed, True when it recovered.
    """
    return component_status(stamp, "thruster_monitor", f"c_thruster_{number}", works=works)
