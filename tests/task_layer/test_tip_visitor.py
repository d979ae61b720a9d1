"""Which leaf decided: for those who ask ``tip()`` of py_trees' own nodes."""

from __future__ import annotations

import py_trees
import pytest
from hypothesis import given
from hypothesis import strategies as st
from py_trees.behaviours import Failure, Running, Success
from py_trees.common import Status
from py_trees.trees import BehaviourTree

from task_layer.bt import Fallback, Inverter, Parallel, RetryUntilSuccessful, Sequence, TipVisitor

_LEAVES = {"S": Success, "F": Failure, "R": Running}


def tip(root) -> tuple[str, str]:
    tree, visitor = BehaviourTree(root), TipVisitor()
    tree.add_visitor(visitor)
    tree.tick()
    assert visitor.tip is not None
    return visitor.tip.name, visitor.status.name


def leaves(letters: str) -> list[py_trees.behaviour.Behaviour]:
    return [_LEAVES[letter](f"{number}{letter}") for number, letter in enumerate(letters)]


@pytest.mark.parametrize(
    ("root", "name", "status"),
    [
        (Sequence("root", leaves("SFS")), "1F", "FAILURE"),
        (Sequence("root", leaves("SS")), "1S", "SUCCESS"),
        (Sequence("root", [Fallback("any", leaves("FS")), *leaves("R")]), "0R", "RUNNING"),
        (
            Sequence("root", [Success("a"), Fallback("any", [Failure("b"), Inverter("not", Success("c"))])]),
            "c",
            "SUCCESS",
        ),
        (RetryUntilSuccessful("root", Failure("a"), 1), "a", "FAILURE"),
        (Parallel("root", leaves("FRS"), failure_count=1), "0F", "FAILURE"),
        (Success("leaf"), "leaf", "SUCCESS"),
    ],
)
def test_the_leaf_that_decided(root, name: str, status: str) -> None:
    assert tip(root) == (name, status)


def test_before_the_first_tick_there_is_none() -> None:
    visitor = TipVisitor()
    assert (visitor.tip, visitor.status, visitor.feedback_message) == (None, Status.INVALID, "")


def test_it_also_says_what_each_node_came_to() -> None:
    root = Sequence("root", leaves("SF"))
    visitor = TipVisitor()
    for node in root.tick():
        visitor.run(node)
    assert [child.status for child in root.children] == [Status.INVALID] * 2
    assert [visitor.statuses[child.id] for child in root.children] == [Status.SUCCESS, Status.FAILURE]
    assert visitor.feedback_message == "failure"


def _trees(depth: int) -> st.SearchStrategy[object]:
    leaf = st.sampled_from("SFR")
    return (
        leaf
        if depth == 0
        else leaf | st.tuples(st.sampled_from(">?"), st.lists(_trees(depth - 1), min_size=1, max_size=3))
    )


def _made(tree: object, nodes: dict[str, object], numbers) -> py_trees.behaviour.Behaviour:
    if isinstance(tree, str):
        return _LEAVES[tree](f"leaf {next(numbers)}")
    kind, children = tree
    made = [_made(child, nodes, numbers) for child in children]
    return nodes[kind](f"node {next(numbers)}", made)


@given(_trees(3))
def test_it_is_the_tip_of_the_same_tree_of_py_trees(tree: object) -> None:
    from itertools import count

    stock = {
        ">": lambda name, children: py_trees.composites.Sequence(name, memory=True, children=children),
        "?": lambda name, children: py_trees.composites.Selector(name, memory=True, children=children),
    }
    theirs = _made(tree, stock, count())
    theirs.tick_once()
    expected = theirs.tip()
    assert expected is not None
    assert tip(_made(tree, {">": Sequence, "?": Fallback}, count())) == (expected.name, expected.status.name)
