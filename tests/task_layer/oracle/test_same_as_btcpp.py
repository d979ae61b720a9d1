"""Our nodes do what BehaviorTree.CPP's do: root, leaves, calls and blackboard, tick by tick, on random trees."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from task_layer import bt
from tests.task_layer.oracle.comparison import difference
from tests.task_layer.oracle.description import Assignment, Case, Check, NodeDescription, Step, to_xml
from tests.task_layer.oracle.generator import ONE, SEVERAL, random_case
from tests.task_layer.oracle.ours import NeverReturnsError, run_ours
from tests.task_layer.oracle.theirs import run_theirs

cases = st.randoms(use_true_random=False).map(random_case)


@settings(max_examples=400, deadline=None, suppress_health_check=list(HealthCheck))
@given(cases)
def test_a_random_tree_does_the_same(case: Case) -> None:
    found = difference(case)
    assert found is None, found


def smallest_difference(seeds: range) -> str | None:
    found = [difference(random_case(Random(seed))) for seed in seeds]
    return min((text for text in found if text is not None), key=len, default=None)


@pytest.mark.parametrize("thousand", range(4))
def test_a_thousand_random_trees_do_the_same(thousand: int) -> None:
    found = smallest_difference(range(thousand * 1000, thousand * 1000 + 1000))
    assert found is None, found


@pytest.mark.slow
@pytest.mark.parametrize("ten_thousand", range(1, 4))
def test_tens_of_thousands_of_random_trees_do_the_same(ten_thousand: int) -> None:
    found = smallest_difference(range(ten_thousand * 10_000, ten_thousand * 10_000 + 10_000))
    assert found is None, found


TICK, HALT = Step("executeTick"), Step("halt")


def put(variable: str, value: int) -> Step:
    return Step("set", Assignment(variable, value))


@pytest.mark.parametrize("kind", ["Sequence", "SequenceWithMemory", "Fallback", "AsyncSequence", "AsyncFallback"])
@pytest.mark.parametrize("steps", [(TICK, HALT), (HALT,), (TICK,)])
def test_what_was_skipped_before_a_halt_counts_or_not(kind: str, steps: tuple[Step, ...]) -> None:
    skipped = NodeDescription("stateful", 2, checks={"_skipIf": Check("v2", True, 0)}, script="R")
    then = NodeDescription("stateful", 3, checks={"_skipIf": Check("v1", True, 1)}, script="RFS")
    # a root that has failed because of its own condition is not idle, and is not counted again
    root = NodeDescription(kind, 1, (skipped, then), checks={"_failureIf": Check("v0", True, 0)})
    again = (put("v0", 0), TICK, put("v0", 1), put("v1", 1), TICK)
    found = difference(Case(root, (put("v0", 1), TICK, *steps, *again)))
    assert found is None, found


@pytest.mark.parametrize(
    ("kind", "port", "script"), [("RetryUntilSuccessful", "num_attempts", "RF"), ("Repeat", "num_cycles", "RS")]
)
def test_a_limit_that_the_child_changes_counts_at_once_or_from_the_next_tick_on(
    kind: str, port: str, script: str
) -> None:
    child = NodeDescription("stateful", 2, script=script, sets=Assignment("v0", 3))
    root = NodeDescription(kind, 1, (child,), ports={port: "{v0}"})
    found = difference(Case(root, (put("v0", 1), TICK, put("v0", 1), TICK, TICK, TICK)))
    assert found is None, found


def test_random_trees_reach_everything() -> None:
    cases = [random_case(Random(seed)) for seed in range(500)]
    nodes = [node for case in cases for node in case.root.nodes()]
    assert {node.kind.rstrip("23456") for node in nodes} >= {*SEVERAL, *ONE, "AlwaysSuccess", "AlwaysFailure"}
    attributes = {key for node in nodes for key in (*node.checks, *node.assignments)}
    assert len(attributes) == 8
    roots, calls = set(), set()
    steps = finished = endless = 0
    for case in cases:
        try:
            results = run_ours(case)
        except NeverReturnsError:
            endless += 1
            continue
        roots |= {step.root for step in results}
        calls |= {call.split()[0] for step in results for call in step.calls}
        steps += len(results)
        finished += len(run_theirs(case))
    assert roots == {"IDLE", "RUNNING", "SUCCESS", "FAILURE"}
    assert calls == {"start", "run", "halt"}
    assert finished > 0.95 * steps  # of what BehaviorTree.CPP gives up on there is little
    assert 0 < endless < 25


def test_a_difference_is_shown_with_the_tree_and_both_traces(monkeypatch: pytest.MonkeyPatch) -> None:
    leaves = tuple(NodeDescription("condition", number, script="S") for number in (2, 3))
    case = Case(NodeDescription("SequenceWithMemory", 1, leaves), (Step("executeTick"), Step("executeTick")))
    assert difference(case) is None
    monkeypatch.setattr(bt.SequenceWithMemory, "_yields_between", False)
    assert difference(case) == "\n".join(
        [
            to_xml(case.root),
            "condition2: S",
            "condition3: S",
            "ours    executeTick -> SUCCESS; run condition2, run condition3; all idle; v0=0 v1=0 v2=0",
            "BT.CPP  executeTick -> RUNNING; run condition2; condition2 SUCCESS; v0=0 v1=0 v2=0",
        ]
    )
