"""``rosa run`` as a user runs it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from rosa_cli.options import DisplayOptions
from rosa_cli.run_command import run_scenario
from rosa_simulation.scenario import RunRequest
from tests.rosa_cli.cli import refused, rosa


def test_it_tells_the_mission_on_standard_error_and_the_outcome_on_standard_output() -> None:
    process = rosa("run", "suave-extended")
    assert process.returncode == 0
    for words in (
        "thruster 1 failed: fd_recover_motion_inactive unfeasible, fd_recover_motion selected",
        "altitude 3.0 -> 2.0",
        "battery 0.24: search_pipeline unfeasible, inspect_pipeline unfeasible",
        "recharge requested",
        "battery recharged",
        "time limit reached",
    ):
        assert words in process.stderr
        assert words not in process.stdout
    for words in ("search time", "distance inspected", "distance inspected total", "compute ms", "U1", "U2", "U3"):
        assert words in process.stdout


def test_the_uav_tells_how_it_works_round_its_gripper() -> None:
    process = rosa("run", "uav")
    assert process.returncode == 0
    for words in (
        "sample 2 analysed (picked up): analyze completed",
        "search unfeasible, search abandoned, return_base requested",
        "the gripper failed: fd_pick_sample unfeasible, fd_fold_gripper unfeasible, analyze unfeasible, "
        "analyze abandoned, land_fold requested",
        "gripper folded: land_fold completed, analyze_in_situ requested",
    ):
        assert words in process.stderr
    for words in ("ended by mission done", "samples picked up", "U1", "U2", "U3"):
        assert words in process.stdout


def test_a_mission_that_is_given_up_says_why_and_has_not_run_to_its_end(tmp_path: Path) -> None:
    config = tmp_path / "no_spring.yaml"
    config.write_text("parameters: {spring: false, gripper_fails_after: 5}\n", encoding="utf-8")
    process = rosa("run", "uav", "--task-layer", "pddl", "--mission-config", config, "--json")
    document = json.loads(process.stdout)
    assert document["completed"] is False
    assert "land_fold" in document["ended_by"]
    assert any(plan["no_plan"] for plan in document["plans"])


def test_as_json_it_prints_one_document_with_the_documented_keys(tmp_path: Path) -> None:
    process = rosa("run", "suave-extended", "--json", "--seed", "3", "--out", tmp_path / "run")
    document = json.loads(process.stdout)
    assert document["scenario"] == "suave-extended"
    assert (document["manager"], document["task_layer"], document["seed"]) == ("rosa", "bt", 3)
    assert document["completed"] is True
    assert document["duration_s"] == 300.0
    assert document["events"] > 5
    assert document["out"] == str(tmp_path / "run")
    assert document["metrics"]["search_time_s"] > 18
    for name in ("U1", "U2", "U3"):
        for reaction in document["reaction_times"][name]:
            assert set(reaction) == {"delay_s", "compute_s", "total_s"}


def test_the_record_holds_inputs_versions_events_metrics_and_trajectory(tmp_path: Path) -> None:
    out = tmp_path / "results" / "run"
    assert rosa("run", "suave", "-q", "--out", out, "--time-limit", "50").returncode == 0
    run = json.loads((out / "run.json").read_text(encoding="utf-8"))
    assert run["inputs"]["mission"]["time_limit"] == 50.0
    assert run["inputs"]["world"]["settling_time"] == 18.0
    assert run["versions"]["mujoco"]
    assert run["metrics"]["search_time_s"] <= 50.0
    events = [json.loads(line) for line in (out / "events.jsonl").read_text(encoding="utf-8").splitlines()]
    assert any(fact["fact"] == "thruster failed" for event in events for fact in event["facts"])
    rows = (out / "trajectory.csv").read_text(encoding="utf-8").splitlines()
    assert rows[0] == "time_s,x_m,y_m,z_m,yaw_rad,visibility_m,battery_level"
    assert len(rows) == 52
    assert "compute_s" in json.loads((out / "wall_clock.json").read_text(encoding="utf-8"))


def test_a_mission_in_pddl_tells_its_plans() -> None:
    process = rosa("run", "suave-extended", "--task-layer", "pddl", "--time-limit", "160")
    assert process.returncode == 0
    assert "plan: start_robot, search_pipeline, inspect_pipeline" in process.stderr
    assert "ms  recharge, inspect_pipeline (" in process.stdout


def test_a_mission_without_a_plan_breaks_off_with_exit_code_1(tmp_path: Path) -> None:
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text(
        "(define (domain d) (:predicates (a) (b)) (:action recharge :parameters () :precondition (a) :effect (b)))",
        encoding="utf-8",
    )
    problem.write_text("(define (problem p) (:domain d) (:init) (:goal (b)))", encoding="utf-8")
    files = ("--domain", domain, "--problem", problem, "--json", "-q")
    process = rosa("run", "suave-extended", "--task-layer", "pddl", *files)
    assert process.returncode == 1
    document = json.loads(process.stdout)
    assert document["completed"] is False
    assert document["plans"][0]["no_plan"] == "(b) cannot be reached: nothing makes (b) true"


def test_quietly_it_tells_only_the_outcome() -> None:
    process = rosa("run", "suave", "--quiet", "--time-limit", "20")
    assert process.stderr == ""
    assert "search time" in process.stdout


def test_a_mission_configuration_is_taken_and_what_is_not_simulated_is_said(tmp_path: Path) -> None:
    config = tmp_path / "config.yaml"
    config.write_text(
        "/thruster_monitor:\n  ros__parameters:\n    thruster_events: ['(2,failure,5)']\n"
        "/water_current:\n  ros__parameters:\n    mean_current: 0.05\n",
        encoding="utf-8",
    )
    process = rosa("run", "suave", "--mission-config", config, "--time-limit", "10")
    assert "thruster 2 failed" in process.stderr
    assert "config.yaml:6: 'mean_current' of /water_current is not simulated" in process.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("suav",), "did you mean 'suave'?"),
        (("suave", "--manager", "rose"), "did you mean 'rosa'?"),
        (("suave", "--task-layer", "xml"), "there are: bt, pddl"),
        (("suave", "--seed", "-1"), "--seed"),
        (("suave", "--seed", "x"), "--seed"),
        (("suave", "--time-limit", "0"), "--time-limit"),
        (("suave", "--time-limit", "nan"), "--time-limit"),
        (("suave", "--mission-config", "no.yaml"), "No such file"),
        (("uav", "--mission-config", "no.yaml"), "No such file"),
        (("uav", "--manager", "none", "--task-layer", "pddl"), "--manager rosa"),
        ((), "SCENARIO"),
    ],
)
def test_bad_input_is_refused(arguments: tuple[str, ...], words: str) -> None:
    assert words.lower() in refused(rosa("run", *arguments)).lower()


def test_a_directory_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    assert "name another directory" in refused(
        rosa("run", "suave", "-q", "--time-limit", "5", "--out", tmp_path / "file")
    )


def test_interrupted_it_exits_with_130() -> None:
    command = [sys.executable, "-m", "rosa_cli.main", "run", "suave", "--speed", "1"]
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Whoever runs the tests in the background may ignore the signal, and what is ignored is inherited.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509
    ) as process:
        assert process.stderr is not None
        assert "GUIDED" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        _, error = process.communicate()
    assert process.returncode == 130
    assert "Traceback" not in error


def test_at_ten_times_real_time_twenty_seconds_take_two(monkeypatch: pytest.MonkeyPatch) -> None:
    slept: list[float] = []
    fake = SimpleNamespace(perf_counter=lambda: 100.0 + sum(slept), sleep=slept.append)
    monkeypatch.setattr("rosa_cli.run_command.time", fake)
    run_scenario("suave", RunRequest(time_limit=20.0), DisplayOptions(speed=10.0, quiet=True))
    assert sum(slept) == pytest.approx(2.0)
    assert len(slept) > 10
    slept.clear()
    run_scenario("suave", RunRequest(time_limit=20.0), DisplayOptions(quiet=True))
    assert slept == []


def test_a_reader_that_goes_away_is_no_reason_to_complain() -> None:
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "rosa_cli.main", "scenarios"]
    process = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert "Traceback" not in process.stderr


def test_the_scenarios_are_listed() -> None:
    process = rosa("scenarios")
    assert "suave-extended" in process.stdout
    assert process.returncode == 0
