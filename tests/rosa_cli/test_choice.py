"""``rosa status --preference``: what is chosen and why; ``rosa explain``: what would have to change."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path

import pytest

from tests.conftest import SUAVE, SUAVE_EXTENDED
from tests.rosa_cli.cli import refused, rosa

MODELS = Path(str(files("agv_example.models")))
AGV = (MODELS / "agv.yaml", MODELS / "agv_move.yaml")
NAVIGATE = (*AGV, "--require", "navigate")


def test_a_preference_shows_the_choice_what_is_estimated_and_the_runner_up() -> None:
    process = rosa("status", *NAVIGATE, "--preference", "safety")
    assert process.returncode == 0
    _, section = process.stdout.split("\nchoice for ")
    assert section.splitlines() == [
        "navigate by safety",
        "  localization: kinect + amcl",
        "  move: move by wheels",
        "  move_base: safe speed",
        "  estimated: energy 1.5, accuracy 1.75, safety 3.75",
        "  utility: 3.75",
        "  runner-up: localization: kinect + mrpt (utility 3.5, 0.25 less)",
    ]


def test_the_choice_as_json() -> None:
    options = ("--weight", "safety=1", "--weight", "energy=-2", "--limit", "accuracy >= 1.5")
    document = json.loads(rosa("status", *NAVIGATE, *options, "--json").stdout)
    assert document["choice"] == {
        "action": "navigate",
        "weights": {"safety": 1.0, "energy": -2.0},
        "limits": [{"measure": "accuracy", "operator": ">=", "value": 1.5}],
        "meets_limits": True,
        "function_designs": {"localization": "kinect + amcl", "move": "move by wheels"},
        "component_configurations": {"move_base": "safe speed"},
        "estimates": {"energy": 1.5, "accuracy": 1.75, "safety": 3.75},
        "utility": 0.75,
        "runner_up": {
            "function_designs": {"localization": "kinect + mrpt", "move": "move by wheels"},
            "component_configurations": {"move_base": "safe speed"},
            "estimates": {"energy": 1.75, "accuracy": 1.5, "safety": 3.5},
            "utility": 0.0,
            "difference": 0.75,
        },
        "note": None,
    }


def test_without_a_preference_nothing_is_chosen() -> None:
    assert "choice" not in json.loads(rosa("status", *NAVIGATE, "--json").stdout)
    assert "choice" not in rosa("status", *NAVIGATE).stdout


def test_limits_that_cannot_be_met_are_told() -> None:
    arguments = ("status", *NAVIGATE, "--preference", "safety", "--limit", "energy <= 1")
    choice = json.loads(rosa(*arguments, "--json").stdout)["choice"]
    assert not choice["meets_limits"]
    assert choice["function_designs"]["localization"] == "lidar + amcl"
    assert choice["note"] == "no feasible configuration meets energy <= 1 (the least is 1.5); so priorities decide"
    assert choice["note"] in rosa(*arguments).stdout


def test_an_unfeasible_action_has_no_choice() -> None:
    arguments = ("status", *NAVIGATE, "--preference", "safety", "--failed", "move_base")
    choice = json.loads(rosa(*arguments, "--json").stdout)["choice"]
    assert (choice["function_designs"], choice["utility"], choice["runner_up"]) == (None, None, None)
    assert "there is none: navigate is unfeasible: move_base" in choice["note"]
    assert "there is none" in rosa(*arguments).stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((*NAVIGATE, "--preference", "safty"), "did you mean 'safety'?"),
        ((*NAVIGATE, "--preference", "safety", "--weight", "energy=1"), "exclude each other"),
        ((*NAVIGATE, "--weight", "energy"), "write it as NAME=NUMBER"),
        ((*NAVIGATE, "--weight", "energy=inf"), "write it as NAME=NUMBER"),
        ((*NAVIGATE, "--limit", "energy=3"), "write it as 'energy <= 3'"),
        ((*AGV, "--preference", "safety"), "give --require once"),
    ],
)
def test_a_preference_that_makes_no_sense_is_refused(arguments: tuple[object, ...], words: str) -> None:
    assert words in refused(rosa("status", *arguments))


def test_explain_says_what_would_have_to_change() -> None:
    arguments = ("explain", SUAVE, SUAVE_EXTENDED, "action", "search_pipeline", "-m", "battery_level=0.24")
    assert rosa(*arguments).stdout.endswith("\n\nto make it feasible: battery_level must be >= 0.25 (is 0.24)\n")
    assert json.loads(rosa(*arguments, "--json").stdout)["remedies"] == ["battery_level must be >= 0.25 (is 0.24)"]
    both = rosa(*arguments, "-m", "water_visibility=1").stdout
    assert both.endswith(
        "\nto make it feasible, all of:\n"
        "  - battery_level must be >= 0.25 (is 0.24)\n"
        "  - water_visibility must be >= 1.25 (is 1)\n"
    )


def test_explain_has_no_remedy_for_what_is_feasible() -> None:
    arguments = ("explain", SUAVE, "action", "search_pipeline")
    assert "to make it feasible" not in rosa(*arguments).stdout
    assert json.loads(rosa(*arguments, "--json").stdout)["remedies"] == []
