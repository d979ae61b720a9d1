"""The replies to Groot2 are, byte by byte, those of BehaviorTree.CPP's own publisher of the same tree."""

from __future__ import annotations

import json
import random
import socket
import struct
import threading
from collections.abc import Iterator
from xml.etree import ElementTree as ET

import behaviortreepy
import msgpack
import py_trees
import pytest
from py_trees.common import Status

from rosa_core import InputError, SimulationClock
from task_layer.bt import Sequence, load_tree
from task_layer.bt.groot import GrootPublisher
from tests.hang_limit import HANG_LIMIT
from tests.task_layer.groot.asking import NUMBER, Asker, asking, free_port, header
from tests.task_layer.groot.twins import Twins, leaf, node

HOOK = {"enabled": True, "uid": 2, "mode": 0, "once": False, "position": 0, "desired_status": "SUCCESS"}
WHICH = json.dumps({"uid": 2, "position": 0, "desired_status": "SUCCESS", "remove_when_done": True}).encode()


def mission() -> Twins:
    """Every kind of node, subtrees in subtrees, and leaves that do something else at every tick."""
    search = node("SequenceWithMemory", leaf("RSF"), node("SubTree", node("Fallback", leaf("FS"), leaf("RRS"))))
    guarded = node("ReactiveSequence", leaf("SSF"), node("Inverter", leaf("RFS")))
    both = node("Parallel", leaf("RS"), node("SubTree", search), guarded, success_count=2, failure_count=2)
    return Twins(node("RetryUntilSuccessful", node("Fallback", leaf("F"), both, leaf("RF")), num_attempts=-1))


@pytest.fixture
def pair() -> Iterator[tuple[Twins, Asker, Asker]]:
    """Two trees that are one, and somebody who asks ours and theirs."""
    twins, port, their_port = mission(), free_port(), free_port()
    theirs = behaviortreepy.Groot2Publisher(twins.theirs, their_port)
    with GrootPublisher(twins.ours, port), asking(port) as us, asking(their_port) as them:
        yield twins, us, them
    del theirs


def without_tree_id(answer: list[bytes]) -> list[bytes]:
    """The answer with zeros for the 16 bytes that identify the tree."""
    return answer if answer[0] == b"error" else [answer[0][:6] + bytes(16) + answer[0][22:], *answer[1:]]


def test_the_statuses_are_the_same_after_every_tick_and_halt(pair: tuple[Twins, Asker, Asker]) -> None:
    twins, us, them = pair
    seen = set()
    for number in range(20):
        assert without_tree_id(us.ask("S")) == without_tree_id(them.ask("S"))
        seen.update(us.statuses().values())
        if number % 7 == 6:
            twins.halt()
        else:
            twins.tick()
    assert seen == {0, 1, 2, 3, 11, 12, 13}


def shape(xml: bytes) -> list[tuple[str, str, dict[str, str]]]:
    trees = ET.fromstring(xml).findall("BehaviorTree")
    return [(tree.get("ID", ""), element.tag, dict(element.attrib)) for tree in trees for element in tree.iter()]


def test_the_tree_is_described_alike(pair: tuple[Twins, Asker, Asker]) -> None:
    _, us, them = pair
    ours, theirs = us.ask("T"), them.ask("T")
    assert [len(part) for part in (ours[0], theirs[0])] == [22, 22]
    assert shape(ours[1]) == shape(theirs[1])
    own = {f"leaf{number}" for number in range(30)} & {model.get("ID") for model in _models(theirs[1])}
    assert own
    assert own == {model.get("ID") for model in _models(ours[1])}


def _models(xml: bytes) -> list[ET.Element]:
    return list(ET.fromstring(xml).findall("TreeNodesModel/*"))


REQUESTS = [
    [header("D")],
    [header("A")],
    [header("X")],
    [header("A"), b"more"],
    [header("S", protocol=1)],
    [header("S"), b"more"],
    [header("B")],
    [header("B"), b""],
    [header("B"), b"nobody;nothing"],
    [header("B"), b"MainTree"],
    [header("B"), b"MainTree", b"more"],
    [header("R")],
    [header("R"), WHICH],
    [header("U")],
    [header("U"), WHICH],
    [header("I")],
    [header("r")],
    [header("r"), b"stop"],
    [header("r"), b"whatever"],
    [header("t")],
    [header("N")],
    [header("\0")],
    [header("\xff")],
    [b""],
    [b"short"],
    [header("S") + b"long"],
]


@pytest.mark.parametrize("request_parts", REQUESTS, ids=[f"request{n}" for n in range(len(REQUESTS))])
def test_every_request_is_answered_alike(pair: tuple[Twins, Asker, Asker], request_parts: list[bytes]) -> None:
    twins, us, them = pair
    twins.tick()
    assert without_tree_id(us.send(*request_parts)) == without_tree_id(them.send(*request_parts))


