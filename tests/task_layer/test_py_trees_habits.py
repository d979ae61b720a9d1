"""What people do with py_trees works on our nodes: visitors, displays, handlers, mixed trees, behaviours that raise."""

from __future__ import annotations

from collections.abc import Callable

import py_trees
import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import SimulationClock
from task_layer import bt
from task_layer.bt.testing import ScriptedLeaf

S, F, R, I = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.INVALID  # noqa: E741


def stock_sequence(name: str, children: list[Behaviour], memory: bool = True) -> Behaviour:
    return py_trees.composites.Sequence(name, memory=memory, children=children)


@pytest.fixture
def root() -> Behaviour:
    # R - [S - [S], R, I]
    guard = bt.Inverter("not", ScriptedLeaf("guard", "F"))
    return bt.ReactiveSequence("root", [guard, ScriptedLeaf("act", "R"), ScriptedLeaf("last")])


def test_a_snapshot_visitor_sees_the_nodes_that_were_visited(root: Behaviour) -> None:
    tree = py_trees.trees.BehaviourTree(root)
    snapshot = py_trees.visitors.SnapshotVisitor()
    tree.add_visitor(snapshot)
    tree.tick()
    status = {behaviour.name: snapshot.visited.get(behaviour.id) for behaviour in root.iterate()}
    assert status == {"guard": F, "not": S, "act": R, "last": None, "root": R}


def test_the_other_stock_visitors_work(root: Behaviour, capsys: pytest.CaptureFixture[str]) -> None:
    tree = py_trees.trees.BehaviourTree(root)
    tree.add_visitor(py_trees.visitors.DebugVisitor())
    tree.add_visitor(py_trees.visitors.DisplaySnapshotVisitor(display_only_visited_behaviours=True))
    tree.tick()
    assert "act [*]" in capsys.readouterr().out


def test_a_tree_can_be_shown_and_drawn(root: Behaviour) -> None:
    root.tick_once()
    shown = py_trees.display.unicode_tree(root, show_status=True)
    assert [line.split()[-2:] for line in shown.splitlines() if "act" in line] == [["act", "[*]"]]
    drawn = py_trees.display.dot_tree(root).to_string()
    assert all(name in drawn for name in ("root", "not", "guard", "act", "last"))


def test_handlers_are_called_before_and_after_every_tick(root: Behaviour) -> None:
    tree = py_trees.trees.BehaviourTree(root)
    seen: list[tuple[str, Status]] = []
    tree.add_pre_tick_handler(lambda tree: seen.append(("before", tree.root.status)))
    tree.add_post_tick_handler(lambda tree: seen.append(("after", tree.root.status)))
    tree.setup()
    tree.tick_tock(period_ms=1, number_of_iterations=2)
    assert seen == [("before", I), ("after", R), ("before", R), ("after", R)]
    tree.interrupt()
    tree.shutdown()


def test_the_tip_is_the_leaf_that_runs(root: Behaviour) -> None:
    assert root.tip() is None
    root.tick_once()
    assert root.tip() is root.children[1]
    root.stop(I)
    assert root.tip() is None


def test_the_tip_of_a_tree_that_has_ended_is_where_it_was_decided() -> None:
    root = bt.Fallback("root", [bt.Sequence("inner", [ScriptedLeaf("leaf", "F")])])
    root.tick_once()
    assert root.status is F
    assert root.tip() is root  # its children are idle again


def test_a_stock_composite_inside_ours_goes_its_own_way() -> None:
    inner = stock_sequence("inner", [ScriptedLeaf("1"), ScriptedLeaf("2", "RS")])
    root = bt.Sequence("root", [inner, ScriptedLeaf("3")])
    assert [behaviour.name for behaviour in root.tick()] == ["1", "2", "inner", "root"]
    assert root.status is R
    root.tick_once()
    assert root.status is S


def test_ours_inside_a_stock_composite_is_halted_with_it() -> None:
    switch = [F, S]
    guard = bt.Condition("guard", lambda: switch.pop() is S)
    leaf = ScriptedLeaf("leaf", "R")
    root = stock_sequence("root", [guard, bt.Inverter("inner", bt.Fallback("first", [leaf]))], memory=False)
    root.tick_once()
    assert root.status is R
    root.tick_once()
    assert root.status is F
    assert leaf.calls == ["start", "run", "halt"]
    assert {behaviour.status for behaviour in root.children[1].iterate()} == {I}


def test_a_stock_composite_that_is_passed_over_is_halted_with_what_is_below_it() -> None:
    leaf = ScriptedLeaf("leaf", "R")
    guard = ScriptedLeaf("guard", "SF")
    root = bt.ReactiveSequence("root", [guard, stock_sequence("inner", [leaf])])
    root.tick_once()
    root.tick_once()
    assert root.status is F
    assert leaf.calls[-1] == "halt"


