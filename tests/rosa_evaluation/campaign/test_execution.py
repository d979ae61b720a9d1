"""Campaigns on this machine: whatever becomes of runs and workers, every run is recorded once."""

from __future__ import annotations

import contextlib
import os
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rosa_evaluation.campaign import (
    CampaignOutcome,
    CampaignPlan,
    LocalWorkers,
    Results,
    ResultsWriter,
    RunState,
    StoredRun,
    WorkersError,
    execute_campaign,
)
from rosa_simulation.scenario import SilentObserver
from tests.rosa_evaluation.campaign.observer import RecordingObserver
from tests.rosa_evaluation.campaign.scenarios import Walk, plan

ROOT = Path(__file__).resolve().parents[3]
UNBOUNDED = 3600.0
"""Seconds: what is waited for comes, or the worker is lost, which is an outcome as well."""


def carry_out(
    some: CampaignPlan, out: Path, observer: RecordingObserver | None = None, *, retry_failed: bool = False
) -> CampaignOutcome:
    with ResultsWriter(out) as writer:
        return execute_campaign(
            some,
            writer,
            lambda runs: LocalWorkers(some.scenario, min(runs, 2)),
            observer or RecordingObserver(),
            retry_failed=retry_failed,
        )


def stored(some: CampaignPlan, out: Path) -> list[StoredRun]:
    with Results(out) as results:
        return results.runs(some.campaign_id)


def test_every_run_is_carried_out_once_and_gives_what_it_gives_alone(tmp_path: Path) -> None:
    walk = Walk(log=str(tmp_path / "log"))
    some, observer = plan(walk), RecordingObserver()
    outcome = carry_out(some, tmp_path, observer)
    assert outcome == CampaignOutcome(present=0, carried_out=8, done=8, failed=0, missing=0)
    assert (observer.runs, observer.present, len(observer.recorded)) == (8, 0, 8)
    assert [len(walk.visits(run.request)) for run in some.runs] == [1] * 8
    with Results(tmp_path) as results:
        for run in some.runs:
            assert results.record(run.run_id) == Walk().run(run.request, SilentObserver())


def test_the_same_again_runs_nothing_and_more_of_it_only_what_is_missing(tmp_path: Path) -> None:
    walk = Walk(log=str(tmp_path / "log"))
    carry_out(plan(walk, runs=2), tmp_path)
    with ResultsWriter(tmp_path) as writer:
        again = execute_campaign(
            plan(walk, runs=2), writer, lambda _: pytest.fail("no workers are needed"), RecordingObserver()
        )
    assert again == CampaignOutcome(present=4, carried_out=0, done=4, failed=0, missing=0)
    more = carry_out(plan(walk, runs=3, managers="calm,wild,calm-pddl"), tmp_path)
    assert (more.present, more.carried_out) == (4, 5)


def test_a_run_that_fails_is_recorded_with_its_traceback_and_the_others_go_on(tmp_path: Path) -> None:
    walk = Walk(faults=((101, "error"), (102, "exit")))
    some = plan(walk, managers="calm")
    assert carry_out(some, tmp_path) == CampaignOutcome(present=0, carried_out=4, done=2, failed=2, missing=0)
    runs = stored(some, tmp_path)
    assert [run.state for run in runs] == [RunState.DONE, RunState.FAILED, RunState.FAILED, RunState.DONE]
    assert "Traceback" in (runs[1].error or "")
    assert "ZeroDivisionError: the ground is missing" in (runs[1].error or "")
    assert "SystemExit: 3" in (runs[2].error or "")


def test_what_failed_is_tried_again_only_when_asked_for(tmp_path: Path) -> None:
    some = plan(Walk(faults=((101, "error"),)), managers="calm")
    carry_out(some, tmp_path)
    fixed = plan(Walk(), managers="calm")
    assert carry_out(fixed, tmp_path).carried_out == 0
    assert carry_out(fixed, tmp_path, retry_failed=True) == CampaignOutcome(3, 1, done=4, failed=0, missing=0)


def test_a_worker_that_dies_costs_its_run_which_is_done_again(tmp_path: Path) -> None:
    walk = Walk(log=str(tmp_path / "log"), faults=((102, "die once"),))
    some, observer = plan(walk, runs=6, managers="calm"), RecordingObserver()
    assert carry_out(some, tmp_path, observer).done == 6
    assert [len(walk.visits(run.request)) for run in some.runs] == [1, 1, 2, 1, 1, 1]
    assert observer.losses == [(102, "it was ended by signal SIGKILL", True)]


def test_a_run_that_kills_its_worker_again_and_again_is_recorded_as_failed(tmp_path: Path) -> None:
    walk = Walk(log=str(tmp_path / "log"), faults=((101, "die"),))
    some, observer = plan(walk, managers="calm"), RecordingObserver()
    assert carry_out(some, tmp_path, observer) == CampaignOutcome(0, 4, done=3, failed=1, missing=0)
    assert [len(walk.visits(run.request)) for run in some.runs] == [1, 3, 1, 1]
    assert "its worker died 3 times" in (stored(some, tmp_path)[1].error or "")
    assert [again for _, _, again in observer.losses] == [True, True, False]


