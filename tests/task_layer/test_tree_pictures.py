"""Any mission can be looked at: as an outline, placed, and drawn."""

from __future__ import annotations

import itertools
from pathlib import Path
from xml.etree import ElementTree as ET

import py_trees
import pytest
from hypothesis import given
from hypothesis import strategies as st
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import InputError
from task_layer.bt import Condition, RetryUntilSuccessful, Sequence
from task_layer.bt.display.description import one_line
from task_layer.bt.display.svg import tree_svg
from task_layer.bt.display.tree_layout import place
from task_layer.bt.xml.outline import read_outline

SVG = "{http://www.w3.org/2000/svg}"


def outline(tmp_path: Path, xml: str, **options: str) -> Behaviour:
    path = tmp_path / "mission.xml"
    path.write_text(xml, encoding="utf-8")
    return read_outline(path, **options)[0]


def lines(root: Behaviour) -> list[str]:
    """The tree in text, two spaces for each level."""
    found, to_do = [], [(root, 0)]
    while to_do:
        node, depth = to_do.pop()
        found.append("  " * depth + one_line(node))
        to_do.extend((child, depth + 1) for child in reversed(node.children))
    return found


def test_nodes_that_nobody_knows_are_shown_as_they_are_written(tmp_path: Path) -> None:
    root = outline(
        tmp_path,
        """<root BTCPP_format="4" main_tree_to_execute="Main">
             <BehaviorTree ID="Main">
               <PipelineSequence name="navigate">
                 <RateController hz="1.0"><Action ID="ComputePath" goal="{goal}" _skipIf="done"/></RateController>
                 <SubTree ID="Dock" where="{pose}"/>
                 <SubTree ID="Elsewhere"/>
               </PipelineSequence>
             </BehaviorTree>
             <BehaviorTree ID="Dock"><AlwaysSuccess/></BehaviorTree>
           </root>""",
    )
    assert lines(root) == [
        'PipelineSequence "navigate"',
        "  RateController hz=1.0",
        "    ComputePath goal={goal} _skipIf=done",
        "  Dock where={pose}",
        "    AlwaysSuccess",
        "  Elsewhere",
    ]


def test_py_trees_shows_what_the_nodes_do(tmp_path: Path) -> None:
    root = outline(
        tmp_path,
        """<root><BehaviorTree ID="M"><Fallback>
             <ReactiveSequence><a/><b/></ReactiveSequence>
             <Parallel><a/></Parallel>
             <Inverter><a/></Inverter>
             <ReactiveFallback><a/></ReactiveFallback>
           </Fallback></BehaviorTree></root>""",
    )
    text = py_trees.display.ascii_tree(root)
    signs = [line.split()[0] for line in text.splitlines()]
    assert signs == ["{o}", "[-]", "-->", "-->", "/_/", "-->", "-^-", "-->", "[o]", "-->"]


def test_another_tree_of_the_file_can_be_asked_for(tmp_path: Path) -> None:
    xml = '<root><BehaviorTree ID="A"><a/></BehaviorTree><BehaviorTree ID="B"><b/></BehaviorTree></root>'
    assert lines(outline(tmp_path, xml, tree="B")) == ["b"]
    with pytest.raises(InputError, match="it does not say which tree to run"):
        outline(tmp_path, xml)


def bomb() -> str:
    trees = [
        f'<BehaviorTree ID="T{n}"><S><SubTree ID="T{n + 1}"/><SubTree ID="T{n + 1}"/></S></BehaviorTree>'
        for n in range(40)
    ]
    return f'<root main_tree_to_execute="T0">{"".join(trees)}<BehaviorTree ID="T40"><a/></BehaviorTree></root>'


