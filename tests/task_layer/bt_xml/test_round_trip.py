"""What is loaded is saved as it was, and what is saved is loaded as it was."""

from __future__ import annotations

import struct
from pathlib import Path
from random import Random
from xml.etree import ElementTree as ET

import behaviortreepy
import pytest
from py_trees.behaviour import Behaviour

from rosa_core import InputError
from task_layer.bt import (
    AlwaysSuccess,
    Blackboard,
    Condition,
    Conditions,
    Fallback,
    InstantAction,
    IsActionFeasible,
    Parallel,
    ReactiveSequence,
    Repeat,
    RetryUntilSuccessful,
    RosaAction,
    Sequence,
    Sleep,
    SubTree,
    Switch,
    Timeout,
    load_tree,
    node_uids,
    save_tree,
    set_conditions,
    tree_xml,
)
from task_layer.bt.scripting import BoundCondition, Scope, compile_script
from tests.task_layer.bt_xml.random_trees import LEAVES, Wait, mission
from tests.task_layer.bt_xml.test_loading import Robot

DATA = Path(__file__).parents[2] / "data" / "trees"


def shape(root: Behaviour) -> list[tuple[str, str, int]]:
    return [(type(node).__name__, node.name, len(node.children)) for node in root.iterate()]


@pytest.mark.parametrize("seed", range(100))
def test_a_random_tree_survives(seed: int, tmp_path: Path) -> None:
    xml = mission(Random(seed))
    first, second = tmp_path / "first.xml", tmp_path / "second.xml"
    first.write_text(xml, encoding="utf-8")
    root = load_tree(first, LEAVES)
    save_tree(root, second)
    again = load_tree(second, LEAVES)
    assert shape(again) == shape(root)
    assert tree_xml(again) == tree_xml(root)
    assert _attributes(xml) == _attributes(tree_xml(root))


def _attributes(xml: str) -> list[tuple[str, list[tuple[str, str]]]]:
    """What is written in the main tree, but for defaults that the saver adds and names that say nothing."""
    tree = ET.fromstring(xml).find("BehaviorTree")
    assert tree is not None
    defaults = {"failure_count": "1"}
    return [
        (
            element.get("ID") or element.tag,
            sorted(
                (name, value)
                for name, value in element.items()
                if name != "ID"
                and defaults.get(name) != value
                and not (name == "name" and value == (element.get("ID") or element.tag))
            ),
        )
        for element in tree.iter()
    ]


def test_a_tree_written_in_python_is_loaded_equal(tmp_path: Path) -> None:
    skipped = Sleep("Sleep", 5)
    set_conditions(skipped, Conditions(skip_if=BoundCondition(compile_script("1 > 2"), Scope(Blackboard()))))
    tree = RetryUntilSuccessful(
        "for ever",
        Fallback(
            "mission",
            [
                Condition("aborted?", lambda: False),
                ReactiveSequence("guarded", [IsActionFeasible("wait"), RosaAction("wait", Wait())]),
                Repeat("twice", Timeout("soon", SubTree("Part", InstantAction("log", lambda: None)), 100), 2),
                Parallel("both", [AlwaysSuccess("a"), skipped], 1, -1),
                Switch("which", [AlwaysSuccess(c) for c in "abc"], variable="x", cases=["x", 2]),
            ],
        ),
        -1,
    )
    path = tmp_path / "mission.xml"
    save_tree(tree, path, tree_id="Mission")
    leaves = {"aborted?": lambda: False, "log": lambda: None, "wait": Wait}
    again = load_tree(path, leaves)
    assert [row[1:] for row in shape(again)] == [row[1:] for row in shape(tree)]
    assert tree_xml(again) == tree_xml(tree, tree_id="Mission")


@pytest.mark.parametrize("file", sorted(DATA.glob("*.xml")), ids=lambda path: path.stem)
def test_files_as_groot_saves_them_are_loaded_unchanged_and_saved_equal(file: Path, tmp_path: Path) -> None:
    plain = ("arm_thrusters", "set_guided_mode", "is_mission_aborted", "is_pipeline_found", "is_pipeline_inspected")
    leaves: dict[str, object] = {name: lambda: None for name in plain}
    leaves |= dict.fromkeys(("search_pipeline", "inspect_pipeline", "recharge"), Wait)
    leaves |= Robot().leaves()
    root = load_tree(file, leaves)
    save_tree(root, tmp_path / "again.xml")
    again = load_tree(tmp_path / "again.xml", leaves)
    assert (shape(again), tree_xml(again)) == (shape(root), tree_xml(root))


IDENTIFIED = """<root BTCPP_format="4" main_tree_to_execute="Main">
<BehaviorTree ID="Main"><Sequence name="top">
 <Script code="a:=1"/>
 <SubTree ID="Sub" x="{a}" z="{@g}"/>
 <SubTree ID="Sub" name="second" x="{a}" _skipIf="a==2"/>
 <Fallback _onSuccess="a:=5"><AlwaysFailure name="bob"/><AlwaysSuccess/></Fallback>
 <Switch2 variable="{a}" case_1="1" case_2="2"><AlwaysSuccess/><AlwaysFailure/><AlwaysFailure/></Switch2>
 <Inverter><RetryUntilSuccessful num_attempts="2"><Sleep msec="1"/></RetryUntilSuccessful></Inverter>
</Sequence></BehaviorTree>
<BehaviorTree ID="Sub"><Sequence><AlwaysSuccess/><SubTree ID="Deep" q="{x}"/></Sequence></BehaviorTree>
<BehaviorTree ID="Deep"><Sleep msec="10"/></BehaviorTree>
</root>"""


def test_the_identified_tree_is_what_btcpp_sends_to_groot(tmp_path: Path) -> None:
    tree = behaviortreepy.BehaviorTreeFactory().create_tree_from_text(IDENTIFIED)
    logger = behaviortreepy.FileLogger(tree, str(tmp_path / "log.btlog"))
    log = (tmp_path / "log.btlog").read_bytes()
    del logger
    (length,) = struct.unpack("<i", log[19:23])
    theirs = ET.fromstring(log[23 : 23 + length])
    path = tmp_path / "mission.xml"
    path.write_text(IDENTIFIED)
    ours = ET.fromstring(tree_xml(load_tree(path, {}), identified=True))
    assert _trees(ours) == _trees(theirs)


def _trees(document: ET.Element) -> list[tuple[str, dict[str, str]]]:
    return [(e.tag, dict(e.items())) for tree in document.findall("BehaviorTree") for e in tree.iter()]


def test_nodes_are_numbered_before_their_children(tmp_path: Path) -> None:
    path = tmp_path / "mission.xml"
    path.write_text(IDENTIFIED)
    root = load_tree(path, {})
    uids = node_uids(root)
    assert uids[root.id] == 1
    assert [uids[child.id] for child in root.children] == [2, 3, 8, 13, 16, 20]


def test_a_loaded_tree_with_a_python_condition_cannot_be_saved(tmp_path: Path) -> None:
    root = Sequence("s", [AlwaysSuccess("a")])
    set_conditions(root, Conditions(while_true=lambda: True))
    with pytest.raises(InputError, match="'s' cannot be saved: its _while is a Python function"):
        save_tree(root, tmp_path / "tree.xml")
    assert not (tmp_path / "tree.xml").exists()
