"""What an experiment may set in the AGV's mission, and campaigns of it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from agv_example.parameters import PARAMETERS, requested_mission
from agv_example.planning import Objective
from agv_example.scenario import AGV
from rosa_core import InputError
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario
from tests.agv_example.drives import driven
from tests.rosa_cli.cli import rosa

SET: dict[str, Any] = {
    "time_limit": 50,
    "battery": 77,
    "start_up_time": 0.25,
    "start_up_energy": 2,
    "minimise": ["risk", "time"],
    "start": "C",
    "goals": ["A", "D"],
    "events": [[3, "fails", "lidar"], [4.5, "dims", "C2", 0.1]],
    "grid": [4, 3, 7],
    "reflexes": True,
}


def test_every_parameter_is_taken_over() -> None:
    assert set(SET) == set(PARAMETERS)
    config = requested_mission(
        RunRequest(parameters={**SET, "grid": [4, 3, 7], "start": "p0_1", "goals": "p1_0", "events": []})
    )
    assert (config.time_limit, config.battery) == (50.0, 77.0)
    assert (config.start_up.time, config.start_up.energy) == (0.25, 2.0)
    assert config.objective == Objective.in_order(["risk", "time"])
    assert (config.start, config.goals, len(config.corridors.places)) == ("p0_1", ("p1_0",), 12)
    assert config.disturbances == ()
    assert config.reflexes


def test_events_take_the_place_of_the_files() -> None:
    config = requested_mission(RunRequest(parameters={key: SET[key] for key in ("events", "goals", "start")}))
    assert [(d.earliest, d.kind, d.subjects, d.light) for d in config.disturbances] == [
        (3.0, "fails", ("lidar",), 1.0),
        (4.5, "dims", ("C2",), 0.1),
    ]
    assert (config.start, config.goals) == ("C", ("A", "D"))


def test_a_parameter_changes_what_happens() -> None:
    record = AGV.run(RunRequest(parameters={"minimise": "risk", "events": []}), SilentObserver())
    assert driven(record) == ["C4", "C3", "C2"]


def test_the_requests_time_limit_counts_before_the_parameter() -> None:
    assert requested_mission(RunRequest(parameters={"time_limit": 50}, time_limit=20.0)).time_limit == 20.0


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ({"batery": 1}, "did you mean 'battery'"),
        ({"battery": "full"}, "battery is 'full'"),
        ({"start": "Q"}, "no place 'Q'"),
        ({"goals": []}, "at least 1 expected"),
        ({"goals": ["A", None]}, "text is expected"),
        ({"minimise": "energie"}, "minimise: 'energie' is not a criterion"),
        ({"events": [[1, "explodes", "kinect"]]}, "fails | works"),
        ({"events": [[1, "fails", "kinetc"]]}, "no component that can fail 'kinetc'"),
        ({"events": [[-1, "fails", "kinect"]]}, "seconds from 0 up"),
        ({"events": [[1, "dims", "C1"]]}, "after what 'dims' the light"),
        ({"events": 3}, "a list is expected"),
        ({"grid": [2, 1, 0]}, r"\[columns, rows, seed\]"),
        ({"grid": [4, 4, 0], "events": [[1, "closes", "C1"]]}, "no corridor 'C1'"),
    ],
)
def test_parameters_that_cannot_be_are_refused(parameters: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said.replace("|", r"\|")):
        AGV.check(RunRequest(parameters=parameters))


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        (RunRequest(manager="rose"), "did you mean 'rosa'"),
        (RunRequest(task_layer="xml"), "there are: bt, pddl"),
        (RunRequest(manager="none", task_layer="pddl"), "with --manager rosa"),
        (RunRequest(domain=Path("d.pddl")), "add --task-layer pddl"),
    ],
)
def test_requests_that_cannot_be_are_refused(request_: RunRequest, said: str) -> None:
    with pytest.raises(InputError, match=said):
        AGV.check(request_)


def test_it_is_installed() -> None:
    assert find_scenario("agv") == AGV


def test_a_campaign_compares_managers(tmp_path: Path) -> None:
    experiment = tmp_path / "early.yaml"
    experiment.write_text(
        "parameters: {time_limit: 150, events: [[{uniform: [2, 9]}, fails, kinect]]}\n", encoding="utf-8"
    )
    out = tmp_path / "results"
    command = ("campaign", "agv", "--managers", "rosa,none", "--runs", 4, "--out", out, "--experiment", experiment)
    process = rosa(*command, "--json")
    assert process.returncode == 0, process.stderr
    document = json.loads(process.stdout)
    assert document["scenario"] == "agv"
    text = rosa(*command).stdout
    assert "goals reached" in text
    assert "1.00 (0.00)" in text
