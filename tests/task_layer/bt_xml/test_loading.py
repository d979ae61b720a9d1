"""Missions as Groot2 saves them, loaded and run."""

from __future__ import annotations

from pathlib import Path

import py_trees
import pytest
from py_trees.common import Status

from rosa_core import InputError
from task_layer.bt import Blackboard, Output, load_tree, tree_xml

DATA = Path(__file__).parents[2] / "data" / "trees"


class Robot:
    """What the leaves of the delivery mission do."""

    def __init__(self, *ways: float | None) -> None:
        self.ways = list(ways)
        self.said: list[str] = []

    def leaves(self) -> dict[str, object]:
        return {"move_to": self.move_to, "call_for_help": self.say, "say": self.say}

    def move_to(self, goal: str, speed: float, driven: Output[float]) -> bool:
        self.said.append(f"{goal} at {speed}")
        way = self.ways.pop(0)
        if way is not None:
            driven.set(way)
        return way is not None

    def say(self, text: str) -> None:
        self.said.append(text)


def run(robot: Robot, blackboard: Blackboard | None = None) -> Status:
    root = load_tree(DATA / "delivery.xml", robot.leaves(), blackboard=blackboard)
    for _ in range(10):
        root.tick_once()
        if root.status is not Status.RUNNING:
            break
    return root.status


def test_a_mission_with_an_included_subtree_runs() -> None:
    robot, blackboard = Robot(12.5), Blackboard()
    assert run(robot, blackboard) is Status.SUCCESS
    assert robot.said == ["kitchen at 0.5", "the cups"]
    assert (blackboard.get("way"), blackboard.get("target")) == (12.5, "kitchen")
    assert blackboard.names() == ["MAX", "target", "tries", "way"]


def test_it_tries_again_as_the_script_says() -> None:
    robot = Robot(None, 120.0, 3.0)
    assert run(robot) is Status.SUCCESS
    assert robot.said == ["kitchen at 0.5"] * 3 + ["the cups"]


def test_it_gives_up_and_calls_for_help() -> None:
    robot = Robot(None, None, None)
    assert run(robot) is Status.FAILURE
    assert robot.said == ["kitchen at 0.5"] * 3 + ["stuck"]


def test_the_tools_of_py_trees_work_on_it() -> None:
    root = load_tree(DATA / "delivery.xml", Robot(1.0).leaves())
    tree = py_trees.trees.BehaviourTree(root)
    visitor = py_trees.visitors.SnapshotVisitor()
    tree.add_visitor(visitor)
    tree.tick()
    shown = py_trees.display.unicode_tree(root, show_status=True, visited=visitor.visited)
    assert "on time?" in shown
    assert "to the kitchen" in shown
    assert py_trees.display.render_dot_tree is not None
    assert "drive or call" in str(py_trees.display.dot_tree(root))


def test_two_missions_loaded_from_one_file_share_nothing() -> None:
    first, second = Blackboard(), Blackboard()
    run(Robot(1.0), first)
    assert second.names() == []
    run(Robot(2.0), second)
    assert (first.get("way"), second.get("way")) == (1.0, 2.0)


def write(folder: Path, text: str) -> Path:
    path = folder / "mission.xml"
    path.write_text(text, encoding="utf-8")
    return path


def test_any_tree_of_a_file_may_be_asked_for(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        '<root main_tree_to_execute="A"><BehaviorTree ID="A"><AlwaysSuccess/></BehaviorTree>'
        '<BehaviorTree ID="B"><AlwaysFailure/></BehaviorTree></root>',
    )
    assert load_tree(path, {}).name == "AlwaysSuccess"
    assert load_tree(path, {}, tree="B").name == "AlwaysFailure"


def test_one_tree_needs_neither_a_name_nor_to_be_named(tmp_path: Path) -> None:
    root = load_tree(write(tmp_path, "<root><BehaviorTree><AlwaysSuccess/></BehaviorTree></root>"), {})
    assert 'main_tree_to_execute="BehaviorTree_0"' in tree_xml(root)


def test_the_only_tree_of_the_mission_itself_is_run_whatever_is_included(tmp_path: Path) -> None:
    (tmp_path / "more.xml").write_text('<root><BehaviorTree ID="B"><AlwaysFailure/></BehaviorTree></root>')
    path = write(
        tmp_path, '<root><include path="more.xml"/><BehaviorTree ID="A"><SubTree ID="B"/></BehaviorTree></root>'
    )
    assert load_tree(path, {}).name == "B"


def test_a_file_that_is_included_twice_is_read_once(tmp_path: Path) -> None:
    (tmp_path / "c.xml").write_text('<root><BehaviorTree ID="C"><AlwaysSuccess/></BehaviorTree></root>')
    (tmp_path / "b.xml").write_text('<root><include path="c.xml"/></root>')
    path = write(
        tmp_path,
        '<root><include path="b.xml"/><include path="./c.xml"/><BehaviorTree ID="A"><SubTree ID="C"/></BehaviorTree>'
        "</root>",
    )
    assert load_tree(path, {}).children[0].name == "AlwaysSuccess"


def test_a_link_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "outside.xml").write_text('<root><BehaviorTree ID="C"><AlwaysSuccess/></BehaviorTree></root>')
    folder = tmp_path / "missions"
    folder.mkdir()
    (folder / "inside.xml").symlink_to(tmp_path / "outside.xml")
    path = write(
        folder, '<root><include path="inside.xml"/><BehaviorTree ID="A"><AlwaysSuccess/></BehaviorTree></root>'
    )
    with pytest.raises(InputError, match="outside the mission's folder"):
        load_tree(path, {})


def test_other_encodings_are_read(tmp_path: Path) -> None:
    text = (
        '<?xml version="1.0" encoding="ISO-8859-1"?><root><BehaviorTree><AlwaysSuccess name="ü"/></BehaviorTree></root>'
    )
    path = tmp_path / "latin.xml"
    path.write_bytes(text.encode("latin-1"))
    assert load_tree(path, {}).name == "ü"


def test_a_leaf_that_is_not_used_need_not_be_registered(tmp_path: Path) -> None:
    text = (
        "<root><BehaviorTree><AlwaysSuccess/></BehaviorTree><TreeNodesModel>"
        '<Action ID="other"><input_port name="x"/></Action><Control ID="Own"/></TreeNodesModel></root>'
    )
    assert load_tree(write(tmp_path, text), {}).name == "AlwaysSuccess"


def test_the_mission_in_the_docs_is_the_example() -> None:
    root = Path(__file__).parents[3]
    shown = (root / "docs" / "mission_xml.md").read_text(encoding="utf-8")
    assert (root / "examples" / "fetch.xml").read_text(encoding="utf-8") in shown
