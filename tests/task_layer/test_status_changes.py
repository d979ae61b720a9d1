"""Every change of a watched tree is reported; a tree that is not watched is not changed."""

from __future__ import annotations

import py_trees
from hypothesis import given
from hypothesis import strategies as st
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt import Fallback, ReactiveSequence, Sequence
from task_layer.bt.engine.status_changes import own_class, watch_statuses
from task_layer.bt.xml.saver import tree_xml


class Changes:
    """Records the changes that are reported."""

    def __init__(self) -> None:
        self.seen: list[tuple[str, Status, Status]] = []

    def __call__(self, behaviour: Behaviour, old: Status, new: Status) -> None:
        self.seen.append((behaviour.name, old, new))


class Slotted(Behaviour):
    """A leaf as somebody else may write it: slots, and a status that is set in odd places."""

    __slots__ = ("count",)

    def initialise(self) -> None:
        self.count = 0

    def update(self) -> Status:
        self.count += 1
        return Status.RUNNING if self.count < 2 else Status.FAILURE


def a_tree() -> Behaviour:
    return Fallback("any", [Slotted("odd"), Sequence("all", [py_trees.behaviours.Success("one")])])


def test_every_change_is_heard_in_order() -> None:
    root, changes = a_tree(), Changes()
    watch_statuses(root, changes)
    root.tick_once()
    root.tick_once()
    idle, running, success, failure = Status.INVALID, Status.RUNNING, Status.SUCCESS, Status.FAILURE
    assert changes.seen == [
        ("any", idle, running),
        ("odd", idle, running),
        ("odd", running, failure),
        ("all", idle, running),
        ("one", idle, success),
        ("one", success, idle),
        ("all", running, success),
        ("odd", failure, idle),
        ("all", success, idle),
        ("any", running, success),
    ]


def test_trees_of_stock_py_trees_are_heard_as_well() -> None:
    once = py_trees.decorators.Inverter("not", py_trees.behaviours.Success("one"))
    root = py_trees.composites.Sequence("all", memory=False, children=[once])
    changes = Changes()
    watch_statuses(root, changes)
    tree = py_trees.trees.BehaviourTree(root)
    tree.tick()
    root.stop(Status.INVALID)
    last = {name: new for name, _, new in changes.seen}
    assert set(last.values()) == {Status.INVALID}
    assert ("not", Status.INVALID, Status.FAILURE) in changes.seen


def test_without_watchers_every_behaviour_is_of_its_own_class_again() -> None:
    root = a_tree()
    before = [type(node) for node in root.iterate()]
    keys = [set(node.__dict__) for node in root.iterate()]
    stops = [watch_statuses(root, Changes()) for _ in range(2)]
    assert [own_class(node) for node in root.iterate()] == before
    assert all(isinstance(node, kind) for node, kind in zip(root.iterate(), before, strict=True))
    for stop in stops:
        assert [type(node) for node in root.iterate()] != before
        stop()
        stop()
    assert [type(node) for node in root.iterate()] == before
    assert [set(node.__dict__) for node in root.iterate()] == keys


def test_nobody_elses_tree_is_touched() -> None:
    watched, other, changes = a_tree(), a_tree(), Changes()
    watch_statuses(watched, changes)
    other.tick_once()
    assert changes.seen == []
    assert "status" not in vars(Fallback)
    assert "status" not in vars(Behaviour)


def test_several_watch_and_one_may_stop() -> None:
    root, first, second = a_tree(), Changes(), Changes()
    stop = watch_statuses(root, first)
    watch_statuses(root, second)
    root.tick_once()
    assert first.seen == second.seen
    stop()
    reported = len(first.seen)
    root.tick_once()
    assert len(first.seen) == reported < len(second.seen)


def test_a_watched_tree_is_written_as_before() -> None:
    root = a_tree()
    xml = tree_xml(root, identified=True)
    stop = watch_statuses(root, Changes())
    assert tree_xml(root, identified=True) == xml
    assert [str(node) for node in root.iterate()]
    stop()


SCRIPTS = st.lists(st.sampled_from([Status.RUNNING, Status.SUCCESS, Status.FAILURE]), min_size=1, max_size=4)


class Scripted(Behaviour):
    def __init__(self, name: str, script: list[Status]) -> None:
        super().__init__(name)
        self.script, self.place = script, 0

    def update(self) -> Status:
        self.place += 1
        return self.script[self.place % len(self.script)]


@given(st.lists(SCRIPTS, min_size=1, max_size=5), st.integers(1, 8))
def test_watching_changes_nothing_and_the_changes_lead_from_status_to_status(scripts, ticks: int) -> None:
    def tree() -> Behaviour:
        leaves = [Scripted(f"leaf{number}", script) for number, script in enumerate(scripts)]
        return Fallback("any", [ReactiveSequence("all", leaves), Scripted("last", scripts[0])])

    watched, alone, changes = tree(), tree(), Changes()
    watch_statuses(watched, changes)
    for _ in range(ticks):
        watched.tick_once()
        alone.tick_once()
        assert [node.status for node in watched.iterate()] == [node.status for node in alone.iterate()]
    now = dict.fromkeys((node.name for node in watched.iterate()), Status.INVALID)
    for name, old, new in changes.seen:
        assert now[name] is old is not new
        now[name] = new
    assert now == {node.name: node.status for node in watched.iterate()}
