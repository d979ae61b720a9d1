"""The AGV's rows of table 7."""

from __future__ import annotations

from rosa_evaluation.effort import EffortRow, guarded_row, model_row


def effort_rows() -> list[EffortRow]:
    """The counted model of the paper (section 7.4.1), and the guards of our mission's tree."""
    model = model_row("AGV", "agv_example.models", ("agv.yaml",), 54)
    return [model, guarded_row(model, "agv_example.missions", "agv.xml")]
