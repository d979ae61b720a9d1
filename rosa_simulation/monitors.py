"""What the monitors of simulated robots publish, as ROS diagnostics (ROSA paper, section 6.2.2)."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray, diagnostic

COMPONENT_STATUS = "Component status"
"""The message of a diagnostic about a component; all others are about measurements."""
FAILED, RECOVERED = "FALSE", "RECOVERED"


def quality(stamp: float, monitor: str, measure: str, value: float) -> DiagnosticArray:
    """A measurement of a quality attribute of the robot.

    Args:
        stamp: the time, s.
        monitor: its name.
        measure: as in the knowledge model.
        value: in the measure's unit.

    Example:
        >>> quality(2.0, "battery_monitor", "battery_level", 0.75)["status"][0]["values"]
        [{'key': 'battery_level', 'value': '0.75'}]
    """
    return diagnostic(stamp, monitor, "QA measurement", measure, repr(value))


def environment(stamp: float, monitor: str, measure: str, value: float) -> DiagnosticArray:
    """A measurement of an attribute of the robot's environment.

    Args:
        stamp: the time, s.
        monitor: its name.
        measure: as in the knowledge model.
        value: in the measure's unit.
    """
    return diagnostic(stamp, monitor, "EA measurement", measure, repr(value))


def component_status(stamp: float, monitor: str, component: str, *, works: bool) -> DiagnosticArray:
    """A component failed or recovered.

    Args:
        stamp: the time, s.
        monitor: its name.
        component: as in the knowledge model.
        works: False when it failed, True when it recovered.
    """
    return diagnostic(stamp, monitor, COMPONENT_STATUS, component, RECOVERED if works else FAILED)
