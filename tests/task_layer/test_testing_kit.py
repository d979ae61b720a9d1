"""The kit for testing missions."""

from __future__ import annotations

import pytest

from task_layer.bt import Fallback, IsActionFeasible, ReactiveSequence, RosaAction
from task_layer.bt.testing import FakeKnowledgeBase, ScriptedLeaf, ScriptedSkill, expect_trace


def guarded(action: str, skill: ScriptedSkill) -> ReactiveSequence:
    return ReactiveSequence(action, [IsActionFeasible(action, name=f"may {action}"), RosaAction(action, skill)])


def test_a_mission_is_tested_in_ten_lines() -> None:
    kb = FakeKnowledgeBase("search", "recharge")
    mission = Fallback("mission", [guarded("search", ScriptedSkill("R")), guarded("recharge", ScriptedSkill("RS"))])
    expect_trace(
        mission,
        "search R -> R",
        lambda: kb.make_unfeasible("search"),
        "recharge R -> R",
        lambda: kb.make_feasible("search"),
        "recharge S -> S",
        "search R -> R",
        kb=kb,
        watch=("search", "recharge"),
    )


def test_what_is_requested_can_be_asked_between_ticks() -> None:
    kb = FakeKnowledgeBase("search")
    requested: list[list[str]] = []
    tree = guarded("search", ScriptedSkill("RRS"))
    note = lambda: requested.append(kb.requested)  # noqa: E731
    expect_trace(tree, note, "may search S, search R -> R", note, "halt", note, kb=kb)
    assert requested == [[], ["search"], []]


def test_a_trace_that_differs_says_where_and_shows_the_tree() -> None:
    tree = Fallback("either", [ScriptedLeaf("one", "F"), ScriptedLeaf("other", "RS")])
    with pytest.raises(AssertionError) as caught:
        expect_trace(tree, "one F, other R -> R", "one F, other S -> S")
    text = str(caught.value)
    assert "tick 2 differs from the expectation" in text
    assert "1  one F, other R -> R" in text
    assert "expected  one F, other S -> S" in text
    assert "seen      other S -> S" in text
    assert "either" in text.splitlines()[4]


def test_scripts_and_skills_write_down_what_is_done_with_them() -> None:
    leaf, skill = ScriptedLeaf("leaf", "RS"), ScriptedSkill("R")
    expect_trace(leaf, "leaf R -> R", "halt", "leaf S -> S")
    assert leaf.calls == ["start", "run", "halt", "start", "run"]
    kb = FakeKnowledgeBase("act")
    expect_trace(RosaAction("act", skill), "act R -> R", "halt", kb=kb)
    assert skill.calls == ["start", "update", "stop"]


@pytest.mark.parametrize("script", ["", "RX", "rs"])
def test_a_script_of_other_letters_is_refused(script: str) -> None:
    with pytest.raises(ValueError, match="letters S, F and R"):
        ScriptedLeaf("leaf", script)
    with pytest.raises(ValueError, match="letters S, F and R"):
        ScriptedSkill(script)


def test_an_expectation_without_an_outcome_is_refused() -> None:
    with pytest.raises(ValueError, match="ends in"):
        expect_trace(ScriptedLeaf("leaf"), "leaf S")
