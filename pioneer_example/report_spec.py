"""What a report shows of the Pioneer: its metrics, and the trajectory as the paper's figure 4."""

from __future__ import annotations

from pioneer_example.drawing import draw_run
from pioneer_example.metrics import SONAR
from rosa_evaluation.report import ReportSpec


def report_spec() -> ReportSpec:
    """The guide."""
    return ReportSpec(draw=draw_run, uncertainties={SONAR: "the sonar ring fails"})
