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

LONG = 999_999
SHORT = 60
A_WHILE = 0.15
"""In s; longer than SHORT, in ms."""
SLOWER = (1, 5, 25)
"""BehaviorTree.CPP waits on real time: on a busy machine its timers come late, and the same is tried more slowly."""

Board = dict[str, int]


def conditioned(node: Behaviour, **conditions: Callable[[], bool]) -> Behaviour:
    bt.set_conditions(node, bt.Conditions(**conditions))
    return node


def sleep(msec: int) -> Behaviour:
    return bt.Delay("sleep", py_trees.behaviours.Success("awake"), msec)


CASES: list[tuple[str, Callable[[Board], Behaviour], str, str]] = [
    (
        '<Timeout msec="{short}"><Sleep msec="{long}"/></Timeout>',
        lambda board: bt.Timeout("timeout", sleep(LONG), SHORT),
        "tick wait tick tick wait tick",
        "RUNNING FAILURE RUNNING FAILURE",
    ),
    (
        '<Timeout msec="{short}"><Sleep msec="{long}"/></Timeout>',
        lambda board: bt.Timeout("timeout", sleep(LONG), SHORT),
        "tick halt wait tick wait halt tick",
        "RUNNING RUNNING RUNNING",
    ),
    (
        '<Timeout msec="{long}"><Sleep msec="{short}"/></Timeout>',
        lambda board: bt.Timeout("timeout", sleep(SHORT), LONG),
        "tick wait tick tick",
        "RUNNING SUCCESS RUNNING",
    ),
    (
        '<Timeout msec="0"><Sleep msec="{short}"/></Timeout>',
        lambda board: bt.Timeout("timeout", sleep(SHORT), 0),
        "tick wait tick",
        "RUNNING SUCCESS",
    ),
    (  # the time was over when the child did not run: it may now take as long as it likes
        '<Timeout msec="{short}"><Sleep msec="{long}" _skipIf="v == 0"/></Timeout>',
        lambda board: bt.Timeout("timeout", conditioned(sleep(LONG), skip_if=lambda: board["v"] == 0), SHORT),
        "tick wait 1 tick wait tick tick",
        "SKIPPED RUNNING RUNNING RUNNING",
    ),
    (
        '<Timeout msec="{short}"><Sleep msec="{long}" _skipIf="v == 0"/></Timeout>',
        lambda board: bt.Timeout("timeout", conditioned(sleep(LONG), skip_if=lambda: board["v"] == 0), SHORT),
        "tick 1 tick wait tick",
        "SKIPPED RUNNING FAILURE",
    ),
    (
        '<Delay delay_msec="{short}"><AlwaysFailure/></Delay>',
        lambda board: bt.Delay("delay", py_trees.behaviours.Failure("failure"), SHORT),
        "tick wait tick tick halt tick wait tick",
        "RUNNING FAILURE RUNNING RUNNING FAILURE",
    ),
    (
        '<Delay delay_msec="{short}"><Sleep msec="{short}"/></Delay>',
        lambda board: bt.Delay("delay", sleep(SHORT), SHORT),
        "tick wait tick wait tick",
        "RUNNING RUNNING SUCCESS",
    ),
    (  # a child that is skipped need not be waited for again
        '<Delay delay_msec="{short}"><AlwaysSuccess _skipIf="v == 0"/></Delay>',
        lambda board: bt.Delay(
            "delay",
            conditioned(py_trees.behaviours.Success("success"), skip_if=lambda: board["v"] == 0),
            SHORT,
        ),
        "tick wait tick tick 1 tick tick wait tick",
        "RUNNING SKIPPED SKIPPED SUCCESS RUNNING SUCCESS",
    ),
]


@pytest.mark.parametrize(("xml", "make", "steps", "expected"), CASES)
def test_it_comes_to_the_same(xml: str, make: Callable[[Board], Behaviour], steps: str, expected: str) -> None:
    assert ours(make, steps) == expected
    # Evaluated one after the other, until one is as expected.
    assert expected in (theirs(xml, steps, times) for times in SLOWER)


def theirs(xml: str, steps: str, times: int) -> str:
    blackboard = behaviortreepy.Blackboard.create()
    blackboard.set_int("v", 0)
    main = xml.format(short=times * SHORT, long=LONG)
    text = f'<root BTCPP_format="4"><BehaviorTree ID="main">{main}</BehaviorTree></root>'
    tree = behaviortreepy.BehaviorTreeFactory().create_tree_from_text(text, blackboard)
    came_to = []
    for step in steps.split():
        match step:
            case "tick":
                came_to.append(tree.root_node().execute_tick().name)
            case "wait":
                time.sleep(times * A_WHILE)
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


def test_a_delay_of_nothing_still_takes_a_tick() -> None:
    # In BehaviorTree.CPP as a rule, too: there the timer's thread and the tick race.
    assert ours(lambda board: bt.Delay("delay", py_trees.behaviours.Success("success"), 0), "tick tick") == (
        "RUNNING SUCCESS"
    )
