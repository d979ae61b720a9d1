"""The mission's tree alone: what it does with which answers, without a world."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from agv_example.missions import MISSION
from agv_example.models import model_files
from rosa_core import KnowledgeModel
from task_layer.bt import Registry, load_tree
from task_layer.bt.mission_check import check_mission
from task_layer.bt.testing import FakeKnowledgeBase, ScriptedSkill, expect_trace


class Situation:
    """What the tree's conditions see."""

    way = True
    done = False


def tree(situation: Situation, navigate: str) -> Behaviour:
    registry = Registry()
    registry.add("is_there_a_way", lambda: situation.way)
    registry.add("are_all_goals_reached", lambda: situation.done)
    registry.add("navigate", ScriptedSkill(navigate))
    assert MISSION.tree is not None
    return load_tree(MISSION.tree, registry.add("arrive", ScriptedSkill("S"), request=False))


def test_it_fits_the_knowledge_model() -> None:
    assert MISSION.tree is not None
    findings = check_mission(MISSION.tree, KnowledgeModel.load(*model_files()))
    assert findings.problems == ()
    assert findings.warnings == ()


def test_it_drives_to_one_goal_after_the_other() -> None:
    situation = Situation()

    def last() -> None:
        situation.done = True

    expect_trace(
        tree(situation, "RSRS"),
        "navigate R -> R",
        "navigate S, navigate R -> R",
        last,
        "navigate S -> S",
        kb=FakeKnowledgeBase("navigate"),
        watch=("navigate",),
    )


def test_without_a_way_or_a_feasible_configuration_it_stands_until_there_is_one() -> None:
    situation, kb = Situation(), FakeKnowledgeBase("navigate")

    def no_way() -> None:
        situation.way = False

    def way() -> None:
        situation.way = True

    expect_trace(
        tree(situation, "R"),
        "navigate R -> R",
        lambda: kb.make_unfeasible("navigate"),
        " -> R",
        lambda: kb.make_feasible("navigate"),
        "navigate R -> R",
        no_way,
        " -> R",
        way,
        "navigate R -> R",
        kb=kb,
        watch=("navigate",),
    )