BAD = {
    "no XML": ("<root>", "mission.xml:1: not valid XML"),
    "a page": ("<html/>", "the outermost element is <html>"),
    "nothing": ("<root/>", "it does not say which tree to run"),
    "two at the top": (
        '<root><BehaviorTree ID="A"><a/><b/></BehaviorTree></root>',
        "mission.xml:1: .*has 2 nodes in it",
    ),
    "entities": ('<!DOCTYPE r [<!ENTITY a "b">]><root>&a;</root>', "entities are not allowed"),
    "itself": (
        '<root><BehaviorTree ID="A"><S>\n<SubTree ID="A"/></S></BehaviorTree></root>',
        "mission.xml:2: a tree contains itself: A > A",
    ),
    "too deep": (f'<root><BehaviorTree ID="A">{"<a>" * 10_000}{"</a>" * 10_000}</BehaviorTree></root>', "levels deep"),
    "a bomb of subtrees": (bomb(), "more than 10000 nodes"),
}


@pytest.mark.parametrize(("xml", "message"), BAD.values(), ids=BAD)
def test_what_cannot_be_shown_is_refused(tmp_path: Path, xml: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        outline(tmp_path, xml)


TREES = st.recursive(
    st.builds(lambda: py_trees.behaviours.Success("leaf")),
    lambda below: st.lists(below, min_size=1, max_size=4).map(lambda children: Sequence("all", children)),
    max_leaves=25,
)


@given(TREES, st.randoms(use_true_random=False))
def test_no_node_is_placed_over_another_and_parents_are_above_their_children(root: Behaviour, chance) -> None:
    widths = {id(node): float(chance.randrange(10, 200)) for node in root.iterate()}
    placed = place(root, lambda node: widths[id(node)], 5.0)
    at = {id(one.node): one for one in placed}
    assert min(one.x - one.width / 2 for one in placed) == pytest.approx(0.0)
    for _, level in itertools.groupby(sorted(placed, key=lambda one: (one.level, one.x)), key=lambda one: one.level):
        for left, right in itertools.pairwise(level):
            assert right.x - right.width / 2 >= left.x + left.width / 2 + 5.0 - 1e-6
    for one in placed:
        below = [at[id(child)] for child in one.node.children]
        assert all(child.level == one.level + 1 for child in below)
        assert [child.x for child in below] == sorted(child.x for child in below)
        if below:
            assert one.x == pytest.approx((below[0].x + below[-1].x) / 2)


def test_a_picture_holds_every_node_with_its_ports_and_escapes_what_it_quotes() -> None:
    odd = 'a <b> & "c" \x1b[31m \ud7ff'
    root = RetryUntilSuccessful("again & again", Sequence("all", [Condition(odd, lambda: True)]), num_attempts=-1)
    svg = ET.fromstring(tree_svg(root))
    texts = [text.text for text in svg.iter(f"{SVG}text")]

    assert {"RetryUntilSuccessful", '"again & again"', "num_attempts=-1", "Sequence", '"all"'} <= set(texts)
    assert any(text is not None and text.startswith("a <b> &") for text in texts)
    assert len(svg.findall(f"{SVG}path")) == 2
    width, height = float(svg.get("width", 0)), float(svg.get("height", 0))
    for box in svg.iterfind(f"{SVG}g/{SVG}rect"):
        assert 0 <= float(box.get("x", -1)) <= width - float(box.get("width", 0))
        assert 0 <= float(box.get("y", -1)) <= height - float(box.get("height", 0))


def test_a_picture_of_a_running_tree_shows_what_runs() -> None:
    leaves = [
        py_trees.behaviours.Success("one"),
        py_trees.behaviours.Running("two"),
        py_trees.behaviours.Success("three"),
    ]
    root = Sequence("all", leaves)
    root.tick_once()
    assert root.status is Status.RUNNING
    svg = ET.fromstring(tree_svg(root))
    fills = [group.find(f"{SVG}rect").get("fill") for group in svg.iterfind(f"{SVG}g")]
    assert len(set(fills)) == 3  # one has succeeded, two run, one is idle


def test_the_same_tree_gives_the_same_picture() -> None:
    def draw() -> str:
        return tree_svg(Sequence("all", [Condition("one", lambda: True), Condition("two", lambda: True)]))

    assert draw() == draw()


def test_a_deep_tree_can_be_drawn() -> None:
    root: Behaviour = py_trees.behaviours.Success("bottom")
    for _ in range(3000):
        root = Sequence("down", [root])
    assert tree_svg(root).count("<g>") == 3001
