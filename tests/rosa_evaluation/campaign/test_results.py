"""What is written is what is read; files that are something else, damaged or in use are distinguished."""

from __future__ import annotations

import json
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from rosa_core import SimulationClock
from rosa_evaluation.campaign import (
    Experiment,
    Results,
    ResultsError,
    ResultsWriter,
    RunState,
    make_plan,
    read_managers,
)
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario
from tests.rosa_evaluation.campaign.scenarios import Walk, plan

PLAN = plan(Walk())


def some_results(directory: Path) -> None:
    """Two runs that are done and one that failed, of eight."""
    with ResultsWriter(directory, SimulationClock(1e9)) as writer:
        writer.begin(PLAN)
        for run in PLAN.runs[:2]:
            writer.add(run, Walk().run(run.request, SilentObserver()))
        writer.add_failure(PLAN.runs[3], PLAN, "Traceback: it broke")


def test_a_record_comes_back_as_it_was(tmp_path: Path) -> None:
    some_results(tmp_path)
    with Results(tmp_path) as results:
        for run in PLAN.runs[:2]:
            assert results.record(run.run_id) == Walk().run(run.request, SilentObserver())


def test_a_mission_of_the_exemplar_comes_back_byte_for_byte(tmp_path: Path) -> None:
    scenario = find_scenario("suave-extended")
    minute = Experiment("a minute", {"time_limit": 60.0, "thruster_events": [[2, "failure", 20]]})
    mission = make_plan(scenario, read_managers("rosa", scenario), range(4, 5), minute)
    (run,) = mission.runs
    record = scenario.run(run.request, SilentObserver())
    with ResultsWriter(tmp_path) as writer:
        writer.begin(mission)
        writer.add(run, record)
    with Results(tmp_path) as results:
        results.record(run.run_id).write(tmp_path / "after")
        columns, trajectory = results.trajectory(run.run_id)
    record.write(tmp_path / "before")
    for file in (tmp_path / "before").iterdir():
        assert file.read_bytes() == (tmp_path / "after" / file.name).read_bytes()
    assert columns == record.trajectory_columns
    assert np.array_equal(trajectory, np.array(record.trajectory))


def test_runs_are_listed_in_the_order_of_the_plan_with_what_became_of_them(tmp_path: Path) -> None:
    some_results(tmp_path)
    with Results(tmp_path) as results:
        runs = results.runs(PLAN.campaign_id)
    assert [(run.manager_name, run.seed, run.state) for run in runs] == [
        ("calm", 100, RunState.DONE),
        ("wild", 100, RunState.DONE),
        ("wild", 101, RunState.FAILED),
    ]
    assert runs[0].finished_at == "2001-09-09T01:46:40+00:00"
    assert runs[0].reactions["U1"][0].total_s == pytest.approx(0.12)
    assert runs[0].reactions["U2"] == ()
    assert (runs[2].error, runs[2].metrics, runs[2].reactions) == ("Traceback: it broke", {}, {})


def test_a_campaign_says_what_it_was_and_how_much_is_missing(tmp_path: Path) -> None:
    some_results(tmp_path)
    with Results(tmp_path) as results:
        (campaign,) = results.campaigns()
    assert campaign.managers == {"calm": ("calm", "bt"), "wild": ("wild", "bt")}
    assert (campaign.scenario, campaign.seeds, campaign.missing) == ("walk", range(100, 104), 5)
    assert campaign.versions == PLAN.versions


def test_a_run_that_is_done_stays_and_one_that_failed_can_be_replaced(tmp_path: Path) -> None:
    some_results(tmp_path)
    other = Walk().run(RunRequest("calm", seed=999), SilentObserver())
    with ResultsWriter(tmp_path) as writer:
        writer.add(PLAN.runs[0], other)
        writer.add_failure(PLAN.runs[1], PLAN, "too late")
        writer.add(PLAN.runs[3], Walk().run(PLAN.runs[3].request, SilentObserver()))
        states = writer.begin(PLAN)
    assert states == {PLAN.runs[index].run_id: RunState.DONE for index in (0, 1, 3)}
    with Results(tmp_path) as results:
        assert results.record(PLAN.runs[0].run_id).seed == 100
        assert results.record(PLAN.runs[3].run_id).metrics == other.metrics | results.runs(PLAN.campaign_id)[2].metrics


def test_two_campaigns_share_the_runs_that_both_have(tmp_path: Path) -> None:
    some_results(tmp_path)
    larger = plan(Walk(), runs=6, managers="calm")
    with ResultsWriter(tmp_path) as writer:
        assert writer.begin(larger) == {PLAN.runs[0].run_id: RunState.DONE}
    with Results(tmp_path) as results:
        assert [campaign.missing for campaign in results.campaigns()] == [5, 5]
        assert [run.run_id for run in results.runs(larger.campaign_id)] == [PLAN.runs[0].run_id]


