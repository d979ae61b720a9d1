"""Campaigns on a Dask cluster: a scheduler and two workers, each a process of its own on this machine."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path

import pytest

from rosa_evaluation.campaign import CampaignOutcome, Results, ResultsWriter, RunState, WorkersError, execute_campaign
from rosa_evaluation.campaign.cluster_workers import ClusterWorkers
from rosa_simulation.scenario import SilentObserver
from tests.rosa_cli.cli import refused, rosa
from tests.rosa_cli.test_campaign_command import await_runs, begun
from tests.rosa_evaluation.campaign.observer import RecordingObserver
from tests.rosa_evaluation.campaign.scenarios import Walk, plan

pytestmark = pytest.mark.slow
ROOT = Path(__file__).resolve().parents[3]
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "DASK_DISTRIBUTED__DASHBOARD__ENABLED": "False"}


@contextmanager
def dask(*arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """A process of the cluster, killed in the end."""
    command = [sys.executable, "-m", f"distributed.cli.dask_{arguments[0]}", *arguments[1:], "--no-dashboard"]
    with subprocess.Popen(command, env=ENVIRONMENT, stderr=subprocess.DEVNULL) as process:
        try:
            yield process
        finally:
            process.kill()


def free_port() -> int:
    with closing(socket.socket()) as unbound:
        unbound.bind(("127.0.0.1", 0))
        return int(unbound.getsockname()[1])


@pytest.fixture
def address() -> str:
    return f"tcp://127.0.0.1:{free_port()}"


@pytest.fixture
def scheduler(address: str) -> Iterator[str]:
    with dask("scheduler", "--host", "127.0.0.1", "--port", address.rpartition(":")[2]) as process:
        while not answers(address):
            assert process.poll() is None
            time.sleep(0.02)
        yield address


def answers(address: str) -> bool:
    with closing(socket.socket()) as probe:
        return probe.connect_ex(("127.0.0.1", int(address.rpartition(":")[2]))) == 0


@contextmanager
def two_workers(scheduler: str) -> Iterator[list[subprocess.Popen[bytes]]]:
    with ExitStack() as stack:
        options = ("--nthreads", "1", "--no-nanny", "--host", "127.0.0.1")
        workers = [stack.enter_context(dask("worker", scheduler, *options)) for _ in range(2)]
        import distributed

        with distributed.Client(scheduler, set_as_default=False) as client:
            client.wait_for_workers(2)
        yield workers


def test_one_of_two_workers_killed_in_the_middle_costs_nothing_but_time(tmp_path: Path, scheduler: str) -> None:
    walk = Walk(str(tmp_path / "log"), ((101, "error"), *((seed, "wait") for seed in range(104, 110))))
    some, observer = plan(walk, runs=10, managers="calm"), RecordingObserver()
    with two_workers(scheduler) as processes, ResultsWriter(tmp_path) as writer:
        ids = {process.pid for process in processes}
        over = threading.Event()

        def kill_one_while_it_is_busy() -> None:
            # Both workers come to a run that waits, and stay in it.
            while len(walk.begun()) < 6 and not over.wait(0.01):
                pass
            processes[0].kill()
            processes[0].wait()
            walk.release()

        killer = threading.Thread(target=kill_one_while_it_is_busy)
        killer.start()
        try:
            outcome = execute_campaign(some, writer, lambda _: ClusterWorkers(walk, scheduler), observer)
        finally:
            over.set()
            killer.join()
        assert processes[0].returncode < 0
        assert processes[1].poll() is None
    assert outcome == CampaignOutcome(present=0, carried_out=10, done=9, failed=1, missing=0)
    visits = [walk.visits(run.request) for run in some.runs]
    assert sorted(map(len, visits)) == [*[1] * 9, 2]
    assert {process for several in visits for process in several} == ids
    with Results(tmp_path) as results:
        assert "the ground is missing" in (results.runs(some.campaign_id)[1].error or "")
        assert results.record(some.runs[5].run_id) == Walk().run(some.runs[5].request, SilentObserver())


def test_the_command_sends_its_runs_to_the_cluster_and_goes_on_from_what_is_there(
    tmp_path: Path, scheduler: str
) -> None:
    experiment = tmp_path / "short.yaml"
    experiment.write_text("parameters: {time_limit: 5}", encoding="utf-8")
    command = ("campaign", "suave", "--managers", "none", "--out", tmp_path, "--experiment", experiment, "-q")
    assert rosa(*command, "--runs", 2, "--workers", 1).returncode == 0
    with two_workers(scheduler):
        process = rosa(*command, "--runs", 4, "--cluster", scheduler)
    assert process.returncode == 0, process.stderr
    assert "2 runs carried out" in process.stdout


def test_a_run_that_kills_its_workers_is_given_up_and_the_others_are_done(
    tmp_path: Path, address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(ENVIRONMENT, "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES", "0")
    walk = Walk(faults=((101, "die"),))
    some = plan(walk, managers="calm")
    with ExitStack() as stack:
        stack.enter_context(dask("scheduler", "--host", "127.0.0.1", "--port", address.rpartition(":")[2]))
        stack.enter_context(two_workers(address))
        writer = stack.enter_context(ResultsWriter(tmp_path))
        outcome = execute_campaign(some, writer, lambda _: ClusterWorkers(walk, address), RecordingObserver())
    assert outcome == CampaignOutcome(present=0, carried_out=4, done=3, failed=1, missing=0)
    with Results(tmp_path) as results:
        assert "its workers died again and again" in (results.runs(some.campaign_id)[1].error or "")


def test_without_workers_or_without_a_scheduler_it_says_so(
    tmp_path: Path, scheduler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(WorkersError, match="has no workers"):
        ClusterWorkers(Walk(), scheduler)
    monkeypatch.setattr("rosa_evaluation.campaign.cluster_workers._CONNECTION_TIMEOUT", 0.5)
    with pytest.raises(WorkersError, match="no Dask scheduler answers"):
        ClusterWorkers(Walk(), f"tcp://127.0.0.1:{free_port()}")
    command = ("campaign", "suave", "--managers", "none", "--runs", 1, "--out", tmp_path)
    assert "has no workers" in refused(rosa(*command, "--cluster", scheduler))


def test_a_scheduler_that_goes_away_ends_the_campaign_and_what_is_done_stays(tmp_path: Path, address: str) -> None:
    arguments = ("suave", "--managers", "none", "--runs", 300, "--out", tmp_path, "--cluster", address)
    with ExitStack() as stack:
        scheduler = stack.enter_context(dask("scheduler", "--host", "127.0.0.1", "--port", address.rpartition(":")[2]))
        stack.enter_context(two_workers(address))
        process = stack.enter_context(begun(*arguments))
        await_runs(process, tmp_path, 2)
        scheduler.kill()
        _, error = process.communicate()
    assert process.returncode == 1
    assert f"the Dask scheduler at {address} is gone (what is finished is kept" in error
    with Results(tmp_path) as results:
        (campaign,) = results.campaigns()
        runs = results.runs(campaign.campaign_id)
    assert 2 <= len(runs) < 300
    assert {run.state for run in runs} == {RunState.DONE}


def test_workers_with_other_versions_are_refused(scheduler: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "rosa_evaluation.campaign.cluster_workers.package_versions.__code__",
        (lambda: {"python": "3.11", "mujoco": "0.1"}).__code__,
    )
    with two_workers(scheduler), pytest.raises(WorkersError, match=r"has mujoco [\d.]+ instead of 0\.1"):
        ClusterWorkers(Walk(), scheduler)