def test_recorded_transitions_are_the_same(pair: tuple[Twins, Asker, Asker]) -> None:
    twins, us, them = pair

    def both(kind: str, *more: bytes) -> tuple[list[bytes], list[bytes]]:
        return us.ask(kind, *more), them.ask(kind, *more)

    twins.tick()
    for answer in both("r", b"start"):
        assert len(answer) == 2
        assert answer[1].isdigit()
    for _ in range(3):
        twins.tick()
    twins.halt()
    ours, theirs = (list(struct.iter_unpack("<IHHB", answer[1])) for answer in both("t"))
    assert ours
    assert [record[2:] for record in ours] == [record[2:] for record in theirs]
    assert [answer[1:] for answer in both("t")] == [[b""], [b""]]
    both("r", b"stop")
    twins.tick()
    assert [answer[1:] for answer in both("t")] == [[b""], [b""]]


def test_recording_for_nobody_keeps_as_many_transitions_as_they_do(pair: tuple[Twins, Asker, Asker]) -> None:
    twins, us, them = pair
    us.ask("r", b"start")
    them.ask("r", b"start")
    for _ in range(150):
        twins.tick()
    ours, theirs = us.ask("t")[1], them.ask("t")[1]
    assert len(ours) == len(theirs) == 9000
    assert [r[2:] for r in struct.iter_unpack("<IHHB", ours)] == [r[2:] for r in struct.iter_unpack("<IHHB", theirs)]


@pytest.mark.parametrize("hook", [json.dumps(HOOK).encode(), json.dumps([HOOK, HOOK]).encode()])
def test_a_breakpoint_is_refused_by_name(hook: bytes) -> None:
    port = free_port()
    with GrootPublisher(Twins(leaf("R")).ours, port), asking(port) as us:
        assert us.ask("I", hook) == [b"error", b"breakpoints are not supported"]
        assert us.ask("D")[1] == b"[]"


@pytest.mark.parametrize("kind", ["I", "R", "U"])
@pytest.mark.parametrize("text", [b"{no json", b"\xff", b"[" * 100_000])
def test_what_ends_their_process_gets_an_error_from_ours(kind: str, text: bytes) -> None:
    port = free_port()
    with GrootPublisher(Twins(leaf("R")).ours, port), asking(port) as us:
        assert us.ask(kind, text) == [b"error", b"the second part must be JSON"]
        assert us.statuses() == {1: 0}


def test_random_requests_are_all_answered() -> None:
    chance, port = random.Random(0), free_port()
    with GrootPublisher(Twins(leaf("R")).ours, port), asking(port) as us:
        for _ in range(300):
            kind = chance.choice("TSBIRNUDAXrt?")
            parts = [chance.randbytes(chance.randrange(9)) for _ in range(chance.randrange(3))]
            answer = us.ask(kind, *parts)
            assert answer[0] in (b"error", header(kind) + answer[0][6:])


def test_the_same_tree_has_the_same_id_in_every_run_and_another_tree_another() -> None:
    ids = []
    for drawn in (node("Sequence", leaf("S")), node("Sequence", leaf("S")), node("Fallback", leaf("S"))):
        port = free_port()
        with GrootPublisher(Twins(drawn).ours, port), asking(port) as us:
            ids.append(us.ask("S")[0][6:])
    assert ids[0] == ids[1] != ids[2]
    assert all(tree_id[6] >> 4 == 4 and tree_id[8] >> 6 == 2 for tree_id in ids)  # the form of a UUID, version 4


WITH_BLACKBOARDS = """<root BTCPP_format="4" main_tree_to_execute="Main">
  <BehaviorTree ID="Main"><Sequence>
    <Script code="altitude := 2.5; count := 3; word := 'spiral'"/>
    <SubTree ID="Sub" name="first" above="{altitude}"/>
    <SubTree ID="Sub" above="{count}"/>
    <SubTree ID="Empty"/>
  </Sequence></BehaviorTree>
  <BehaviorTree ID="Sub"><Sequence>
    <Script code="own := above + 1"/><SubTree ID="Inner" _autoremap="true"/>
  </Sequence></BehaviorTree>
  <BehaviorTree ID="Inner"><Script code="_private := 7"/></BehaviorTree>
  <BehaviorTree ID="Empty"><AlwaysSuccess/></BehaviorTree>
</root>"""


def test_the_blackboards_of_a_mission_and_its_subtrees_are_dumped_alike(tmp_path) -> None:
    (tmp_path / "mission.xml").write_text(WITH_BLACKBOARDS, encoding="utf-8")
    ours = load_tree(tmp_path / "mission.xml", {})
    factory = behaviortreepy.BehaviorTreeFactory()
    theirs = factory.create_tree_from_text(WITH_BLACKBOARDS)
    port, their_port = free_port(), free_port()
    publisher = behaviortreepy.Groot2Publisher(theirs, their_port)
    with GrootPublisher(ours, port), asking(port) as us, asking(their_port) as them:
        assert shape(us.ask("T")[1]) == shape(them.ask("T")[1])
        paths = [tree.get("_fullpath") for tree in ET.fromstring(us.ask("T")[1]).findall("BehaviorTree")]
        names = ";".join(["Main", *filter(None, paths)]).encode()
        for _ in range(2):
            dumps = [msgpack.unpackb(asker.ask("B", names)[1]) for asker in (us, them)]
            assert set(dumps[0]) == set(dumps[1])
            assert dumps[0]["Main"] == dumps[1]["Main"]
            assert {name: (values or {}).get("own") for name, values in dumps[0].items()} == {
                name: (values or {}).get("own") for name, values in dumps[1].items()
            }
            ours.tick_once()
            theirs.tick_exactly_once()
    assert dumps[0]["first"] == {"own": 3.5}
    del publisher


