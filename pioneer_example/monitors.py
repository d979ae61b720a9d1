"""The robot's monitors: they publish what they see as ROS diagnostics."""

from __future__ import annotations

from rosa_core.mape.diagnostics import DiagnosticArray, diagnostic


def range_rate(stamp: float, rate: float) -> DiagnosticArray:
    """How often ranges are measured, 1/s."""
    return diagnostic(stamp, "range_monitor", "QA measurement", "range_rate", repr(rate))


def preemptions(stamp: float, per_minute: float) -> DiagnosticArray:
    """How often reflexes take the command, 1/min."""
    return diagnostic(stamp, "gate_monitor", "QA measurement", "preemptions_per_minute", repr(per_minute))


def clearance(stamp: float, distance: float) -> DiagnosticArray:
    """How far the nearest thing is that is seen, m."""
    return diagnostic(stamp, "range_monitor", "EA measurement", "clearance", repr(round(distance, 4)))


def component(stamp: float, name: str, *, works: bool) -> DiagnosticArray:
    """A component failed or recovered."""
    return diagnostic(stamp, "component_monitor", "Component status", name, "RECOVERED" if works else "FALSE")
