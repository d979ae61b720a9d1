"""What a report shows of the UAV: a picture of each flight."""

from __future__ import annotations

from rosa_evaluation.report import ReportSpec
from uav_example.drawing import draw_flight


def report_spec() -> ReportSpec:
    """How runs are shown."""
    return ReportSpec(draw=draw_flight)
