"""The missions' trees: counted as the ROSA paper counts them, and flown tick by tick without a world."""

from __future__ import annotations

from pathlib import Path

import py_trees
import pytest
from py_trees.behaviour import Behaviour

from rosa_core import KnowledgeModel
from suave.missions import EXTENDED_MISSION, PLAIN_MISSION
from suave.models import model_files
from suave.scenario import SUAVE, SUAVE_EXTENDED
from task_layer.bt import IsActionFeasible, ReactiveSequence, Registry, load_tree
from task_layer.bt.mission_check import check_mission
from task_layer.bt.testing import FakeKnowledgeBase, ScriptedSkill, expect_trace

ACTIONS = ("search_pipeline", "inspect_pipeline", "recharge")


class Pipeline:
    """What the mission asks of the world."""

    def __init__(self) -> None:
        self.found = False
        self.inspected = False
        self.aborted = False
        self.calls: list[str] = []


def tree_file(*, extended: bool) -> Path:
    tree = (EXTENDED_MISSION if extended else PLAIN_MISSION).tree
    assert tree is not None
    return tree


def mission(pipeline: Pipeline, *, extended: bool = True, **scripts: str) -> Behaviour:
    leaves = Registry(
        {
            "arm_thrusters": lambda: pipeline.calls.append("armed"),
            "set_guided_mode": lambda: pipeline.calls.append("guided"),
            "is_mission_aborted": lambda: pipeline.aborted,
            "is_pipeline_found": lambda: pipeline.found,
            "is_pipeline_inspected": lambda: pipeline.inspected,
        }
    )
    for action in ACTIONS:
        leaves.add(action, ScriptedSkill(scripts.get(action, "R")))
    return load_tree(tree_file(extended=extended), leaves)


@pytest.mark.parametrize(("extended", "managed", "bare"), [(False, 14, 10), (True, 22, 16)])
def test_the_trees_have_as_many_nodes_as_the_papers(extended: bool, managed: int, bare: int) -> None:
    nodes = list(mission(Pipeline(), extended=extended).iterate())
    guards = [node for node in nodes if isinstance(node, IsActionFeasible)]
    assert len(nodes) == managed
    assert all(isinstance(guard.parent, ReactiveSequence) for guard in guards)
    assert len(nodes) - 2 * len(guards) == bare


@pytest.mark.parametrize("extended", [False, True])
def test_nothing_is_to_be_said_against_the_missions(extended: bool) -> None:
    model = KnowledgeModel.load(*model_files(extended=extended))
    scenario = SUAVE_EXTENDED if extended else SUAVE
    for leaves in (None, scenario.mission_leaves()):
        findings = check_mission(tree_file(extended=extended), model, leaves)
        assert findings.problems == findings.warnings == ()


def test_the_tree_can_be_drawn() -> None:
    shown = py_trees.display.unicode_tree(mission(Pipeline()))
    for name in ("is_mission_aborted", "arm_thrusters", "set_guided_mode", "recharge", "is_pipeline_inspected"):
        assert name in shown


def test_a_low_battery_interrupts_the_inspection_which_then_goes_on() -> None:
    pipeline, kb = Pipeline(), FakeKnowledgeBase(*ACTIONS)
    expect_trace(
        mission(pipeline, search_pipeline="RS", recharge="RS"),
        "-> R",
        lambda: pipeline.calls == ["armed"],
        "search_pipeline R -> R",
        "search_pipeline S, inspect_pipeline R -> R",
        lambda: kb.make_unfeasible("search_pipeline", "inspect_pipeline"),
        "recharge R -> R",
        lambda: kb.make_feasible("search_pipeline", "inspect_pipeline"),
        "recharge S, inspect_pipeline R -> R",  # and does not search again
        kb=kb,
        watch=ACTIONS,
    )
    assert pipeline.calls == ["armed", "guided"]
    assert kb.requested == ["inspect_pipeline"]


def test_the_mission_is_over_when_the_pipeline_is_inspected_or_it_is_aborted() -> None:
    pipeline, kb = Pipeline(), FakeKnowledgeBase(*ACTIONS)

    def see_it_all() -> None:
        pipeline.found = pipeline.inspected = True

    expect_trace(
        mission(pipeline, search_pipeline="S", inspect_pipeline="RS"),
        "-> R",
        "search_pipeline S -> R",
        "inspect_pipeline R -> R",
        see_it_all,
        "inspect_pipeline S -> S",
        kb=kb,
        watch=ACTIONS,
    )
    aborted = Pipeline()
    aborted.aborted = True
    expect_trace(mission(aborted), "is_mission_aborted S -> S", kb=kb)
    assert aborted.calls == []


def test_nothing_feasible_is_tried_again_and_again() -> None:
    kb = FakeKnowledgeBase(*ACTIONS)
    kb.make_unfeasible(*ACTIONS)
    tree = mission(Pipeline())
    expect_trace(tree, *["-> R"] * 5, lambda: kb.make_feasible("recharge"), "recharge R -> R", kb=kb, watch=ACTIONS)


def test_missions_are_files_that_come_with_the_package() -> None:
    assert all(tree_file(extended=extended).is_file() for extended in (False, True))
