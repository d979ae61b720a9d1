"""A node that raises fails, whatever ticks it: a runner, a node of this package, one of py_trees, or a script."""

from __future__ import annotations

from pathlib import Path

import py_trees
import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import SimulationClock
from task_layer.bt import (
    AlwaysSuccess,
    Condition,
    InstantAction,
    Sequence,
    SkillAction,
    Sleep,
    TreeRunner,
    load_tree,
    tree_xml,
)
from task_layer.bt.engine.status_changes import own_class, watch_statuses
from task_layer.skill import Skill, SkillStatus


class Broken(Skill):
    def start(self) -> None:
        raise OSError("no motor")

    def update(self) -> SkillStatus:
        return SkillStatus.RUNNING

    def stop(self) -> None:
        """Nothing to stop."""


class Own(Behaviour):
    """A behaviour of the user's own."""

    def update(self) -> Status:
        raise OSError("no motor")


def broken() -> bool:
    raise OSError("no motor")


LEAVES = {
    "a condition": lambda: Condition("leaf", broken),
    "an instant action": lambda: InstantAction("leaf", broken),
    "a skill": lambda: SkillAction("leaf", Broken()),
    "a time that makes no sense": lambda: Sleep("leaf", lambda: -1),
}


@pytest.mark.parametrize("name", LEAVES)
def test_a_leaf_that_nothing_but_the_caller_ticks(name: str, caplog: pytest.LogCaptureFixture) -> None:
    leaf = LEAVES[name]()
    leaf.tick_once()
    assert leaf.status is Status.FAILURE
    assert leaf.feedback_message.startswith("raised ")
    assert caplog.messages == ["'leaf' raised"]


@pytest.mark.parametrize("name", LEAVES)
@pytest.mark.parametrize(
    "above",
    [
        lambda leaf: py_trees.composites.Sequence("root", memory=True, children=[leaf]),
        lambda leaf: py_trees.decorators.PassThrough("root", leaf),
        lambda leaf: Sequence("root", [leaf]),
        lambda leaf: Sequence("root", [py_trees.composites.Selector("any", memory=False, children=[leaf])]),
    ],
)
def test_a_leaf_below_any_node(name: str, above, caplog: pytest.LogCaptureFixture) -> None:
    root = above(LEAVES[name]())
    root.tick_once()
    assert root.status is Status.FAILURE
    assert caplog.messages == ["'leaf' raised"]


@pytest.fixture
def load(tmp_path: Path):
    def loaded(body: str, leaves: object):
        path = tmp_path / "mission.xml"
        path.write_text(f'<root BTCPP_format="4"><BehaviorTree ID="M">{body}</BehaviorTree></root>', encoding="utf-8")
        return load_tree(path, leaves)

    return loaded


ROOTS = {
    "a function": ("<leaf/>", {"leaf": broken}),
    "a behaviour of one's own": ("<Own/>", {"Own": Own}),
    "a skill": ("<leaf/>", {"leaf": Broken}),
    "a script": ('<Script code="a = 1"/>', {}),
    "a condition": ('<ScriptCondition code="nothing"/>', {}),
    "a text that is no number": ('<Sleep msec="{nothing}"/>', {}),
    "a composite of py_trees": (
        '<Choose memory="true"><Own/></Choose>',
        {"Choose": py_trees.composites.Selector, "Own": Own},
    ),
}


@pytest.mark.parametrize("name", ROOTS)
def test_a_root_of_a_loaded_tree(name: str, load, caplog: pytest.LogCaptureFixture) -> None:
    body, leaves = ROOTS[name]
    root = load(body, leaves)
    for _ in range(2):
        root.tick_once()
        assert root.status is Status.FAILURE
        assert root.feedback_message.startswith("raised ")
    assert caplog.messages == [f"'{root.name}' raised"] * 2


def test_a_root_of_ones_own_class_stays_what_it_is(load) -> None:
    root = load("<Own/>", {"Own": Own})
    assert isinstance(root, Own)
    assert (type(root).__name__, own_class(root)) == ("Own", Own)
    assert "<Own />" in tree_xml(root)
    seen = []
    unwatch = watch_statuses(root, lambda _, old, new: seen.append((old.name, new.name)))
    root.tick_once()
    unwatch()
    root.tick_once()
    assert seen == [("INVALID", "FAILURE")]
    assert root.status is Status.FAILURE


@pytest.mark.parametrize("name", [name for name in ROOTS if name != "a skill"])
def test_a_runner_hears_of_it_once(name: str, load) -> None:
    body, leaves = ROOTS[name]
    raised: list[str] = []
    root = load(body, leaves)
    with TreeRunner(root, clock=SimulationClock(), on_raise=lambda node, _: raised.append(node.name)) as runner:
        assert runner.run(timeout=1.0) is Status.FAILURE
    assert raised == [root.name]


def test_leaves_that_do_not_raise_are_ticked_as_ever() -> None:
    leaf = AlwaysSuccess("leaf")
    assert list(leaf.tick()) == [leaf]
    assert leaf.status is Status.SUCCESS
