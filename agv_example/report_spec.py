"""What a report shows of the AGV: the map with its routes, drawn as everywhere else."""

from __future__ import annotations

from agv_example.drawing import draw_run
from rosa_evaluation.report import ReportSpec
from rosa_simulation.run_record import RunRecord


def report_spec() -> ReportSpec:
    """The guide."""
    return ReportSpec(draw=_draw)


def _draw(record: RunRecord) -> str:
    facts = [fact for event in record.events for fact in event.facts]
    return draw_run(record.inputs, facts, record.trajectory)
