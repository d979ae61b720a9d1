"""The AGV's rows of table 7."""

from __future__ import annotations

from rosa_evaluation.effort import EffortRow, model_row


def effort_rows() -> list[EffortRow]:
    """The counted model of the paper (section 7.4.1), without what missions add to it."""
    return [model_row("AGV", "agv_example.models", ("agv.yaml",), 54)]