def test_conditions_count_on_stock_composites_too() -> None:
    asked = {"skip": True, "go on": True}
    leaf = ScriptedLeaf("leaf", "R")
    inner = stock_sequence("inner", [leaf])
    conditions = bt.Conditions(
        skip_if=lambda: asked["skip"],
        while_true=lambda: asked["go on"],
        on_halted=lambda: leaf.calls.append("on_halted"),
    )
    bt.set_conditions(inner, conditions)
    root = bt.Fallback("root", [inner, ScriptedLeaf("otherwise", "S")])
    root.tick_once()
    assert root.status is S
    assert leaf.calls == []
    asked["skip"] = False
    root.tick_once()
    assert root.status is R
    asked["go on"] = False
    root.tick_once()
    assert root.status is S
    assert leaf.calls == ["start", "run", "halt", "on_halted"]


class Raising(ScriptedLeaf):
    """Raises in one of its hooks."""

    def __init__(self, where: str) -> None:
        super().__init__("raising", "R" if where == "halted" else "S")
        self._where = where

    def _at(self, where: str) -> None:
        if where == self._where:
            raise OSError(f"no motor in {where}")

    def initialise(self) -> None:
        self._at("initialise")

    def update(self) -> Status:
        self._at("update")
        return super().update()

    def terminate(self, new_status: Status) -> None:
        self._at("halted" if new_status is I else "terminate")


class RaisingAction(bt.SkillAction):
    """Raises when it is interrupted."""

    def __init__(self) -> None:
        super().__init__("raising")

    def on_running(self) -> Status:
        return R

    def on_halted(self) -> None:
        raise OSError("no motor in on_halted")


def raising_conditions() -> Behaviour:
    def no_motor() -> bool:
        raise OSError("no motor in conditions")

    leaf = ScriptedLeaf("raising")
    bt.set_conditions(leaf, bt.Conditions(skip_if=no_motor))
    return leaf


@pytest.mark.parametrize(
    ("where", "make"),
    [(where, lambda where=where: Raising(where)) for where in ("initialise", "update", "terminate")]
    + [("conditions", raising_conditions)],
)
def test_a_behaviour_that_raises_fails_and_the_tree_goes_on(where: str, make: Callable[[], Behaviour]) -> None:
    raised: list[tuple[str, str]] = []
    leaf, otherwise = make(), ScriptedLeaf("otherwise", "R")
    root = bt.Fallback("root", [leaf, otherwise])
    root.setup(on_raise=lambda behaviour, error: raised.append((behaviour.name, str(error))))
    visited = list(root.tick())
    assert root.status is R
    assert visited == [leaf, otherwise, root]
    assert leaf.status is F
    assert leaf.feedback_message == f"raised OSError: no motor in {where}"
    assert raised[0] == ("raising", f"no motor in {where}")


@pytest.mark.parametrize("make", [lambda: Raising("halted"), RaisingAction])
def test_a_behaviour_that_raises_when_it_is_halted_does_not_hold_up_the_others(make: Callable[[], Behaviour]) -> None:
    raised: list[str] = []
    leaf, sibling = make(), ScriptedLeaf("sibling", "R")
    root = bt.Parallel("root", [leaf, sibling])
    root.setup(on_raise=lambda behaviour, error: raised.append(str(error)))
    root.tick_once()
    root.stop(I)
    assert [behaviour.status for behaviour in root.iterate()] == [I, I, I]
    assert sibling.calls == ["start", "run", "halt"]
    assert set(raised) <= {"no motor in halted", "no motor in on_halted"}
    assert raised


def test_a_node_whose_parameters_are_wrong_fails_with_the_reason() -> None:
    parallel = bt.Parallel("parallel", [ScriptedLeaf("1"), ScriptedLeaf("2")], success_count=lambda: 3)
    root = bt.Fallback("root", [parallel, ScriptedLeaf("otherwise")])
    root.tick_once()
    assert root.status is S
    assert parallel.feedback_message == "raised ValueError: success_count is 3, but 'parallel' has 2 children"


def test_an_exception_in_a_condition_of_the_root_fails_the_root() -> None:
    root = bt.Sequence("root", [ScriptedLeaf("leaf")])
    bt.set_conditions(root, bt.Conditions(failure_if=lambda: 1 / 0 > 0))
    root.tick_once()
    assert root.status is F
    assert root.feedback_message == "raised ZeroDivisionError: division by zero"


def chain(depth: int, leaf: Behaviour) -> Behaviour:
    root = leaf
    for number in range(depth):
        kinds = (bt.Inverter, bt.ForceSuccess)
        root = bt.Sequence(f"{number}", [root]) if number % 3 == 0 else kinds[number % 3 - 1](f"{number}", root)
    return root


def test_a_tree_ten_thousand_deep_is_ticked_and_halted() -> None:
    leaf = ScriptedLeaf("leaf", "R")
    root = chain(10_000, leaf)
    tree = py_trees.trees.BehaviourTree(root)
    tree.setup(clock=SimulationClock())
    tree.tick()
    assert root.status is R
    assert root.tip() is leaf
    root.stop(I)
    assert leaf.calls == ["start", "run", "halt"]
    assert {behaviour.status for behaviour in root.iterate()} == {I}
    # a guard lets it down in the middle of a tick, too
    guarded = bt.ReactiveSequence("guarded", [ScriptedLeaf("guard", "SF"), root])
    guarded.tick_once()
    guarded.tick_once()
    assert guarded.status is F
    assert leaf.calls == ["start", "run", "halt"] * 2
