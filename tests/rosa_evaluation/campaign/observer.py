"""Somebody who writes down what is told about a campaign."""

from __future__ import annotations

from rosa_evaluation.campaign import PlannedRun, RunState


class Witness:
    """Writes everything down."""

    def __init__(self) -> None:
        self.runs = self.present = 0
        self.settlements: list[tuple[str, int, RunState]] = []
        self.losses: list[tuple[int, str, bool]] = []

    def started(self, runs: int, present: int) -> None:
        self.runs, self.present = runs, present

    def settled(self, run: PlannedRun, state: RunState) -> None:
        self.settlements.append((run.manager.name, run.request.seed, state))

    def worker_lost(self, run: PlannedRun, reason: str, *, again: bool) -> None:
        self.losses.append((run.request.seed, reason, again))