def test_nothing_but_the_one_file_is_needed_afterwards(tmp_path: Path) -> None:
    some_results(tmp_path / "results")
    copy = tmp_path / "copy" / "runs.sqlite"
    copy.parent.mkdir()
    copy.write_bytes((tmp_path / "results" / "runs.sqlite").read_bytes())
    with Results(tmp_path / "copy") as results:
        assert len(results.runs(PLAN.campaign_id)) == 3


def test_results_can_be_read_while_they_are_written(tmp_path: Path) -> None:
    with ResultsWriter(tmp_path) as writer:
        writer.begin(PLAN)
        with Results(tmp_path) as results:
            assert results.runs(PLAN.campaign_id) == []
            writer.add(PLAN.runs[0], Walk().run(PLAN.runs[0].request, SilentObserver()))
            assert len(results.runs(PLAN.campaign_id)) == 1


def test_a_second_writer_is_refused_and_the_lock_goes_with_its_process(tmp_path: Path) -> None:
    code = (
        "import os, sys\nfrom rosa_evaluation.campaign import ResultsWriter\n"
        "writer = ResultsWriter(sys.argv[1])\nprint('open', flush=True)\nsys.stdin.read()\n"
    )
    command = [sys.executable, "-c", code, str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "open\n"
        with pytest.raises(ResultsError, match="another campaign writes it"):
            ResultsWriter(tmp_path)
        process.kill()
        process.wait()
    ResultsWriter(tmp_path).close()


def _text(path: Path) -> None:
    path.write_text("once upon a time there was a text " * 100, encoding="utf-8")


def _other_database(path: Path) -> None:
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("CREATE TABLE runs (marathon TEXT)")
        connection.commit()


def _other_format(path: Path) -> None:
    some_results(path.parent)
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA user_version = 99")
        connection.commit()


def _cut_off(path: Path) -> None:
    some_results(path.parent)
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _scribbled(path: Path) -> None:
    some_results(path.parent)
    data = bytearray(path.read_bytes())
    data[4096 + 8 :: 4096] = b"\xff" * len(data[4096 + 8 :: 4096])
    data[4096:4196] = b"\xa5" * 100
    path.write_bytes(data)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (_text, "this is not a results file"),
        (_other_database, "this is a database, but not a results file"),
        (_other_format, "format 99; this version reads format 1"),
        (_cut_off, "damaged"),
        (_scribbled, "damaged"),
    ],
)
def test_what_cannot_be_used_is_refused_and_left_as_it_is(
    tmp_path: Path, make: Callable[[Path], None], words: str
) -> None:
    path = tmp_path / "runs.sqlite"
    make(path)
    before = path.read_bytes()
    for attempt in (ResultsWriter, Results):
        with pytest.raises(ResultsError, match=words) as refusal:
            attempt(tmp_path)
        assert "runs.sqlite" in str(refusal.value)
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ("UPDATE runs SET metrics = '{' WHERE state = 'done'", "damaged: Expecting property name"),
        ("UPDATE trajectories SET data = x'00'", "the trajectory of run"),
        ("UPDATE trajectories SET samples = samples + 1", "another length"),
        ("UPDATE trajectories SET samples = -1", "is damaged"),
        ("DELETE FROM trajectories", "there is no trajectory"),
    ],
)
def test_rows_that_do_not_hold_together_are_damage(tmp_path: Path, statement: str, words: str) -> None:
    some_results(tmp_path)
    with closing(sqlite3.connect(tmp_path / "runs.sqlite")) as connection:
        connection.execute(statement)
        connection.commit()
    with Results(tmp_path) as results, pytest.raises(ResultsError, match=words):
        results.record(PLAN.runs[0].run_id)


def test_a_directory_without_results_or_that_cannot_be_one_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ResultsError, match="there are no results here"):
        Results(tmp_path)
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(ResultsError, match="name another directory"):
        ResultsWriter(tmp_path / "file")
    (tmp_path / "runs.sqlite").mkdir()
    with pytest.raises(ResultsError, match="cannot be opened"):
        ResultsWriter(tmp_path)


def test_a_run_that_is_not_there_or_failed_has_no_record(tmp_path: Path) -> None:
    some_results(tmp_path)
    with Results(tmp_path) as results:
        for run_id in ("nonsense", PLAN.runs[3].run_id):
            with pytest.raises(ResultsError, match="there is no run"):
                results.record(run_id)


def test_the_tables_can_be_asked_with_sql(tmp_path: Path) -> None:
    some_results(tmp_path)
    with closing(sqlite3.connect(tmp_path / "runs.sqlite")) as connection:
        query = "SELECT manager, json_extract(metrics, '$.furthest_m') FROM runs WHERE state = 'done' ORDER BY manager"
        rows = connection.execute(query).fetchall()
        facts = connection.execute("SELECT facts FROM events WHERE time_s = 0").fetchone()[0]
    assert [manager for manager, _ in rows] == ["calm", "wild"]
    assert rows[0][1] == rows[1][1] > 0
    assert json.loads(facts) == [{"fact": "begun", "of": 1}]
