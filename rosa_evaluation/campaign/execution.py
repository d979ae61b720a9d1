"""Carrying out a campaign: what is missing goes to the workers, what comes back to the writer."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing
from dataclasses import dataclass
from typing import Protocol

from rosa_evaluation.campaign.plan import CampaignPlan, PlannedRun
from rosa_evaluation.campaign.results_writer import ResultsWriter
from rosa_evaluation.campaign.schema import RunState
from rosa_evaluation.campaign.workers import RunFailed, RunOutcome, WorkerLost, Workers, differences

MOST_ATTEMPTS = 3
"""A run whose worker dies this often is recorded as failed: most likely the run is what kills it."""
_WAIT = 0.25


class CampaignObserver(Protocol):
    """Whoever watches a campaign."""

    def started(self, runs: int, present: int) -> None:
        """A campaign begins.

        Args:
            runs: how many it consists of.
            present: how many of them are recorded already.
        """
        ...

    def run_recorded(self, run: PlannedRun, state: RunState) -> None:
        """A run has been recorded.

        Args:
            run: which one.
            state: as what it has been recorded.
        """
        ...

    def worker_lost(self, run: PlannedRun, reason: str, *, again: bool) -> None:
        """A worker ended in the middle of a run.

        Args:
            run: the run that it had.
            reason: how it ended.
            again: whether the run is begun again; otherwise it is recorded as failed.
        """
        ...


@dataclass(frozen=True, slots=True)
class CampaignOutcome:
    """What came of a campaign, in numbers of runs.

    Attributes:
        present: recorded before it was executed.
        carried_out: recorded since.
        done: recorded as done, before or since.
        failed: recorded as failed, before or since.
        missing: still to be carried out.
    """

    present: int
    carried_out: int
    done: int
    failed: int
    missing: int


def execute_campaign(
    plan: CampaignPlan,
    writer: ResultsWriter,
    start_workers: Callable[[int], Workers],
    observer: CampaignObserver,
    *,
    retry_failed: bool = False,
    stopping: Callable[[], bool] = lambda: False,
) -> CampaignOutcome:
    """Carry out the runs of a plan that are not recorded yet.

    Args:
        plan: what is to be run.
        writer: where results are, and go to.
        start_workers: makes those who carry out that many runs; not called when nothing is missing.
        observer: who watches it.
        retry_failed: whether runs that are recorded as failed are tried again.
        stopping: once it is true no further run is begun; those that have begun are finished.

    Returns:
        how many runs are recorded, as what, and how many are missing.

    Raises:
        ResultsError: if results cannot be written any more.
        WorkersError: if workers cannot be started; WorkersGoneError if there are none any more.
    """
    states = writer.begin(plan)
    if retry_failed:
        states = {run_id: state for run_id, state in states.items() if state is RunState.DONE}
    present = len(states)
    observer.started(len(plan.runs), present)
    missing = [run for run in plan.runs if run.run_id not in states]
    if missing:
        with closing(start_workers(len(missing))) as workers:
            for run, outcome in _outcomes(missing, workers, observer, stopping):
                states[run.run_id] = _record(plan, writer, run, outcome)
                observer.run_recorded(run, states[run.run_id])
    count = Counter(states.values())
    done, failed = count[RunState.DONE], count[RunState.FAILED]
    return CampaignOutcome(present, len(states) - present, done, failed, len(plan.runs) - len(states))


def _outcomes(
    missing: Iterable[PlannedRun], workers: Workers, observer: CampaignObserver, stopping: Callable[[], bool]
) -> Iterator[tuple[PlannedRun, RunOutcome]]:
    """What becomes of the runs, as they end; a run whose worker was lost is begun again, before all others."""
    waiting = deque(missing)
    under_way: dict[str, PlannedRun] = {}
    deaths: Counter[str] = Counter()
    while under_way or waiting:
        if stopping():
            waiting.clear()
        for _ in range(min(workers.free(), len(waiting))):
            run = waiting.popleft()
            workers.submit(run.run_id, run.request)
            under_way[run.run_id] = run
        for run_id, outcome in workers.finished(_WAIT):
            run = under_way.pop(run_id)
            if isinstance(outcome, WorkerLost):
                deaths[run_id] += 1
                again = deaths[run_id] < MOST_ATTEMPTS
                observer.worker_lost(run, outcome.reason, again=again)
                if again:
                    waiting.appendleft(run)
                    continue
            yield run, outcome


def _record(plan: CampaignPlan, writer: ResultsWriter, run: PlannedRun, outcome: RunOutcome) -> RunState:
    match outcome:
        case RunFailed(reason):
            error = reason
        case WorkerLost(reason):
            error = f"its worker died {MOST_ATTEMPTS} times; the last time {reason}"
        case record:
            different = differences(plan.versions, record.versions)
            if not different:
                writer.add(run, record)
                return RunState.DONE
            error = f"it was run with other versions: {', '.join(different)}"
    writer.add_failure(run, plan, error)
    return RunState.FAILED
