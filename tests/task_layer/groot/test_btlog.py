"""The log is the one that BehaviorTree.CPP writes of the same tree, and what is no log is refused."""

from __future__ import annotations

import errno
import os
import struct
from pathlib import Path
from xml.etree import ElementTree as ET

import py_trees
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from py_trees.common import Status

from rosa_core import InputError, SimulationClock
from task_layer.bt import Sequence, Switch
from task_layer.bt.groot import BtLogWriter, StatusCode, read_btlog
from tests.task_layer.groot.twins import Drawn, Twins, leaf, node, their_log

LEAVES = st.text("RSF", min_size=1, max_size=5).map(leaf)
COMPOSITES = (
    "Sequence",
    "SequenceWithMemory",
    "AsyncSequence",
    "ReactiveSequence",
    "Fallback",
    "AsyncFallback",
    "ReactiveFallback",
)
DECORATORS = ("Inverter", "ForceSuccess", "ForceFailure", "KeepRunningUntilFailure", "SubTree")


def _above(below: st.SearchStrategy[Drawn]) -> st.SearchStrategy[Drawn]:
    several = st.lists(below, min_size=1, max_size=4).map(tuple)
    return st.one_of(
        st.builds(Drawn, st.sampled_from(COMPOSITES), several),
        several.map(lambda children: node("Parallel", *children, success_count=1, failure_count=1)),
        several.map(lambda children: node("ParallelAll", *children, max_failures=1)),
        below.map(lambda child: node("RetryUntilSuccessful", child, num_attempts=3)),
        below.map(lambda child: node("Repeat", child, num_cycles=2)),
        below.flatmap(lambda child: st.sampled_from(DECORATORS).map(lambda tag: node(tag, child))),
    )


TREES = _above(st.recursive(LEAVES, _above, max_leaves=8))


def records(path: Path) -> list[tuple[int, int]]:
    """Node and status of every transition."""
    return [(transition.uid, transition.status) for transition in read_btlog(path).transitions]


@settings(max_examples=150, deadline=None)
@given(TREES, st.lists(st.sampled_from(("tick", "tick", "tick", "halt")), min_size=1, max_size=6))
def test_every_transition_is_that_of_behaviortree_cpp(tmp_path_factory, drawn: Drawn, doings: list[str]) -> None:
    folder = tmp_path_factory.mktemp("logs")
    ours, theirs = folder / "ours.btlog", folder / "theirs.btlog"
    twins = Twins(drawn)
    with their_log(twins, theirs, lambda: len(records(ours))), BtLogWriter(ours, twins.ours):
        for doing in doings:
            getattr(twins, doing)()
    assert records(ours) == records(theirs)


def test_the_file_is_laid_out_as_that_of_behaviortree_cpp(tmp_path: Path) -> None:
    twins = Twins(node("Sequence", leaf("S"), node("SubTree", leaf("R"))))
    clock = SimulationClock(start=12.5)
    their_writer = their_log(twins, tmp_path / "theirs.btlog", lambda: 4)
    with their_writer, BtLogWriter(tmp_path / "ours.btlog", twins.ours, clock):
        clock.advance_to(5000.0)
        twins.tick()
    ours, theirs = ((tmp_path / f"{name}.btlog").read_bytes() for name in ("ours", "theirs"))
    assert ours[:19] == theirs[:19] == b"BTCPP4-FileLogger2\x01"
    (length,) = struct.unpack_from("<i", ours, 19)
    assert ours[23 + length :][:8] == struct.pack("<q", 12_500_000)
    after = round(4987.5e6).to_bytes(6, "little")
    first_record = ours[23 + length + 8 :][:9]
    assert first_record == after + b"\x01\x00" + b"\x01"
    (their_length,) = struct.unpack_from("<i", theirs, 19)
    assert theirs[23 + their_length + 8 + 6 :][:3] == b"\x01\x00\x01"
    assert len(ours) - length == len(theirs) - their_length


def test_both_logs_number_the_same_nodes_alike(tmp_path: Path) -> None:
    inner = node("SubTree", node("Fallback", node("SubTree", leaf("S")), leaf("R")))
    twins = Twins(node("Sequence", leaf("S"), inner, leaf("F"), node("SubTree", leaf("F"))))
    with their_log(twins, tmp_path / "theirs.btlog", lambda: 0):
        BtLogWriter(tmp_path / "ours.btlog", twins.ours).close()
    ours, theirs = (ET.fromstring(read_btlog(tmp_path / f"{name}.btlog").xml) for name in ("ours", "theirs"))

    def shape(root: ET.Element) -> list[tuple[str, dict[str, str]]]:
        trees = root.findall("BehaviorTree")
        return [(element.tag, dict(element.attrib)) for tree in trees for element in tree.iter()]

    assert shape(ours) == shape(theirs)


