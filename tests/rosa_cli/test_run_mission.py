"""``rosa run --mission`` and ``rosa check --mission`` as a user runs them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from suave.missions import EXTENDED_MISSION
from tests.rosa_cli.cli import refused, rosa

MODELS = Path(__file__).resolve().parents[2] / "suave" / "models"
PLAIN, EXTENDED = MODELS / "suave.yaml", MODELS / "suave_extended.yaml"
TREE = EXTENDED_MISSION.tree
assert TREE is not None

SEARCH_ONLY = """<?xml version="1.0"?>
<root BTCPP_format="4">
  <BehaviorTree ID="Search">
    <Sequence>
      <arm_thrusters/>
      <set_guided_mode/>
      <ReactiveSequence>
        <IsActionFeasible action_name="search_pipeline"/>
        <Action ID="search_pipeline" name="look for it"/>
      </ReactiveSequence>
    </Sequence>
  </BehaviorTree>
</root>
"""


@pytest.fixture
def search_only(tmp_path: Path) -> Path:
    file = tmp_path / "search.xml"
    file.write_text(SEARCH_ONLY, encoding="utf-8")
    return file


def test_a_mission_of_ones_own_is_flown(search_only: Path) -> None:
    run = json.loads(rosa("run", "suave", "--mission", search_only, "--json", "-q").stdout)
    assert run["completed"]
    assert run["ended_by"] == "mission done"
    assert run["metrics"]["pipeline_found"]
    assert run["metrics"]["distance_inspected_m"] == 0.0


def test_a_copy_of_the_mission_flies_the_same_mission(tmp_path: Path) -> None:
    copy = tmp_path / "copy.xml"
    copy.write_bytes(TREE.read_bytes())
    ours, theirs = tmp_path / "ours", tmp_path / "theirs"
    rosa("run", "suave-extended", "-q", "--out", ours)
    rosa("run", "suave-extended", "-q", "--out", theirs, "--mission", copy)
    for name in ("run.json", "events.jsonl", "trajectory.csv"):
        assert (ours / name).read_bytes() == (theirs / name).read_bytes()


@pytest.mark.parametrize("manager", ["none", "random", "metacontrol"])
def test_managers_that_know_nothing_of_feasibility_fly_it_too(search_only: Path, manager: str) -> None:
    run = json.loads(rosa("run", "suave", "--manager", manager, "--mission", search_only, "--json", "-q").stdout)
    assert run["ended_by"] in ("mission done", "time limit")


def test_a_mission_that_never_begins_ends_nevertheless(tmp_path: Path) -> None:
    file = tmp_path / "idle.xml"
    waits = '<KeepRunningUntilFailure><Sleep msec="1000"/></KeepRunningUntilFailure>'
    file.write_text(f'<root BTCPP_format="4"><BehaviorTree ID="m">{waits}</BehaviorTree></root>', encoding="utf-8")
    run = json.loads(rosa("run", "suave", "--mission", file, "--json", "-q").stdout)
    assert run["ended_by"] == "never in mode GUIDED"


def test_a_mission_that_cannot_be_read_is_refused_with_file_and_line(tmp_path: Path, search_only: Path) -> None:
    search_only.write_text(SEARCH_ONLY.replace("<arm_thrusters/>", "<arm_thruster/>"), encoding="utf-8")
    message = refused(rosa("run", "suave", "--mission", search_only))
    assert f"{search_only}:5" in message
    assert "arm_thrusters" in message
    assert "no such file" in refused(rosa("run", "suave", "--mission", tmp_path / "none.xml")).lower()


def test_a_mission_that_nobody_would_fly_is_refused(search_only: Path) -> None:
    assert "tree of its own" in refused(rosa("run", "suave", "--manager", "bt", "--mission", search_only))
    assert "--task-layer" in refused(rosa("run", "suave", "--task-layer", "pddl", "--mission", search_only))


def test_an_action_that_the_model_has_not_is_refused_before_anything_is_flown(tmp_path: Path) -> None:
    file = tmp_path / "recharge.xml"
    file.write_text(SEARCH_ONLY.replace('action_name="search_pipeline"', 'action_name="recharge"'), encoding="utf-8")
    assert "recharge" in refused(rosa("run", "suave", "--mission", file))


def test_the_missions_pass_their_check() -> None:
    process = rosa("check", PLAIN, EXTENDED, "--mission", TREE, "--scenario", "suave-extended")
    assert process.stdout.splitlines()[-1] == "ok: a mission of 22 nodes, no warnings"
    assert process.stderr == ""


def test_warnings_are_told_and_do_not_fail_the_check(search_only: Path) -> None:
    process = rosa("check", PLAIN, "--mission", search_only, "--scenario", "suave")
    assert process.returncode == 0
    assert "the action 'inspect_pipeline' of the model is never performed" in process.stderr
    assert process.stdout.splitlines()[-1] == "ok: a mission of 6 nodes, 1 warning"


def test_a_leaf_that_is_not_registered_fails_the_check(search_only: Path) -> None:
    message = refused(rosa("check", PLAIN, "--mission", search_only))
    assert "arm_thrusters" in message
    assert f"{search_only}:5" in message
    assert "there is no scenario" in refused(rosa("check", PLAIN, "--mission", search_only, "--scenario", "moon"))


def test_the_exemplars_own_spelling_of_the_leaves_is_known(tmp_path: Path) -> None:
    file = tmp_path / "spelled.xml"
    spelled = SEARCH_ONLY.replace("arm_thrusters", "ArmThrusters").replace("set_guided_mode", "SetGuidedMode")
    file.write_text(spelled.replace("</Sequence>", "<IsPipelineFound/></Sequence>", 1), encoding="utf-8")
    run = json.loads(rosa("run", "suave", "--mission", file, "--json", "-q").stdout)
    assert run["ended_by"] == "mission done"
    assert run["metrics"]["pipeline_found"]
