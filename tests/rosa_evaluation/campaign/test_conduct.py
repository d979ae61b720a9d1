"""Campaigns on this machine: whatever becomes of runs and workers, every run is recorded once."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rosa_evaluation.campaign import (
    CampaignPlan,
    Conducted,
    LocalWorkers,
    Results,
    ResultsWriter,
    RunState,
    StoredRun,
    WorkersError,
    conduct,
)
from rosa_simulation.scenario import SilentObserver
from tests.rosa_evaluation.campaign.observer import Witness
from tests.rosa_evaluation.campaign.scenarios import Walk, plan

ROOT = Path(__file__).resolve().parents[3]


def carry_out(
    some: CampaignPlan, out: Path, witness: Witness | None = None, *, retry_failed: bool = False
) -> Conducted:
    with ResultsWriter(out) as writer:
        return conduct(
            some,
            writer,
            lambda runs: LocalWorkers(some.scenario, min(runs, 2)),
            witness or Witness(),
            retry_failed=retry_failed,
        )


def stored(some: CampaignPlan, out: Path) -> list[StoredRun]:
    with Results(out) as results:
        return results.runs(some.campaign_id)


def test_every_run_is_carried_out_once_and_gives_what_it_gives_alone(tmp_path: Path) -> None:
    walk = Walk(diary=str(tmp_path / "diary"))
    some, witness = plan(walk), Witness()
    conducted = carry_out(some, tmp_path, witness)
    assert conducted == Conducted(present=0, carried_out=8, done=8, failed=0, missing=0)
    assert (witness.runs, witness.present, len(witness.settlements)) == (8, 0, 8)
    assert [len(walk.visits(run.request)) for run in some.runs] == [1] * 8
    with Results(tmp_path) as results:
        for run in some.runs:
            assert results.record(run.run_id) == Walk().run(run.request, SilentObserver())


def test_the_same_again_runs_nothing_and_more_of_it_only_what_is_missing(tmp_path: Path) -> None:
    walk = Walk(diary=str(tmp_path / "diary"))
    carry_out(plan(walk, runs=2), tmp_path)
    with ResultsWriter(tmp_path) as writer:
        again = conduct(plan(walk, runs=2), writer, lambda _: pytest.fail("no workers are needed"), Witness())
    assert again == Conducted(present=4, carried_out=0, done=4, failed=0, missing=0)
    more = carry_out(plan(walk, runs=3, managers="calm,wild,calm-pddl"), tmp_path)
    assert (more.present, more.carried_out) == (4, 5)


def test_a_run_that_fails_is_recorded_with_its_traceback_and_the_others_go_on(tmp_path: Path) -> None:
    walk = Walk(fates=((101, "error"), (102, "exit")))
    some = plan(walk, managers="calm")
    assert carry_out(some, tmp_path) == Conducted(present=0, carried_out=4, done=2, failed=2, missing=0)
    runs = stored(some, tmp_path)
    assert [run.state for run in runs] == [RunState.DONE, RunState.FAILED, RunState.FAILED, RunState.DONE]
    assert "Traceback" in (runs[1].error or "")
    assert "ZeroDivisionError: the ground is missing" in (runs[1].error or "")
    assert "SystemExit: 3" in (runs[2].error or "")


def test_what_failed_is_tried_again_only_when_asked_for(tmp_path: Path) -> None:
    some = plan(Walk(fates=((101, "error"),)), managers="calm")
    carry_out(some, tmp_path)
    fixed = plan(Walk(), managers="calm")
    assert carry_out(fixed, tmp_path).carried_out == 0
    assert carry_out(fixed, tmp_path, retry_failed=True) == Conducted(3, 1, done=4, failed=0, missing=0)


def test_a_worker_that_dies_costs_its_run_which_is_done_again(tmp_path: Path) -> None:
    walk = Walk(diary=str(tmp_path / "diary"), fates=((102, "die once"),))
    some, witness = plan(walk, runs=6, managers="calm"), Witness()
    assert carry_out(some, tmp_path, witness).done == 6
    assert [len(walk.visits(run.request)) for run in some.runs] == [1, 1, 2, 1, 1, 1]
    assert witness.losses == [(102, "it was ended by signal SIGKILL", True)]


def test_a_run_that_kills_its_worker_again_and_again_is_recorded_as_failed(tmp_path: Path) -> None:
    walk = Walk(diary=str(tmp_path / "diary"), fates=((101, "die"),))
    some, witness = plan(walk, managers="calm"), Witness()
    assert carry_out(some, tmp_path, witness) == Conducted(0, 4, done=3, failed=1, missing=0)
    assert [len(walk.visits(run.request)) for run in some.runs] == [1, 3, 1, 1]
    assert "its worker died 3 times" in (stored(some, tmp_path)[1].error or "")
    assert [again for _, _, again in witness.losses] == [True, True, False]


def test_a_worker_that_dies_while_it_has_nothing_to_do_costs_nothing() -> None:
    some = plan(Walk(), managers="calm")
    workers = LocalWorkers(some.scenario, 1)
    try:
        workers.submit("first", some.runs[0].request)
        (first,) = workers.finished(10.0)
        os.kill(_children()[-1], signal.SIGKILL)
        time.sleep(0.2)
        workers.submit("second", some.runs[1].request)
        (second,) = workers.finished(10.0)
    finally:
        workers.close()
    assert [key for key, _ in (first, second)] == ["first", "second"]
    assert second[1] == Walk().run(some.runs[1].request, SilentObserver())


def _children() -> list[int]:
    tasks = Path(f"/proc/{os.getpid()}/task").iterdir()
    found = {int(child) for task in tasks for child in (task / "children").read_text(encoding="utf-8").split()}
    # The resource tracker of multiprocessing is a child as well; it was there first.
    return sorted(found)


def test_stopping_finishes_what_has_begun_and_begins_nothing_more(tmp_path: Path) -> None:
    some, witness = plan(Walk(fates=((100, "slow"),)), runs=20, managers="calm"), Witness()
    with ResultsWriter(tmp_path) as writer:
        conducted = conduct(
            some,
            writer,
            lambda _: LocalWorkers(some.scenario, 2),
            witness,
            stopping=lambda: len(witness.settlements) >= 3,
        )
    assert 3 <= conducted.done < 20
    assert conducted.done + conducted.missing == 20
    # The slow run had begun first, so that it was finished.
    assert ("calm", 100, RunState.DONE) in witness.settlements
    assert carry_out(some, tmp_path).present == conducted.done


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
    diary = tmp_path / "diary"
    code = (
        "import sys\n"
        "from tests.rosa_evaluation.campaign.scenarios import Walk, plan\n"
        "from tests.rosa_evaluation.campaign.test_conduct import carry_out\n"
        "from pathlib import Path\n"
        "if __name__ == '__main__':\n"
        "    fates = tuple((seed, 'slow') for seed in range(104, 112))\n"
        "    carry_out(plan(Walk(sys.argv[1], fates), runs=12, managers='calm'), Path(sys.argv[2]))\n"
    )
    script = tmp_path / "script.py"
    script.write_text(code, encoding="utf-8")
    command = [sys.executable, str(script), str(diary), str(tmp_path)]
    with subprocess.Popen(command, env={**os.environ, "PYTHONPATH": str(ROOT)}) as process:
        while not diary.exists() or len(diary.read_text(encoding="utf-8").splitlines()) < 7:
            assert process.poll() is None
            time.sleep(0.05)
        process.kill()
    before = diary.read_text(encoding="utf-8").splitlines()
    workers = {int(line.split()[2]) for line in before}
    walk = Walk(str(diary))
    some = plan(walk, runs=12, managers="calm")
    conducted = carry_out(some, tmp_path)
    assert (conducted.done, conducted.missing) == (12, 0)
    # At most the two that were under way, and those that were finished but not written yet, are done again.
    assert 1 <= conducted.present <= 7
    again = [run for run in some.runs if len(walk.visits(run.request)) == 2]
    assert len(again) <= 3
    deadline = time.monotonic() + 10
    while any(map(_lives, workers)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(map(_lives, workers))


def _lives(process: int) -> bool:
    with contextlib.suppress(OSError):
        return Path(f"/proc/{process}/stat").read_text(encoding="utf-8").split()[2] != "Z"
    return False