def test_a_tree_of_py_trees_is_shown_with_its_blackboard() -> None:
    writer = py_trees.blackboard.Client(name="test")
    values = {"altitude": 2.5, "whole": 2**70, "names": ["a", "b"], "level": Status.RUNNING, "thing": object()}
    for key in values:
        writer.register_key(key, access=py_trees.common.Access.WRITE)
    root = py_trees.composites.Sequence("all", memory=True, children=[py_trees.behaviours.Running("run")])
    port = free_port()
    try:
        for key, value in values.items():
            writer.set(key, value)
        with GrootPublisher(py_trees.trees.BehaviourTree(root), port), asking(port) as us:
            shown = msgpack.unpackb(us.ask("B", b"MainTree;other")[1])
            root.tick_once()
            assert us.statuses() == {1: 1, 2: 1}
    finally:
        writer.unregister(clear=True)
    wanted = {"altitude": 2.5, "whole": str(2**70), "names": ["a", "b"], "level": "RUNNING", "thing": "<object>"}
    assert wanted.items() <= shown["MainTree"].items()


def test_the_times_of_transitions_are_the_clocks() -> None:
    clock, port = SimulationClock(start=100.0), free_port()
    root = py_trees.behaviours.Running("run")
    with GrootPublisher(root, port, clock=clock), asking(port) as us:
        assert us.ask("r", b"start")[1] == b"100000000"
        clock.advance_to(100.25)
        root.tick_once()
        assert us.ask("t")[1] == struct.pack("<IHHB", 250_000, 0, 1, 1)


def test_asking_while_it_ticks_never_shows_half_a_status() -> None:
    twins, port = mission(), free_port()
    stop = threading.Event()

    def tick() -> None:
        while not stop.is_set():
            twins.ours.tick_once()

    with GrootPublisher(twins.ours, port), asking(port) as us:
        uids = set(us.statuses())
        thread = threading.Thread(target=tick)
        thread.start()
        try:
            for _ in range(200):
                statuses = us.statuses()
                assert set(statuses) == uids
                assert set(statuses.values()) <= {0, 1, 2, 3, 11, 12, 13}
        finally:
            stop.set()
            thread.join()


def test_a_port_that_is_taken_is_refused_and_nothing_is_left_behind() -> None:
    root = Sequence("all", [py_trees.behaviours.Running("run")])
    for taken in (0, 1):
        port = free_port()
        with socket.socket() as other:
            other.bind(("127.0.0.1", port + taken))
            other.listen()
            with pytest.raises(InputError, match=rf"cannot listen at 127.0.0.1:{port + taken}: Address already in use"):
                GrootPublisher(root, port)
        assert type(root) is Sequence
        with GrootPublisher(root, port):
            pass


@pytest.mark.parametrize("port", [0, -1, 65535, 70000])
def test_what_is_no_port_is_refused(port: int) -> None:
    with pytest.raises(InputError, match=f"{port} is not a port for Groot2"):
        GrootPublisher(py_trees.behaviours.Running("run"), port)


def test_closing_frees_the_ports_the_thread_and_the_tree() -> None:
    root, port = Sequence("all", [py_trees.behaviours.Running("run")]), free_port()
    for _ in range(3):
        publisher = GrootPublisher(root, port)
        publisher.close()
        publisher.close()
    assert "groot" not in [thread.name for thread in threading.enumerate()]
    assert type(root) is Sequence


def test_groot_can_listen_on_the_next_port() -> None:
    port = free_port()
    publisher = GrootPublisher(py_trees.behaviours.Running("run"), port)
    with publisher, socket.create_connection(("127.0.0.1", port + 1), timeout=HANG_LIMIT) as listener:
        assert listener.recv(1) == b"\xff"  # how ZeroMQ greets


def test_more_nodes_than_can_be_numbered_are_refused() -> None:
    leaves = [py_trees.behaviours.Success("leaf") for _ in range(65535)]
    with pytest.raises(InputError, match="the tree has 65536 nodes; Groot2 supports 65535"):
        GrootPublisher(Sequence("all", leaves), free_port())


def test_the_asker_is_answered_by_number() -> None:
    port = free_port()
    with GrootPublisher(py_trees.behaviours.Running("run"), port), asking(port) as us:
        assert struct.unpack_from("<I", us.ask("S")[0], 2) == (NUMBER,)
