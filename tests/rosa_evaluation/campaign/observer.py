"""An observer of a campaign that keeps what it was called with."""

from __future__ import annotations

from rosa_evaluation.campaign import PlannedRun, RunState


class RecordingObserver:
    """Keeps every call."""

    def __init__(self) -> None:
        self.runs = self.present = 0
        self.recorded: list[tuple[str, int, RunState]] = []
        self.losses: list[tuple[int, str, bool]] = []

    def started(self, runs: int, present: int) -> None:
        self.runs, self.present = runs, present

    def run_recorded(self, run: PlannedRun, state: RunState) -> None:
        self.recorded.append((run.manager.name, run.request.seed, state))

    def worker_lost(self, run: PlannedRun, reason: str, *, again: bool) -> None:
        self.losses.append((run.request.seed, reason, again))
