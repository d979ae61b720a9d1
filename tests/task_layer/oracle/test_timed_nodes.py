"""Timeout and Delay beside BehaviorTree.CPP's, which run on real time; ours run on the tree's clock."""

from __future__ import annotations

import time
from collections.abc import Callable

import behaviortreepy
import py_trees
import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import SimulationClock
from task_layer import bt
from task_layer.bt.testing import ScriptedLeaf

LONG = 99_999
SHORT = 150
A_WHILE = 0.4
"""In s; longer than SHORT, in ms."""

Board = dict[str, int]


def conditioned(node: Behaviour, **conditions: Callable[[], bool]) -> Behaviour:
    bt.set_conditions(node, bt.Conditions(**conditions))
    return node


def sleep(msec: int) -> Behaviour:
    return bt.Delay("sleep", py_trees.behaviours.Success("awake"), msec)


CASES: list[tuple[str, Callable[[Board], Behaviour], str, str]] = [
    (
        f'<Timeout msec="{SHORT}"><Sleep msec="{LONG}"/></Timeout>',
        lambda board: bt.Timeout("timeout", sleep(LONG), SHORT),
        "tick wait tick tick wait tick",
        "RUNNING FAILURE RUNNING FAILURE",
    ),
    (
        f'<Timeout msec="{SHORT}"><Sleep msec="{LONG}"/></Timeout>',
        lambda board: bt.Timeout("timeout", sleep(LONG), SHORT),
        "tick halt wait tick wait halt tick",
        "RUNNING RUNNING RUNNING",
    ),
    (
        f'<Timeout msec="{LONG}"><Sleep msec="{SHORT}"/></Timeout>',
        lambda board: bt.Timeout("timeout", sleep(SHORT), LONG),
        "tick wait tick tick",
        "RUNNING SUCCESS RUNNING",
    ),
    (
        f'<Timeout msec="0"><Sleep msec="{SHORT}"/></Timeout>',
        lambda board: bt.Timeout("timeout", sleep(SHORT), 0),
        "tick wait tick",
        "RUNNING SUCCESS",
    ),
    (  # the time was over when the child did not run: it may now take as long as it likes
        f'<Timeout msec="{SHORT}"><Sleep msec="{LONG}" _skipIf="v == 0"/></Timeout>',
        lambda board: bt.Timeout("timeout", conditioned(sleep(LONG), skip_if=lambda: board["v"] == 0), SHORT),
        "tick wait 1 tick wait tick tick",
        "SKIPPED RUNNING RUNNING RUNNING",
    ),
    (
        f'<Timeout msec="{SHORT}"><Sleep msec="{LONG}" _skipIf="v == 0"/></Timeout>',
        lambda board: bt.Timeout("timeout", conditioned(sleep(LONG), skip_if=lambda: board["v"] == 0), SHORT),
        "tick 1 tick wait tick",
        "SKIPPED RUNNING FAILURE",
    ),
    (
        f'<Delay delay_msec="{SHORT}"><AlwaysFailure/></Delay>',
        lambda board: bt.Delay("delay", py_trees.behaviours.Failure("failure"), SHORT),
        "tick wait tick tick halt tick wait tick",
        "RUNNING FAILURE RUNNING RUNNING FAILURE",
    ),
    (
        f'<Delay delay_msec="{SHORT}"><Sleep msec="{SHORT}"/></Delay>',
        lambda board: bt.Delay("delay", sleep(SHORT), SHORT),
        "tick wait tick wait tick",
        "RUNNING RUNNING SUCCESS",
    ),
    (  # a child that is skipped need not be waited for again
        f'<Delay delay_msec="{SHORT}"><AlwaysSuccess _skipIf="v == 0"/></Delay>',
        lambda board: bt.Delay(
            "delay",
            conditioned(py_trees.behaviours.Success("success"), skip_if=lambda: board["v"] == 0),
            SHORT,
        ),
        "tick wait tick tick 1 tick tick wait tick",
        "RUNNING SKIPPED SKIPPED SUCCESS RUNNING SUCCESS",
    ),
]


@pytest.mark.slow
@pytest.mark.parametrize(("xml", "make", "steps", "expected"), CASES)
def test_it_comes_to_the_same(xml: str, make: Callable[[Board], Behaviour], steps: str, expected: str) -> None:
    assert theirs(xml, steps) == expected
    assert ours(make, steps) == expected


def theirs(xml: str, steps: str) -> str:
    blackboard = behaviortreepy.Blackboard.create()
    blackboard.set_int("v", 0)
    text = f'<root BTCPP_format="4"><BehaviorTree ID="main">{xml}</BehaviorTree></root>'
    tree = behaviortreepy.BehaviorTreeFactory().create_tree_from_text(text, blackboard)
    came_to = []
    for step in steps.split():
        match step:
            case "tick":
                came_to.append(tree.root_node().execute_tick().name)
            case "wait":
                time.sleep(A_WHILE)
            case "halt":
                tree.halt_tree()
            case value:
                blackboard.set_int("v", int(value))
    return " ".join(came_to)


def ours(make: Callable[[Board], Behaviour], steps: str) -> str:
    board, clock = {"v": 0}, SimulationClock()
    root = make(board)
    for node in root.iterate():
        node.setup(clock=clock)
    came_to = []
    for step in steps.split():
        match step:
            case "tick":
                came_to.append(root.status.name if root in root.tick() else "SKIPPED")
            case "wait":
                clock.advance_to(clock.now() + A_WHILE)
            case "halt":
                root.stop(Status.INVALID)
            case value:
                board["v"] = int(value)
    return " ".join(came_to)


def test_a_tick_is_asked_for_when_the_time_is_over() -> None:
    clock, times = SimulationClock(5.0), []
    leaf = ScriptedLeaf("leaf", "R")
    root = bt.Delay("delay", bt.Timeout("timeout", leaf, 250), 500)
    for node in root.iterate():
        node.setup(clock=clock, wake_at=times.append)
    root.tick_once()
    clock.advance_to(5.5)
    root.tick_once()
    assert times == [5.5, 5.75]
    assert leaf.calls == ["start", "run"]
    clock.advance_to(5.75)
    root.tick_once()
    assert root.status is Status.FAILURE
    assert root.decorated.feedback_message == "leaf took too long"
    assert leaf.calls == ["start", "run", "halt"]
