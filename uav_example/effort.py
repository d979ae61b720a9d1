"""The UAV's rows of table 7."""

from __future__ import annotations

from rosa_evaluation.effort import EffortRow, guarded_row, model_row


def effort_rows() -> list[EffortRow]:
    """The counted model of the paper (section 7.4.2), and what the guards of the mission's tree add."""
    model = model_row("UAV", "uav_example.models", ("uav.yaml",), 40)
    return [model, guarded_row(model, "uav_example.missions", "uav.xml")]
