"""Trees written in Python, as XML."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

import py_trees
import pytest
from py_trees.behaviour import Behaviour

from rosa_core import InputError
from task_layer.bt import (
    AlwaysFailure,
    AlwaysSuccess,
    Condition,
    Conditions,
    InstantAction,
    Inverter,
    IsActionFeasible,
    NodeKind,
    NodeSource,
    Parallel,
    ReactiveSequence,
    RetryUntilSuccessful,
    RosaAction,
    Sequence,
    Sleep,
    SubTree,
    Switch,
    node_uids,
    save_tree,
    set_conditions,
    set_source,
    tree_xml,
)


def body(root: Behaviour) -> list[str]:
    """The lines of the first tree, without indentation."""
    lines = [line.strip() for line in tree_xml(root).splitlines()]
    return lines[2 : lines.index("</BehaviorTree>")]


def test_a_mission_written_in_python_is_saved_with_the_names_of_its_actions() -> None:
    guarded = ReactiveSequence("search", [IsActionFeasible("search_pipeline"), RosaAction("search_pipeline")])
    assert body(RetryUntilSuccessful("for ever", guarded, -1)) == [
        '<RetryUntilSuccessful name="for ever" num_attempts="-1">',
        '<ReactiveSequence name="search">',
        '<IsActionFeasible action_name="search_pipeline" />',
        "<search_pipeline />",
        "</ReactiveSequence>",
        "</RetryUntilSuccessful>",
    ]


def test_the_leaves_are_declared_with_their_ports_for_the_editor() -> None:
    tree = Sequence("s", [IsActionFeasible("go"), RosaAction("go", preference="energy"), Condition("battery ok", bool)])
    models = ET.fromstring(tree_xml(tree)).find("TreeNodesModel")
    assert models is not None
    assert [(model.tag, model.get("ID"), [port.get("name") for port in model]) for model in models] == [
        ("Condition", "IsActionFeasible", ["action_name"]),
        ("Condition", "battery ok", []),
        ("Action", "go", ["action_name", "preference"]),
    ]


def test_a_subtree_is_a_tree_of_its_own_and_written_once() -> None:
    tree = Sequence("top", [SubTree("Part", AlwaysSuccess("a")), SubTree("Part", AlwaysSuccess("a"))])
    document = ET.fromstring(tree_xml(tree, tree_id="Main"))
    assert [element.get("ID") for element in document.findall("BehaviorTree")] == ["Main", "Part"]


def test_two_different_subtrees_of_one_name_cannot_be_saved() -> None:
    tree = Sequence("top", [SubTree("Part", AlwaysSuccess("a")), SubTree("Part", AlwaysFailure("a"))])
    with pytest.raises(InputError, match="a second, different tree called 'Part'"):
        tree_xml(tree)


def test_stock_composites_that_do_the_same_are_saved_under_the_names_of_btcpp() -> None:
    tree = py_trees.composites.Selector("f", memory=False, children=[py_trees.behaviours.Success("ok")])
    assert body(tree) == ['<ReactiveFallback name="f">', '<AlwaysSuccess name="ok" />', "</ReactiveFallback>"]


def test_an_own_leaf_says_how_it_is_written() -> None:
    leaf = AlwaysSuccess("go")
    set_source(leaf, NodeSource("MoveTo", NodeKind.ACTION, (("goal", "1;2"),)))
    assert body(leaf) == ['<MoveTo name="go" goal="1;2" />']


def test_everything_that_cannot_be_saved_is_told_at_once() -> None:
    guarded = AlwaysSuccess("guarded")
    set_conditions(guarded, Conditions(skip_if=lambda: True))
    stock = py_trees.composites.Parallel("stock", py_trees.common.ParallelPolicy.SuccessOnOne(), [AlwaysSuccess("x")])
    tree = Sequence("top", [guarded, Inverter("i", stock), Parallel("p", [AlwaysSuccess("a\0")], lambda: 1)])
    with pytest.raises(InputError) as error:
        tree_xml(tree)
    assert [problem.what for problem in error.value.problems] == [
        "'guarded' cannot be saved: its _skipIf is a Python function",
        "'stock' cannot be saved: BehaviorTree.CPP has no node like py_trees.composites.Parallel",
        "'p' cannot be saved: its success_count is a Python function",
        "name of 'a\0' has a character that XML cannot hold: 'a\\x00'",
    ]


def test_a_text_that_looks_like_an_entry_of_the_blackboard_cannot_be_saved_as_a_value() -> None:
    tree = Switch("s", [AlwaysSuccess(str(i)) for i in range(3)], variable="{x}", cases=["1", "2"])
    with pytest.raises(InputError, match="would be read as an entry of the blackboard"):
        tree_xml(tree)


def test_a_switch_with_more_cases_than_btcpp_has_cannot_be_saved() -> None:
    tree = Switch("s", [AlwaysSuccess(str(i)) for i in range(8)], variable="x", cases=list("abcdefg"))
    with pytest.raises(InputError, match="7 cases; in XML a Switch has 2 to 6"):
        tree_xml(tree)


def test_a_tree_too_deep_to_be_loaded_is_not_saved() -> None:
    tree: Behaviour = AlwaysSuccess("leaf")
    for _ in range(10_000):
        tree = Inverter("i", tree)
    with pytest.raises(InputError, match="more than 200 levels deep"):
        tree_xml(tree)


def test_a_tree_that_is_watched_leaves_out_what_cannot_be_saved() -> None:
    tree = Parallel("p", [SubTree("Part", Sleep("wait", 5)), SubTree("Part", AlwaysSuccess("b"))], lambda: 1)
    set_conditions(tree, Conditions(skip_if=lambda: False))
    document = ET.fromstring(tree_xml(tree, identified=True))
    assert [(e.tag, e.get("_fullpath"), e.get("_uid")) for e in document.iter() if e.get("_fullpath") is not None] == [
        ("BehaviorTree", "", None),
        ("SubTree", "Part::2", "2"),
        ("SubTree", "Part::4", "4"),
        ("BehaviorTree", "Part::2", None),
        ("BehaviorTree", "Part::4", None),
    ]
    uids = {element.get("name"): element.get("_uid") for element in document.iter() if element.get("_uid")}
    assert uids == {"p": "1", None: "4", "wait": "3", "b": "5"}
    assert list(node_uids(tree).values()) == [1, 2, 3, 4, 5]


def test_a_file_that_cannot_be_written_is_an_input_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot write it"):
        save_tree(AlwaysSuccess("a"), tmp_path / "missing" / "tree.xml")
    save_tree(AlwaysSuccess("a"), tmp_path / "tree.xml")
    assert (tmp_path / "tree.xml").read_text(encoding="utf-8") == tree_xml(AlwaysSuccess("a"))


@pytest.mark.parametrize("tree_id", ["Sequence", "LoopInt", "AlwaysSuccess", "InstantAction", "log"])
def test_a_tree_is_not_saved_under_the_name_of_a_node(tree_id: str) -> None:
    root = Sequence("all", [InstantAction("log", lambda: None), InstantAction("InstantAction", lambda: None)])
    with pytest.raises(InputError, match=f"its tree '{tree_id}' would have the name of a node"):
        tree_xml(root, tree_id=tree_id)