def test_a_log_of_behaviortree_cpp_can_be_read(tmp_path: Path) -> None:
    twins = Twins(node("Sequence", leaf("S"), leaf("R")))
    with their_log(twins, tmp_path / "theirs.btlog", lambda: 3):
        twins.tick()
    log = read_btlog(tmp_path / "theirs.btlog")
    assert log.start_s > 1.7e9
    assert [(t.uid, t.status.name) for t in log.transitions] == [(1, "RUNNING"), (2, "SUCCESS"), (3, "RUNNING")]
    assert all(0 <= transition.time_s < 60 for transition in log.transitions)


def test_the_log_is_complete_while_it_is_being_written(tmp_path: Path) -> None:
    root = Sequence("all", [py_trees.behaviours.Success("one"), py_trees.behaviours.Running("two")])
    with BtLogWriter(tmp_path / "a.btlog", root, SimulationClock()):
        root.tick_once()
        assert records(tmp_path / "a.btlog") == [(1, 1), (2, 2), (3, 1)]


def test_a_tree_is_not_disturbed_by_a_full_disk_and_the_user_hears_of_it(tmp_path: Path) -> None:
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("this system has no /dev/full")
    root = Sequence("all", [py_trees.behaviours.Success("one")])
    log = BtLogWriter(full, root, SimulationClock())
    root.tick_once()
    assert root.status is Status.SUCCESS
    with pytest.raises(InputError, match=f"/dev/full: cannot write the log: {os.strerror(errno.ENOSPC)}"):
        log.close()
    log.close()


def test_a_log_that_cannot_be_written_is_refused_at_once(tmp_path: Path) -> None:
    root = Sequence("all", [py_trees.behaviours.Success("one")])
    with pytest.raises(InputError, match="cannot write the log: No such file or directory"):
        BtLogWriter(tmp_path / "nowhere" / "a.btlog", root)
    assert type(root) is Sequence


def test_a_closed_log_hears_nothing_more(tmp_path: Path) -> None:
    root = Sequence("all", [py_trees.behaviours.Success("one")])
    BtLogWriter(tmp_path / "a.btlog", root).close()
    root.tick_once()
    assert read_btlog(tmp_path / "a.btlog").transitions == ()


def a_log(tmp_path: Path) -> bytes:
    root = Sequence("all", [py_trees.behaviours.Success("one")])
    with BtLogWriter(tmp_path / "whole.btlog", root, SimulationClock()):
        root.tick_once()
    return (tmp_path / "whole.btlog").read_bytes()


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (lambda _: b"", "not a log"),
        (lambda _: b"<root/>", "not a log of a behaviour tree.*begins with BTCPP4-FileLogger2"),
        (lambda log: log[:18], "ends before its first transition"),
        (lambda log: log[:100], "ends before its first transition"),
        (lambda log: log[:18] + b"\x02" + log[19:], "version 2; only 1"),
        (lambda log: log[:19] + b"\xff\xff\xff\xff" + log[23:], "ends before its first transition"),
        (lambda log: log[:23] + b"\xff" + log[24:], "not text"),
        (lambda log: log[:-4], "ends within its transition 4 .*without its last 5 bytes"),
        (lambda log: log[:-1] + b"\x09", "transition 4 is to status 9"),
    ],
)
def test_what_is_no_whole_log_is_refused(tmp_path: Path, damage, message: str) -> None:
    path = tmp_path / "damaged.btlog"
    path.write_bytes(damage(a_log(tmp_path)))
    with pytest.raises(InputError, match=message):
        read_btlog(path)


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read it: No such file"):
        read_btlog(tmp_path / "none.btlog")


@given(st.binary(max_size=60))
def test_any_bytes_are_a_log_or_are_refused(tmp_path_factory, rest: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "fuzzed.btlog"
    path.write_bytes(b"BTCPP4-FileLogger2" + rest)
    try:
        log = read_btlog(path)
    except InputError:
        return
    assert all(isinstance(transition.status, StatusCode) for transition in log.transitions)


def test_a_skipped_node_leaves_no_transition(tmp_path: Path) -> None:
    """As in BehaviorTree.CPP: its parent gets the outcome, its status stays."""
    cases = ["a", "b"]
    below = [py_trees.behaviours.Success(name) for name in ("a", "b", "otherwise")]
    root = Switch("which", below, variable=lambda: "b", cases=cases)
    with BtLogWriter(tmp_path / "a.btlog", root):
        root.tick_once()
    assert [uid for uid, _ in records(tmp_path / "a.btlog")].count(2) == 0