def test_a_worker_that_dies_while_it_has_nothing_to_do_costs_nothing() -> None:
    some = plan(Walk(), managers="calm")
    workers = LocalWorkers(some.scenario, 1)
    try:
        workers.submit("first", some.runs[0].request)
        (first,) = workers.finished(UNBOUNDED)
        worker = _children()[-1]
        os.kill(worker, signal.SIGKILL)
        await_end(worker)
        workers.submit("second", some.runs[1].request)
        (second,) = workers.finished(UNBOUNDED)
    finally:
        workers.close()
    assert [key for key, _ in (first, second)] == ["first", "second"]
    assert second[1] == Walk().run(some.runs[1].request, SilentObserver())


def await_end(process: int) -> None:
    """Wait until a process has ended, whoever its parent is."""
    with contextlib.suppress(ProcessLookupError):
        descriptor = os.pidfd_open(process)
        try:
            select.select([descriptor], [], [])
        finally:
            os.close(descriptor)


def _children() -> list[int]:
    tasks = Path(f"/proc/{os.getpid()}/task").iterdir()
    found = {int(child) for task in tasks for child in (task / "children").read_text(encoding="utf-8").split()}
    # The resource tracker of multiprocessing is a child as well; it was there first.
    return sorted(found)


def test_stopping_finishes_what_has_begun_and_begins_nothing_more(tmp_path: Path) -> None:
    walk = Walk(log=str(tmp_path / "log"), faults=((100, "wait"),))
    some, observer = plan(walk, runs=20, managers="calm"), RecordingObserver()

    def stopping() -> bool:
        """After three runs; only then may the first one end."""
        if len(observer.recorded) >= 3:
            walk.release()
        return len(observer.recorded) >= 3

    with ResultsWriter(tmp_path) as writer:
        outcome = execute_campaign(
            some,
            writer,
            lambda _: LocalWorkers(some.scenario, 2),
            observer,
            stopping=stopping,
        )
    assert 3 <= outcome.done < 20
    assert outcome.done + outcome.missing == 20
    # It had begun first, and had not ended when everything was to stop.
    assert ("calm", 100, RunState.DONE) in observer.recorded
    assert carry_out(some, tmp_path).present == outcome.done


def test_a_run_with_other_versions_than_planned_is_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "rosa_evaluation.campaign.plan.package_versions", lambda: {"python": "3.11", "mujoco": "0.1", "numpy": "1"}
    )
    some = plan(Walk(), runs=1, managers="calm")
    assert carry_out(some, tmp_path).failed == 1
    assert "other versions: mujoco" in (stored(some, tmp_path)[0].error or "")


def test_a_scenario_that_workers_cannot_have_is_an_error_at_once(tmp_path: Path) -> None:
    class Hidden(Walk):
        pass

    with pytest.raises(WorkersError, match="cannot be started"):
        LocalWorkers(Hidden(), 2)


class Unloadable(Walk):
    """Can be sent, but not received."""

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return _refuse, ("x",)


def _refuse(_: str) -> None:
    raise RuntimeError("not here")


def test_a_worker_that_cannot_start_is_an_error_at_once() -> None:
    with pytest.raises(WorkersError, match="does not start: it ended with exit code 1"):
        LocalWorkers(Unloadable(), 1)


def test_killed_as_a_whole_a_campaign_goes_on_where_it_was_and_its_workers_are_gone(tmp_path: Path) -> None:
    walk = Walk(str(tmp_path / "log"))
    code = (
        "import sys\n"
        "from tests.rosa_evaluation.campaign.scenarios import Walk, plan\n"
        "from tests.rosa_evaluation.campaign.test_execution import carry_out\n"
        "from pathlib import Path\n"
        "if __name__ == '__main__':\n"
        "    faults = tuple((seed, 'wait') for seed in range(104, 112))\n"
        "    carry_out(plan(Walk(sys.argv[1], faults), runs=12, managers='calm'), Path(sys.argv[2]))\n"
    )
    script = tmp_path / "script.py"
    script.write_text(code, encoding="utf-8")
    command = [sys.executable, str(script), walk.log, str(tmp_path)]
    with subprocess.Popen(command, env={**os.environ, "PYTHONPATH": str(ROOT)}) as process:
        while len(walk.begun()) < 6:
            assert process.poll() is None
            time.sleep(0.01)
        process.kill()
    workers = {int(line.split()[2]) for line in walk.begun()}
    walk.release()
    some = plan(walk, runs=12, managers="calm")
    outcome = carry_out(some, tmp_path)
    assert (outcome.done, outcome.missing) == (12, 0)
    # The two that were under way are done again, and nothing else: a run is recorded before the next one is begun.
    assert outcome.present == 4
    assert [len(walk.visits(run.request)) for run in some.runs] == [*[1] * 4, 2, 2, *[1] * 6]
    for worker in workers:
        await_end(worker)
