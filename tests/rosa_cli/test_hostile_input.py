"""Names that are too long, values of the wrong shape, messages without end, a Ctrl-C while workers start."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from rosa_cli.examples import EXAMPLES
from rosa_cli.exit_codes import ExitCode
from rosa_cli.main import app
from rosa_cli.model_files import load_given_model
from rosa_cli.settings import place_of, read_settings
from rosa_core import InputError
from rosa_core.errors import LONGEST_TOKEN, MOST_LINES, Location, Problem
from rosa_evaluation.campaign import Experiment, Results
from rosa_evaluation.report.sources import RunSources
from rosa_simulation.run_reader import read_run
from rosa_simulation.scenario import find_scenario, read_parameters
from suave.mission_config import load_mission_config
from tests.rosa_cli.cli import refused, rosa

LONG = "a" * 300


def test_a_name_too_long_for_the_file_system_is_a_file_that_is_not_there(tmp_path: Path) -> None:
    for read in (Results, read_run, lambda name: RunSources().add([Path(name)])):
        with pytest.raises(InputError, match=r"there (is|are) no"):
            read(LONG)
    told = refused(rosa("journal", "show", LONG))
    assert "there is no such journal" in told
    assert max(map(len, told.split())) <= LONGEST_TOKEN + 1


def test_a_list_where_a_mode_is_expected_is_refused_with_its_line(tmp_path: Path) -> None:
    mission = tmp_path / "mission.yaml"
    mission.write_text("/m: {ros__parameters: {f_generate_search_path_mode: [fd_spiral_low]}}\n")
    with pytest.raises(InputError, match=r"mission\.yaml:1: f_generate_search_path_mode is \['fd_spiral_low'\]"):
        load_mission_config(mission)
    experiment = tmp_path / "experiment.yaml"
    experiment.write_text("parameters:\n  f_generate_search_path_mode: [fd_spiral_low]\n")
    loaded = Experiment.load(experiment)
    with pytest.raises(InputError, match=r"experiment\.yaml:2: f_generate_search_path_mode"):
        read_parameters(find_scenario("suave").parameters, loaded.draw(0), loaded.where)


def test_a_distribution_without_numbers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "experiment.yaml"
    path.write_text("parameters:\n  time_limit: {uniform: null}\n")
    with pytest.raises(InputError, match="the distribution 'uniform' is empty"):
        Experiment.load(path)


def test_a_message_repeats_no_token_beyond_200_characters_and_no_more_than_20_faults() -> None:
    problems = [Problem(f"unknown name '{LONG}{number}'", Location("m.yaml", number)) for number in range(35)]
    error = InputError(problems)
    lines = str(error).split("\n")
    assert len(lines) == MOST_LINES + 1
    assert lines[-1] == "... and 15 more"
    assert all(len(word) <= LONGEST_TOKEN for line in lines for word in line.split())
    assert lines[0].startswith("m.yaml:0: unknown name 'aaaa")
    assert lines[0].endswith("aa0'")
    assert len(error.problems) == 35


def test_a_command_line_is_not_repeated_without_end() -> None:
    assert max(map(len, refused(rosa(LONG)).split())) <= LONGEST_TOKEN


# -- options --


def test_settings_are_checked_against_the_scenario_and_say_which_option_is_wrong() -> None:
    given = ["time_limit=abc", "start=[1, 2]", "tim=3"]
    with pytest.raises(InputError) as refusal:
        read_parameters(find_scenario("suave").parameters, read_settings(given), place_of(given))
    told = str(refusal.value).split("\n")
    assert told[0] == "--set time_limit=abc: time_limit is 'abc' (a number is expected)"
    assert told[1].startswith("--set tim=3: this scenario has no parameter 'tim' (")


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (["time_limit"], "--set time_limit: not a name and a value"),
        (["=3"], "--set =3: not a name and a value"),
        (["a=1", "a=2"], "'a' is set twice"),
        (["a=[1"], "not valid YAML"),
    ],
)
def test_settings_that_cannot_be_read(given: list[str], told: str) -> None:
    with pytest.raises(InputError) as refusal:
        read_settings(given)
    assert told in str(refusal.value)


def test_settings_of_a_campaign_count_before_its_file_and_may_be_drawn() -> None:
    experiment = Experiment("file", {"time_limit": 300, "speed": 2}, {"parameters": {"time_limit": 300, "speed": 2}})
    given = ["time_limit=20", "shift={uniform: [0, 80]}"]
    changed = experiment.with_settings(read_settings(given), place_of(given))
    drawn = changed.draw(1)
    assert (drawn["time_limit"], drawn["speed"]) == (20, 2)
    assert 0 <= drawn["shift"] <= 80
    assert changed.document == {"parameters": {"time_limit": 20, "speed": 2, "shift": {"uniform": [0, 80]}}}
    assert changed.where("time_limit") == Location("--set time_limit=20")
    assert experiment.with_settings({}, place_of([])) is experiment


def test_a_scenario_says_what_can_be_set_with_units_and_defaults() -> None:
    told = rosa("scenarios", "suave").stdout
    assert "water_visibility_max" in told
    assert "best visibility, m" in told
    assert "3.75" in told


def test_a_scenario_stands_for_its_own_model() -> None:
    assert "recharge" in load_given_model([Path("suave-extended")]).names["action"]
    assert "recharge" not in load_given_model([Path("suave")]).names["action"]


# -- Ctrl-C --


@pytest.mark.slow
@pytest.mark.parametrize("workers_started", [1, 2])
def test_ctrl_c_while_workers_start_exits_with_130_and_no_traceback(tmp_path: Path, workers_started: int) -> None:
    command = [sys.executable, "-m", "rosa_cli.main", "campaign", "suave", "--managers", "none", "--runs", "8"]
    process = subprocess.Popen(
        [*command, "--workers", "4", "--out", str(tmp_path), "-q"],
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    while len(_children(process.pid)) <= workers_started and process.poll() is None:
        time.sleep(0.002)
    os.killpg(process.pid, signal.SIGINT)
    _, told = process.communicate(timeout=120)
    assert process.returncode == ExitCode.INTERRUPTED
    assert "Traceback" not in told
    assert "the same command goes on with the rest" in told


def _children(process: int) -> list[str]:
    tasks = Path(f"/proc/{process}/task/{process}/children")
    if not tasks.exists():
        pytest.skip("this system does not say which processes a process has started")
    return tasks.read_text().split()


# -- help --


def _commands(group: Any, above: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    for name, command in group.commands.items():
        if hasattr(command, "commands"):
            yield from _commands(command, (*above, name))
        else:
            yield (*above, name), command


def test_every_command_has_an_example_that_it_understands() -> None:
    commands = dict(_commands(typer.main.get_command(app)))
    assert {" ".join(names) for names in commands} == set(EXAMPLES)
    for names, command in commands.items():
        example = EXAMPLES[" ".join(names)]
        assert command.epilog == f"Example: {example}"
        arguments = shlex.split(example.partition(" > ")[0])[1 + len(names) :]
        command.make_context(names[-1], arguments, resilient_parsing=False)


def test_commands_are_listed_in_groups() -> None:
    told = rosa("--help").stdout
    for title in ("Knowledge models:", "Missions:", "Many runs:", "--install-completion"):
        assert title in told
