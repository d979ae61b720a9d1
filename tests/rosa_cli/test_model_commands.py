"""``rosa check``, ``status``, ``explain``, ``effort`` and ``schema``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.conftest import SUAVE, SUAVE_EXTENDED
from tests.rosa_cli.cli import refused, rosa

BOTH = (SUAVE, SUAVE_EXTENDED)
UAV = SUAVE.parents[2] / "uav_example" / "models" / "uav.yaml"


def test_a_good_model_is_ok() -> None:
    process = rosa("check", *BOTH)
    assert process.returncode == 0
    assert process.stdout == "ok: 22 entities, 16 relations\n"


def test_a_bad_model_is_refused_with_file_line_and_mend(tmp_path: Path) -> None:
    bad = tmp_path / "bad.yaml"
    bad.write_text("actions:\n  recharge:\n    requires: [recover moton]\n", encoding="utf-8")
    assert (
        "bad.yaml:3: action 'recharge' names the unknown function 'recover moton' (did you mean 'recover motion'?)"
        in (refused(rosa("check", SUAVE, bad)))
    )


@pytest.mark.parametrize("command", ["check", "status", "effort"])
@pytest.mark.parametrize("text", ["", "{}", "a: [", "- 1", "\x00"])
def test_what_is_no_model_is_refused_by_every_command(tmp_path: Path, command: str, text: str) -> None:
    model = tmp_path / "model.yaml"
    model.write_text(text, encoding="utf-8")
    assert "model.yaml" in refused(rosa(command, model))


def test_the_extension_alone_dangles() -> None:
    assert "unknown function 'recover motion'" in refused(rosa("check", SUAVE_EXTENDED))


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    assert "No such file" in refused(rosa("check", tmp_path / "none.yaml"))


def test_status_as_json_has_the_documented_shape() -> None:
    process = rosa("status", *BOTH, "--measure", "water_visibility=3.0", "--measure", "battery_level=0.2", "--json")
    assert process.returncode == 0
    document = json.loads(process.stdout)
    assert document["actions"] == {
        "search_pipeline": "unfeasible",
        "inspect_pipeline": "unfeasible",
        "recharge": "feasible",
    }
    assert document["component_configurations"] == {
        "low altitude": "feasible",
        "medium altitude": "feasible",
        "high altitude": "unfeasible",
    }
    assert document["selectable_actions"] == ["recharge"]
    assert set(document) == {
        "actions",
        "functions",
        "components",
        "function_designs",
        "component_configurations",
        "constraints",
        "selectable_actions",
    }
    high = next(c for c in document["constraints"] if c["constrained"] == "high altitude")
    assert (high["measure"], high["operator"], high["value"], high["status"]) == (
        "water_visibility",
        ">=",
        3.25,
        "violated",
    )


def test_status_asserts_raw_facts_and_plans_nothing() -> None:
    arguments = ("--require", "search_pipeline", "--select", "fd_recover_motion", "--select", "high altitude")
    process = rosa("status", *BOTH, *arguments, "--active", "f_maintain_motion_node", "--json")
    document = json.loads(process.stdout)
    assert document["functions"]["recover motion"] == "solved"
    assert document["functions"]["generate search path"] == "unsolved"
    assert document["actions"]["search_pipeline"] == "unsolved"
    assert document["function_designs"]["fd_recover_motion"] == "solved"
    assert document["components"]["f_generate_search_path_node"] == "feasible"


def test_status_shows_a_required_action_that_is_unfeasible() -> None:
    process = rosa("status", *BOTH, "--require", "search_pipeline", "--measure", "battery_level=0.1", "--json")
    assert json.loads(process.stdout)["actions"]["search_pipeline"] == "unfeasible"


def test_status_for_people_names_everything_and_what_is_selectable() -> None:
    process = rosa("status", *BOTH, "--failed", "c_thruster_1")
    assert process.returncode == 0
    assert "c_thruster_1" in process.stdout
    assert "failure" in process.stdout
    assert "selectable actions: search_pipeline, inspect_pipeline, recharge" in process.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--measure", "battery_level"), "write it as NAME=NUMBER"),
        (("--measure", "battery_level=low"), "write it as NAME=NUMBER"),
        (("--measure", "battery_level=nan"), "write it as NAME=NUMBER"),
        (("--measure", "batery_level=1"), "did you mean 'battery_level'?"),
        (("--failed", "c_thruster_9"), "did you mean 'c_thruster_"),
        (("--require", "serch_pipeline"), "did you mean 'search_pipeline'?"),
        (("--select", "fd_recover"), "no function design or configuration has that name"),
        (("--active", "nothing"), "there is no component 'nothing'"),
    ],
)
def test_a_situation_that_makes_no_sense_is_refused(arguments: tuple[str, str], words: str) -> None:
    assert words in refused(rosa("status", *BOTH, *arguments))


def test_explain_goes_down_to_the_measurement() -> None:
    process = rosa("explain", *BOTH, "action", "search_pipeline", "--measure", "battery_level=0.24")
    assert process.returncode == 0
    assert process.stdout.splitlines()[0] == "action 'search_pipeline' is unfeasible: a constraint on it is violated"
    assert "battery_level 0.24 (measured at 0.0 s) violates >= 0.25" in process.stdout


def test_explain_takes_names_with_spaces_and_kinds_with_hyphens() -> None:
    process = rosa("explain", SUAVE, "component-configuration", "high altitude", "-m", "water_visibility=3.5", "--json")
    document = json.loads(process.stdout)
    assert document["status"] == "feasible"
    assert "3.5" in document["because"][0]["reason"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("action",), "files, a kind and a name are needed"),
        (("actoin", "search_pipeline"), "did you mean 'action'?"),
        (("action", "search"), "there is no action 'search'"),
        (("measure", "water_visibility"), "kinds are:"),
    ],
)
def test_explaining_what_is_not_there_is_refused(arguments: tuple[str, ...], words: str) -> None:
    assert words in refused(rosa("explain", SUAVE, *arguments))


@pytest.mark.parametrize(("files", "counts"), [((SUAVE,), (18, 12, 30)), (BOTH, (22, 16, 38)), ((UAV,), (24, 16, 40))])
def test_effort_is_as_in_the_papers_table_7(files: tuple[Path, ...], counts: tuple[int, int, int]) -> None:
    document = json.loads(rosa("effort", *files, "--json").stdout)
    assert (document["entities"], document["relations"], document["total"]) == counts
    assert sum(document["by_kind"].values()) == counts[2]
    assert rosa("effort", *files).stdout.split()[-1] == str(counts[2])


def test_the_schema_is_a_schema() -> None:
    document = json.loads(rosa("schema").stdout)
    assert document["title"] == "ROSA knowledge model"


def test_help_lists_the_commands_and_no_command_shows_help() -> None:
    process = rosa("--help")
    assert process.returncode == 0
    for command in ("check", "status", "explain", "effort", "schema", "scenarios", "run"):
        assert command in process.stdout
    assert rosa("fly").returncode == 2


def test_help_does_not_load_what_is_slow() -> None:
    import subprocess
    import sys

    program = (
        "import sys, rosa_cli.main as m\n"
        "sys.argv = ['rosa', '--help']\n"
        "try: m.main()\n"
        "except SystemExit: pass\n"
        "slow = {'mujoco', 'rosa_core', 'rich', 'numpy', 'networkx', 'pydantic', 'py_trees', 'yaml'}\n"
        "slow &= set(sys.modules)\n"
        "sys.exit(f'loaded: {slow}' if slow else 0)"
    )
    process = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert process.returncode == 0, process.stderr


@pytest.mark.parametrize("arguments", [("-h",), ("run", "-h"), ("journal", "show", "-h"), ("campaign", "--help")])
def test_help_has_a_short_form_everywhere(arguments: tuple[str, ...]) -> None:
    process = rosa(*arguments)
    assert process.returncode == 0
    assert "Usage: " in process.stdout
    assert "-h, --help" in process.stdout


def test_the_version_is_that_of_the_package() -> None:
    from importlib.metadata import version

    assert rosa("--version").stdout == f"rosa {version('rosa-coadaptation')}\n"
