"""``rosa plan`` as a user runs it."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.conftest import SUAVE, SUAVE_EXTENDED
from tests.rosa_cli.cli import refused, rosa

MISSIONS = SUAVE.parent.parent / "missions"
DOMAIN, PROBLEM = MISSIONS / "suave_domain.pddl", MISSIONS / "suave_extended_problem.pddl"


def test_it_prints_the_plan_in_time_and_writes_it_as_a_behaviour_tree(tmp_path: Path) -> None:
    tree = tmp_path / "plan.xml"
    process = rosa("plan", DOMAIN, PROBLEM, "--feasible", "search_pipeline,inspect_pipeline,recharge", "--bt", tree)
    assert process.returncode == 0, process.stderr
    lines = process.stdout.splitlines()
    assert [line.split("(")[1].split()[0] for line in lines[:3]] == [
        "start_robot",
        "search_pipeline",
        "inspect_pipeline",
    ]
    assert lines[1].split()[0] == "5.00"
    assert lines[3].startswith("3 steps, planned by pyperplan")
    root = ElementTree.parse(tree).getroot()
    assert root.get("BTCPP_format") == "4"
    (sequence,) = root.findall("BehaviorTree/SequenceWithMemory")
    assert [child.tag for child in sequence] == ["start_robot", "ReactiveSequence", "ReactiveSequence"]
    guard, leaf = sequence[1]
    assert (guard.tag, guard.get("action_name"), leaf.tag) == (
        "is_action_feasible",
        "search_pipeline",
        "search_pipeline",
    )


def test_the_behaviour_tree_of_a_plan_is_a_mission_for_the_model(tmp_path: Path) -> None:
    models = (SUAVE, SUAVE_EXTENDED)
    mission = tmp_path / "plan.xml"
    planned = rosa("plan", DOMAIN, PROBLEM, "--model", *models, "-m", "battery_level=0.2", "--bt", mission)
    assert planned.returncode == 0, planned.stderr
    shown = rosa("tree", mission)
    assert shown.returncode == 0, shown.stderr
    assert [line.split()[1] for line in shown.stdout.splitlines() if "-->" in line][::2] == [
        "start_robot",
        "recharge",
        "search_pipeline",
        "inspect_pipeline",
    ]
    checked = rosa("check", "--mission", mission, *models)
    assert checked.returncode == 0, checked.stderr
    assert checked.stdout.splitlines()[-1] == "ok: a mission of 11 nodes, no warnings"


def test_who_says_nothing_of_feasibility_is_told_how_to() -> None:
    process = rosa("plan", DOMAIN, PROBLEM)
    assert process.returncode == 1
    assert "say which are with --feasible or --model" in process.stderr


def test_feasibility_comes_from_knowledge_models_in_a_situation() -> None:
    models = ("--model", SUAVE, SUAVE_EXTENDED)
    process = rosa("plan", DOMAIN, PROBLEM, *models, "--measure", "battery_level=0.2", "--json")
    document = json.loads(process.stdout)
    assert [step["action"] for step in document["plan"]] == [
        "start_robot",
        "recharge",
        "search_pipeline",
        "inspect_pipeline",
    ]
    assert document["plan"][1]["requests"] == ["recharge"]
    assert document["unfeasible"] == ["search_pipeline", "inspect_pipeline"]
    assert document["duration_s"] == 20.0


def test_no_plan_is_an_answer_with_its_reason() -> None:
    process = rosa("plan", DOMAIN, PROBLEM, "--feasible", "search_pipeline")
    assert process.returncode == 1
    assert process.stdout.splitlines() == [
        "no plan: (pipeline_inspected p1) cannot be reached: in the way is recharge",
        "unfeasible: inspect_pipeline, recharge",
    ]
    process = rosa("plan", DOMAIN, PROBLEM, "--feasible", "", "--json")
    assert process.returncode == 1
    document = json.loads(process.stdout)
    assert document["plan"] is None
    assert document["no_plan"]["unreachable_goals"] == ["(pipeline_found p1)", "(pipeline_inspected p1)"]
    assert document["no_plan"]["in_the_way"] == ["recharge"]


def test_a_planner_that_runs_out_of_time_is_another_answer() -> None:
    process = rosa("plan", DOMAIN, PROBLEM, "--feasible", "recharge", "--timeout", "0.001", "--engine", "fast-downward")
    assert process.returncode == 3
    assert process.stdout == ""
    assert "fast-downward found no plan within 0.001 s" in process.stderr


def test_time_without_end_is_as_good_as_any() -> None:
    process = rosa("plan", DOMAIN, PROBLEM, "--feasible", "recharge", "--timeout", "inf")
    assert process.returncode == 0, process.stderr
    assert "4 steps" in process.stdout


def test_the_plan_as_a_graph() -> None:
    process = rosa("plan", DOMAIN, PROBLEM, "--feasible", "recharge", "--dot")
    assert process.stdout.startswith("digraph plan {")
    assert process.stdout.count("->") == 3
    assert "inspect_pipeline p1 bluerov" in process.stdout


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((DOMAIN, PROBLEM, "--feasible", "serch_pipeline"), "did you mean 'search_pipeline'?"),
        ((DOMAIN, PROBLEM, "--feasible", "recharge", "--model", SUAVE), "exclude each other"),
        ((DOMAIN, PROBLEM, "--model", SUAVE), "'recharge' is no action of the knowledge base"),
        ((DOMAIN, PROBLEM, SUAVE), "one file too many"),
        ((DOMAIN, PROBLEM, "--measure", "battery_level=1"), "--measure needs a knowledge model"),
        ((DOMAIN, PROBLEM, "--engine", "pyperplam"), "did you mean 'pyperplan'?"),
        ((PROBLEM, DOMAIN), "this is not a domain"),
        ((DOMAIN, "nothing.pddl"), "nothing.pddl: cannot read it"),
        ((DOMAIN, PROBLEM, "--timeout", "0"), "--timeout"),
        ((DOMAIN, PROBLEM, "--feasible", "recharge", "--bt", "/no/such/directory/plan.xml"), "name another file"),
        ((DOMAIN, PROBLEM, "--json", "--dot"), "--json and --dot exclude each other"),
        ((DOMAIN,), "PROBLEM"),
    ],
)
def test_bad_input_is_refused(arguments: tuple[object, ...], words: str) -> None:
    assert words in refused(rosa("plan", *arguments))


def test_a_file_with_an_error_is_named_with_line_and_mend(tmp_path: Path) -> None:
    broken = tmp_path / "broken.pddl"
    broken.write_text(
        DOMAIN.read_text(encoding="utf-8").replace("(over all (pipeline_found", "(over all (pipeline_fund")
    )
    message = refused(rosa("plan", broken, PROBLEM))
    assert "broken.pddl:41: there is no predicate 'pipeline_fund' (did you mean 'pipeline_found'?)" in message
