"""The mission's tree alone: what it does with which answers, without a world."""

from __future__ import annotations

from collections.abc import Mapping

import pytest
from py_trees.behaviour import Behaviour

from rosa_core import KnowledgeModel
from task_layer.bt import Registry, load_tree
from task_layer.bt.mission_check import check_mission
from task_layer.bt.testing import FakeKnowledgeBase, ScriptedSkill, expect_trace
from uav_example.missions import MISSION
from uav_example.models import model_files

ACTIONS = ("search", "analyze", "analyze_in_situ", "return_base", "land_fold")


class Situation:
    """What the tree's conditions see."""

    waiting = False
    folded = True
    done = False

    def is_sample_waiting(self) -> bool:
        return self.waiting

    def is_gripper_folded(self) -> bool:
        return self.folded

    def is_survey_done(self) -> bool:
        return self.done


@pytest.fixture
def kb() -> FakeKnowledgeBase:
    return FakeKnowledgeBase(*ACTIONS)


@pytest.fixture
def situation() -> Situation:
    return Situation()


def tree(situation: Situation, scripts: Mapping[str, str]) -> Behaviour:
    asked = (situation.is_sample_waiting, situation.is_gripper_folded, situation.is_survey_done)
    registry = Registry({condition.__name__: condition for condition in asked})
    for action in ACTIONS:
        registry.add(action, ScriptedSkill(scripts.get(action, "R")))
    assert MISSION.tree is not None
    return load_tree(MISSION.tree, registry)


def test_it_fits_the_knowledge_model() -> None:
    assert MISSION.tree is not None
    findings = check_mission(MISSION.tree, KnowledgeModel.load(*model_files(spring=False)))
    assert findings.problems == ()
    assert findings.warnings == ()


def test_it_searches_until_a_sample_is_found_and_picks_it_up(kb: FakeKnowledgeBase, situation: Situation) -> None:
    def found() -> None:
        situation.waiting = True

    expect_trace(
        tree(situation, {"search": "RRS"}),
        "search R -> R",
        found,
        "search R -> R",  # a condition that has been asked is not asked again while what follows runs
        "search S, analyze R -> R",
        kb=kb,
        watch=ACTIONS,
    )


def test_an_interrupted_analysis_is_followed_by_folding(kb: FakeKnowledgeBase, situation: Situation) -> None:
    situation.waiting = True

    def gripper_fails() -> None:
        situation.folded = False
        kb.make_unfeasible("analyze")

    def folded() -> None:
        situation.folded = True

    expect_trace(
        tree(situation, {"land_fold": "RS"}),
        "analyze R -> R",
        gripper_fails,
        "land_fold R -> R",
        folded,
        "land_fold S, analyze_in_situ R -> R",
        kb=kb,
        watch=ACTIONS,
    )


def test_folding_that_was_interrupted_is_begun_again(kb: FakeKnowledgeBase, situation: Situation) -> None:
    situation.waiting, situation.folded = True, False
    kb.make_unfeasible("analyze")
    expect_trace(
        tree(situation, {}),
        "land_fold R -> R",
        lambda: kb.make_unfeasible("land_fold"),
        " -> R",
        lambda: kb.make_feasible("land_fold"),
        " -> R",
        kb=kb,
        watch=ACTIONS,
    )
    assert kb.requested == []


def test_a_folded_gripper_is_not_folded_again(kb: FakeKnowledgeBase, situation: Situation) -> None:
    situation.waiting = True
    kb.make_unfeasible("analyze")
    expect_trace(tree(situation, {}), "analyze_in_situ R -> R", kb=kb, watch=ACTIONS)


def test_when_searching_is_not_feasible_it_returns(kb: FakeKnowledgeBase, situation: Situation) -> None:
    expect_trace(
        tree(situation, {"return_base": "RS"}),
        "search R -> R",
        lambda: kb.make_unfeasible("search"),
        "return_base R -> R",
        lambda: kb.make_feasible("search"),
        "return_base S, search R -> R",
        kb=kb,
        watch=ACTIONS,
    )


def test_when_all_is_done_it_goes_home_and_lands(kb: FakeKnowledgeBase, situation: Situation) -> None:
    situation.done = True
    expect_trace(
        tree(situation, {"search": "S", "return_base": "RS", "land_fold": "RS"}),
        "search S -> R",
        "return_base R -> R",
        "return_base S, land_fold R -> R",
        "land_fold S -> S",
        kb=kb,
        watch=ACTIONS,
    )
