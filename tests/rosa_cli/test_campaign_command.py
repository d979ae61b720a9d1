"""``rosa campaign`` as a user runs it."""

from __future__ import annotations

import contextlib
import json
import os
import pty
import re
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import pytest

from tests.rosa_cli.cli import refused, rosa
from tests.rosa_evaluation.campaign.scenarios import Walk

ROOT = Path(__file__).resolve().parents[2]

SHORT = "parameters: {time_limit: 20, thruster_events: ['(1,failure,10)']}"


@pytest.fixture
def short(tmp_path: Path) -> Path:
    """An experiment of missions that are over soon."""
    path = tmp_path / "short.yaml"
    path.write_text(SHORT, encoding="utf-8")
    return path


def begun(*arguments: object) -> subprocess.Popen[str]:
    """The command, running."""
    command = [sys.executable, "-m", "rosa_cli.main", "campaign", *map(str, arguments)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def recorded(out: Path) -> int:
    """How many runs the results have; 0 if there are none yet."""
    try:
        with closing(sqlite3.connect(f"file:{out / 'runs.sqlite'}?mode=ro", uri=True)) as connection:
            return int(connection.execute("SELECT count(*) FROM runs").fetchone()[0])
    except sqlite3.OperationalError:
        return 0


def await_runs(process: subprocess.Popen[str], out: Path, runs: int) -> None:
    """Wait until so many are recorded; a process that has ended records no more."""
    while recorded(out) < runs:
        assert process.poll() is None
        time.sleep(0.02)


def test_it_tells_means_by_manager_and_where_the_results_are(tmp_path: Path, short: Path) -> None:
    out = tmp_path / "results"
    process = rosa(
        "campaign", "suave", "--managers", "rosa,none", "--runs", 2, "--out", out, "--seed", 7, "--experiment", short
    )
    assert process.returncode == 0, process.stderr
    for words in ("suave, short: seeds 7 to 8", "search time s", "20.00 (0.00)", "4 runs carried out", str(out)):
        assert words in process.stdout
    assert process.stderr == ""


def test_as_json_it_prints_one_document(tmp_path: Path, short: Path) -> None:
    command = ("campaign", "suave", "--managers", "none,rosa-bt", "--experiment", short, "--out", tmp_path, "--json")
    document = json.loads(rosa(*command, "--runs", 2).stdout)
    assert (document["scenario"], document["experiment"], document["seeds"]) == ("suave", "short", [10000, 10001])
    assert (document["runs"], document["done"], document["failed"], document["missing"]) == (4, 4, 0, 0)
    assert list(document["managers"]) == ["none", "rosa-bt"]
    metrics = document["managers"]["rosa-bt"]["metrics"]
    assert metrics["search_time_s"] == {"n": 2, "mean": 20.0, "sd": 0.0}
    assert metrics["U1 mean_reaction_time_s"]["n"] == 2
    assert "U1 mean_reaction_time_s" not in document["managers"]["none"]["metrics"]
    again = json.loads(rosa(*command, "--runs", 3).stdout)
    assert (again["carried_out"], again["done"]) == (2, 6)


def test_one_worker_or_two_give_the_same(tmp_path: Path, short: Path) -> None:
    documents = []
    for workers in (1, 2):
        out = tmp_path / str(workers)
        command = ("campaign", "suave", "--managers", "none", "--runs", 3, "--out", out, "--experiment", short)
        documents.append(json.loads(rosa(*command, "--workers", workers, "--json").stdout)["managers"])
    assert documents[0] == documents[1]


def test_a_run_of_a_campaign_is_the_one_that_rosa_run_flies_with_its_seed(tmp_path: Path) -> None:
    from rosa_evaluation.campaign import Results

    (tmp_path / "limit.yaml").write_text("parameters: {time_limit: 40}", encoding="utf-8")
    command = ("campaign", "suave", "--managers", "rosa", "--runs", 1, "--seed", 3, "--out", tmp_path / "many")
    assert rosa(*command, "--experiment", tmp_path / "limit.yaml").returncode == 0
    assert rosa("run", "suave", "--seed", 3, "--time-limit", 40, "-q", "--out", tmp_path / "one").returncode == 0
    with Results(tmp_path / "many") as results:
        (campaign,) = results.campaigns()
        results.record(results.runs(campaign.campaign_id)[0].run_id).write(tmp_path / "of many")
    for name in ("run.json", "events.jsonl", "trajectory.csv"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "of many" / name).read_bytes()


def test_ctrl_c_finishes_what_has_begun_says_how_to_go_on_and_exits_with_130(tmp_path: Path) -> None:
    arguments = ("suave", "--managers", "none,rosa", "--runs", 40, "--out", tmp_path)
    with begun(*arguments) as process:
        await_runs(process, tmp_path, 3)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate()
    assert process.returncode == 130
    assert "runs that have begun are finished" in error
    assert "the same command goes on with the rest" in error
    assert "Traceback" not in error
    there = recorded(tmp_path)
    assert 3 <= there < 80
    assert f"interrupted: {there} of 80 runs are there" in error


def test_in_a_terminal_a_bar_shows_how_long_it_will_take(tmp_path: Path) -> None:
    shown, terminal = pty.openpty()
    command = ["campaign", "suave", "--managers", "none", "--runs", "6", "--out", str(tmp_path), "--workers", "1"]
    with subprocess.Popen(
        [sys.executable, "-m", "rosa_cli.main", *command],
        stdout=subprocess.PIPE,
        stderr=terminal,
        env={**os.environ, "TERM": "xterm", "COLUMNS": "120"},
    ) as process:
        os.close(terminal)
        text = ""
        with contextlib.suppress(OSError):  # Linux says so when the other end is closed.
            while data := os.read(shown, 4096):
                text += data.decode(errors="replace")
        os.close(shown)
    assert process.returncode == 0
    assert "campaign" in text
    assert "/6" in text
    assert re.search(r"\d\d:\d\d", text)


def test_ctrl_c_in_a_terminal_reaches_the_workers_too_and_nobody_complains(tmp_path: Path) -> None:
    command = ["campaign", "suave", "--managers", "none", "--runs", "60", "--out", str(tmp_path)]
    with subprocess.Popen(
        [sys.executable, "-m", "rosa_cli.main", *command], stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        await_runs(process, tmp_path, 2)
        os.killpg(process.pid, signal.SIGINT)
        _, error = process.communicate()
    assert process.returncode == 130
    assert "Traceback" not in error
    assert "a worker is lost" not in error


def test_a_second_ctrl_c_breaks_off_at_once(tmp_path: Path) -> None:
    walk = Walk(log=str(tmp_path / "log"), faults=((10_000, "wait"),))
    script = tmp_path / "script.py"
    script.write_text(
        "import sys\n"
        "import rosa_cli.campaign_command\n"
        "from rosa_cli.main import main\n"
        "from tests.rosa_evaluation.campaign.scenarios import Walk\n"
        "if __name__ == '__main__':\n"
        f"    rosa_cli.campaign_command.find_scenario = lambda name: {walk!r}\n"
        "    main()\n",
        encoding="utf-8",
    )
    arguments = ["campaign", "walk", "--managers", "calm", "--runs", "2", "--out", str(tmp_path), "--workers", "1"]
    with subprocess.Popen(
        [sys.executable, str(script), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    ) as process:
        assert process.stderr is not None
        while not walk.begun():
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        assert "Ctrl-C again breaks off" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        _, error = process.communicate()
    assert process.returncode == 130
    assert "what was finished is kept" in error
    assert "Traceback" not in error


def test_killed_it_goes_on_with_what_is_missing(tmp_path: Path) -> None:
    arguments = ("suave", "--managers", "none", "--runs", 12, "--out", tmp_path)
    with begun(*arguments) as process:
        await_runs(process, tmp_path, 3)
        process.kill()
        process.communicate()
    there = recorded(tmp_path)
    again = rosa("campaign", *arguments)
    assert again.returncode == 0, again.stderr
    assert f"{there} of 12 runs are there already" in again.stderr
    assert f"{12 - there} runs carried out" in again.stdout


def test_runs_that_fail_are_named_and_the_exit_code_is_1(tmp_path: Path, short: Path) -> None:
    command = ("campaign", "suave", "--managers", "none", "--runs", 2, "--out", tmp_path, "--experiment", short)
    assert rosa(*command).returncode == 0
    with closing(sqlite3.connect(tmp_path / "runs.sqlite")) as connection:
        change = "UPDATE runs SET state = 'failed', error = 'Traceback:' || char(10) || 'Broken: it' WHERE seed = 10001"
        connection.execute(change)
        connection.commit()
    process = rosa(*command)
    assert process.returncode == 1
    assert "failed: none, seed 10001: Broken: it" in process.stdout
    assert "--retry-failed" in process.stdout
    fixed = rosa(*command, "--retry-failed")
    assert fixed.returncode == 0
    assert "1 runs carried out" in fixed.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("suav", "--managers", "rosa"), "did you mean 'suave'?"),
        (("suave", "--managers", "rsa"), "did you mean 'rosa'?"),
        (("suave", "--managers", "rosa,rosa-bt"), "which is the same"),
        (("suave", "--managers", "rosa", "--runs", "0"), "--runs"),
        (("suave", "--managers", "rosa", "--workers", "0"), "--workers"),
        (("suave", "--managers", "rosa", "--seed", "-1"), "--seed"),
        (("suave", "--managers", "rosa", "--workers", "2", "--cluster", "tcp://x:1"), "exclude each other"),
        (("suave", "--managers", "rosa", "--cluster", "nonsense://x:1"), "an address looks like"),
        (("suave", "--managers", "rosa", "--cluster", "tcp://x"), "an address looks like"),
        (("suave", "--managers", "rosa", "--cluster", "tcp://x:y"), "an address looks like"),
        (("suave", "--managers", "rosa", "--experiment", "none.yaml"), "No such file"),
        (("suave",), "--managers"),
    ],
)
def test_bad_input_is_refused_and_nothing_is_begun(tmp_path: Path, arguments: tuple[str, ...], words: str) -> None:
    out = tmp_path / "results"
    assert words in refused(rosa("campaign", "--out", out, "--runs", "1", *arguments))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("parameters: {watervisibility_period: 3}", "did you mean 'water_visibility_period'?"),
        ("parameters:\n  start: [1, 2, 3]", "experiment.yaml:2: start is [1, 2, 3] (a list [x, y] in m"),
        ("parameters: {thruster_events: [[7, failure, 3]]}", "thruster 1 to 6"),
        ("parameters: {water_visibility_min: 5}", "water_visibility_min is above water_visibility_max"),
        ("parameters: {time_limit: {normal: [0, 1]}}", "a number above 0 is expected"),
    ],
)
def test_an_experiment_that_the_scenario_refuses_is_bad_input(tmp_path: Path, text: str, words: str) -> None:
    experiment = tmp_path / "experiment.yaml"
    experiment.write_text(text, encoding="utf-8")
    out = tmp_path / "results"
    command = ("campaign", "suave", "--managers", "none", "--runs", 5, "--out", out, "--experiment", experiment)
    assert words in refused(rosa(*command))
    assert not out.exists()


def test_results_that_are_something_else_are_refused(tmp_path: Path) -> None:
    (tmp_path / "runs.sqlite").write_text("not results", encoding="utf-8")
    command = ("campaign", "suave", "--managers", "none", "--runs", 1, "--out", tmp_path)
    assert "this is not a results file" in refused(rosa(*command))
    assert [path.name for path in tmp_path.iterdir()] == ["runs.sqlite"]


def test_two_campaigns_do_not_write_into_one_directory(tmp_path: Path) -> None:
    arguments = ("suave", "--managers", "none", "--runs", 40, "--out", tmp_path)
    with begun(*arguments) as process:
        await_runs(process, tmp_path, 1)
        assert "another campaign writes it" in refused(rosa("campaign", *arguments))
        process.kill()
        process.communicate()
