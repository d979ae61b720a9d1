"""The aircraft's monitors: they publish what they see as ROS diagnostics."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray
from rosa_simulation.monitors import component_status, quality

BATTERY_LEVEL = "qa_battery_level"
GRIPPER = "gripper"


def battery_level(stamp: float, level: float) -> DiagnosticArray:
    """The charge of the battery, 0 to 1, in steps of a thousandth.

    Args:
        stamp: the time, s.
        level: 0, empty, to 1, full.
    """
    return quality(stamp, "battery_monitor", BATTERY_LEVEL, round(level, 3))


def gripper_failed(stamp: float) -> DiagnosticArray:
    """The gripper has failed."""
    return component_status(stamp, "gripper_monitor", GRIPPER, works=False)
