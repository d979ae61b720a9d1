"""The robot's monitors: they publish what they see as ROS diagnostics."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray
from rosa_simulation.monitors import component_status, environment, quality


def light(stamp: float, level: float) -> DiagnosticArray:
    """How light it is, from 0, dark, to 1.

    Args:
        stamp: the time, s.
        level: the light in the corridor that the robot faces.
    """
    return environment(stamp, "light_monitor", "light", level)


def battery_level(stamp: float, level: float) -> DiagnosticArray:
    """The charge of the battery, 0 to 1.

    Args:
        stamp: the time, s.
        level: 0, empty, to 1, full.
    """
    return quality(stamp, "battery_monitor", "battery_level", level)


def component(stamp: float, name: str, *, works: bool) -> DiagnosticArray:
    """A component failed or recovered.

    Args:
        stamp: the time, s.
        name: of the component.
        works: False when it failed, True when it recovered.
    """
    return component_status(stamp, "component_monitor", name, works=works)
