"""Units at work: what they compute, how they are reconnected, and how they are lost."""

from __future__ import annotations

import random
import threading
import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import pytest

from rosa_core import InputError
from rosa_core.clock import Clock, SimulationClock, WallClock
from rosa_streams.environment import Change, Port, Sample, Transformation, Unit
from rosa_streams.runtime import Function, Host, LostUnit, Sources
from rosa_streams.tags import parse_tag

TAG = parse_tag("Number")
PATIENCE = 20.0


def transformation(tid: str, inputs: tuple[str, ...] = ("in",), outputs: tuple[str, ...] = ("out",)) -> Transformation:
    return Transformation(
        tid, tid, tuple(Port(name, TAG) for name in inputs), tuple(Port(name, TAG) for name in outputs)
    )


RELAY, ADD, PAIR, COUNT, SPLIT = (
    transformation("relay"),
    transformation("add"),
    transformation("pair", ("left", "right")),
    transformation("count", ()),
    transformation("split", ("in",), ("low", "high")),
)
LIBRARY = {each.tid: each for each in (RELAY, ADD, PAIR, COUNT, SPLIT)}


def sources() -> Sources:
    known = Sources()
    known.function("relay", lambda value: value)
    known.function("add", lambda value, total: (value + total, value + total), state=0)
    known.function("pair", lambda left, right: (left, right), when="all")
    known.function("split", lambda value: {"low" if value < 10 else "high": value})

    @known.factory("count")
    def count(parameters: Mapping[str, Any]) -> Function:
        return Function(
            lambda now, at: (at, at + 1),
            (),
            ("out",),
            state=parameters.get("start", 0),
            period=parameters.get("period", 1.0),
        )

    return known


def started(*units: Unit, clock: Clock | None = None, known: Sources | None = None, **options: Any) -> Host:
    host = Host(clock or SimulationClock(), known or sources(), **options)
    host.apply(Change(units_added=frozenset(units)), LIBRARY)
    return host


def collected(host: Host, channel: str) -> list[Any]:
    values: list[Any] = []
    host.subscribe(channel, lambda sample: values.append(sample.value))
    return values


def wait_until(condition: Any) -> None:
    limit = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < limit, "it did not happen in time"
        time.sleep(0.001)


@pytest.fixture
def threaded() -> Iterator[Any]:
    hosts: list[Host] = []

    def start(*units: Unit, **options: Any) -> Host:
        hosts.append(started(*units, clock=WallClock(), **options))
        return hosts[-1]

    yield start
    for host in hosts:
        host.close()


def test_a_stream_is_a_sequence_of_samples_with_variable_value_and_time() -> None:
    clock = SimulationClock()
    host = started(Unit.of("count.1", "count", {}, {"out": "/n"}), clock=clock)
    samples: list[Sample] = []
    host.subscribe("/n", samples.append)
    clock.advance_to(3.5)
    assert samples == [Sample("out", 0, 1.0), Sample("out", 1, 2.0), Sample("out", 2, 3.0)]


def test_state_survives_between_samples_and_each_unit_has_its_own() -> None:
    clock = SimulationClock()
    units = (
        Unit("count.1", "count", (), (("out", ("/a",)),), state=(("start", 5),)),
        Unit("count.2", "count", (), (("out", ("/b",)),), parameters=(("period", 0.5),)),
        Unit.of("add.1", "add", {"in": "/a"}, {"out": "/sum"}),
    )
    host = started(*units, clock=clock)
    sums, others = collected(host, "/sum"), collected(host, "/b")
    clock.advance_to(3.0)
    assert sums == [5, 11, 18]
    assert others == [0, 1, 2, 3, 4, 5]


def test_a_function_that_gives_none_emits_nothing_and_outputs_are_chosen_by_name() -> None:
    host = started(Unit.of("split.1", "split", {"in": "/n"}, {"low": "/low", "high": None}))
    low = collected(host, "/low")
    for value in (3, 30, 7):
        host.publish("/n", value)
    assert low == [3, 7]
    assert host.instances()["split.1"].sent == 3


def test_a_function_of_all_inputs_waits_for_a_new_value_of_each() -> None:
    host = started(Unit.of("pair.1", "pair", {"left": "/l", "right": "/r"}, {"out": "/p"}))
    pairs = collected(host, "/p")
    for channel, value in (("/l", 1), ("/l", 2), ("/r", "a"), ("/r", "b"), ("/l", 3)):
        host.publish(channel, value)
    assert pairs == [(2, "a"), (3, "b")]


def test_a_unit_that_raises_is_lost_with_its_reason_and_the_others_go_on() -> None:
    lost: list[LostUnit] = []
    known = sources()
    known.function("relay", lambda value: 1 / value)
    units = (
        Unit.of("relay.1", "relay", {"in": "/n"}, {"out": "/x"}),
        Unit.of("add.1", "add", {"in": "/n"}, {"out": "/s"}),
    )
    host = started(*units, known=known, on_lost=lost.append)
    sums = collected(host, "/s")
    for value in (1, 0, 2):
        host.publish("/n", value)
    assert [(each.cid, each.reason) for each in lost] == [("relay.1", "it raised ZeroDivisionError: division by zero")]
    assert sums == [1, 1, 3]
    assert {unit.cid for unit in host.units()} == {"add.1"}


def test_a_unit_that_cannot_be_loaded_is_lost_with_its_reason() -> None:
    lost: list[LostUnit] = []
    host = Host(SimulationClock(), Sources(), on_lost=lost.append)
    host.apply(Change(units_added=frozenset({Unit.of("relay.1", "relay")})), LIBRARY)
    assert "no implementation 'relay' is registered" in lost[0].reason
    assert not host.units()


def test_an_unknown_output_and_a_subscriber_that_raises_are_different_things() -> None:
    known = sources()
    known.function("split", lambda value: {"middle": value})
    host = started(
        Unit.of("split.1", "split", {"in": "/n"}, {"low": "/l"}),
        Unit.of("relay.1", "relay", {"in": "/n"}, {"out": "/o"}),
        known=known,
    )  # fmt: skip
    host.subscribe("/o", lambda sample: 1 / 0)
    relayed = collected(host, "/o")
    for value in (1, 2):
        host.publish("/n", value)
    assert relayed == [1, 2], "a client's mistake does not stop the unit"
    lost = {each.cid: each.reason for each in host.lost}
    assert lost.keys() == {"split.1", "a subscriber of /o"}
    assert "'middle' is no output port" in lost["split.1"]


def test_ten_thousand_random_reconfigurations_lose_and_double_no_sample() -> None:
    rng = random.Random(1)
    host = started(
        Unit.of("relay.1", "relay", {"in": "/n"}, {"out": "/a"}),
        Unit.of("relay.2", "relay", {"in": "/a"}, {"out": "/b"}),
    )
    arrived, wanted = collected(host, "/result"), []
    host.apply(Change(units_added=frozenset({Unit.of("relay.3", "relay", {"in": "/b"}, {"out": "/result"})})), LIBRARY)
    chain, newest = ["relay.1", "relay.2", "relay.3"], 3
    for step in range(10_000):
        units = {unit.cid: unit for unit in host.units()}
        newest += 1
        names = [f"/c{step}.{place}" for place in range(2)]
        channels = ["/n", *names, "/result"] if rng.random() < 0.5 else ["/n", *_between(chain, units), "/result"]
        if rng.random() < 0.5:
            chain[rng.randrange(3)] = f"relay.{newest}"
        after = {
            cid: Unit.of(cid, "relay", {"in": channels[place]}, {"out": channels[place + 1]})
            for place, cid in enumerate(chain)
        }
        host.apply(
            Change(
                units_added=frozenset(unit for cid, unit in after.items() if units.get(cid) != unit),
                units_removed=frozenset(unit for cid, unit in units.items() if after.get(cid) != unit),
            ),
            LIBRARY,
        )
        for _ in range(rng.randrange(3)):
            wanted.append(len(wanted))
            host.publish("/n", wanted[-1])
    assert arrived == wanted
    assert len(wanted) > 5000


def _between(chain: list[str], units: Mapping[str, Unit]) -> list[str]:
    return [units[cid].channels()[0] for cid in chain[:-1]]


def test_reconfigurations_lose_and_double_no_sample_while_threads_work(threaded: Any) -> None:
    rng = random.Random(2)
    host = threaded(
        Unit.of("relay.1", "relay", {"in": "/n"}, {"out": "/a"}),
        Unit.of("relay.2", "relay", {"in": "/a"}, {"out": "/result"}),
        queue_size=50,
    )  # fmt: skip
    arrived = collected(host, "/result")
    stop, sent = threading.Event(), [0]

    def publish() -> None:
        while not stop.is_set():
            host.publish("/n", sent[0])
            sent[0] += 1

    publisher = threading.Thread(target=publish)
    publisher.start()
    last = "relay.1"
    for step in range(300):
        units = {unit.cid: unit for unit in host.units()}
        first = f"relay.{step + 3}" if rng.random() < 0.5 else last
        after = {
            first: Unit.of(first, "relay", {"in": "/n"}, {"out": f"/c{step}"}),
            "relay.2": Unit.of("relay.2", "relay", {"in": f"/c{step}"}, {"out": "/result"}),
        }
        last = first
        host.apply(
            Change(
                units_added=frozenset(unit for cid, unit in after.items() if units.get(cid) != unit),
                units_removed=frozenset(unit for cid, unit in units.items() if after.get(cid) != unit),
            ),
            LIBRARY,
        )
    stop.set()
    publisher.join(PATIENCE)
    wait_until(lambda: len(arrived) >= sent[0])
    assert arrived == list(range(sent[0]))


def test_queues_are_bounded_and_what_feeds_a_slow_unit_is_held_back(threaded: Any) -> None:
    known = sources()
    go, longest = threading.Semaphore(0), [0]
    known.function("add", lambda value: (go.acquire(timeout=PATIENCE), value)[1])
    host = threaded(
        Unit.of("relay.1", "relay", {"in": "/n"}, {"out": "/a"}),
        Unit.of("add.1", "add", {"in": "/a"}, {"out": "/result"}),
        known=known, queue_size=4, hang_timeout=PATIENCE,
    )  # fmt: skip
    arrived = collected(host, "/result")
    sent = [0]

    def publish() -> None:
        for value in range(60):
            host.publish("/n", value)
            sent[0] += 1

    publisher = threading.Thread(target=publish)
    publisher.start()
    for taken in range(60):
        wait_until(lambda taken=taken: sent[0] >= min(60, taken + 1))
        longest[0] = max(longest[0], *(len(each.queue) for each in host.instances().values()))
        assert sent[0] <= len(arrived) + 4 + 4 + 3, "the publisher waits when both queues are full"
        go.release()
    publisher.join(PATIENCE)
    wait_until(lambda: len(arrived) == 60)
    assert arrived == list(range(60))
    assert longest[0] <= 5


def test_in_simulated_time_a_burst_is_worked_off_before_the_queue_overflows() -> None:
    known = sources()
    known.function("split", lambda value: [{"low": value + place} for place in range(500)])
    host = started(
        Unit.of("split.1", "split", {"in": "/n"}, {"low": "/a"}),
        Unit.of("add.1", "add", {"in": "/a"}, {"out": "/s"}),
        known=known, queue_size=10,
    )  # fmt: skip
    sums = collected(host, "/s")
    host.publish("/n", 0)
    assert len(sums) == 500
    assert sums[-1] == sum(range(500))


def test_a_unit_that_hangs_is_lost_with_its_reason_and_another_worker_goes_on(threaded: Any) -> None:
    known, stuck, lost = sources(), threading.Event(), threading.Event()
    reasons: list[LostUnit] = []
    known.function("add", lambda value: stuck.wait(PATIENCE))

    def on_lost(unit: LostUnit) -> None:
        reasons.append(unit)
        lost.set()

    host = threaded(
        Unit.of("add.1", "add", {"in": "/n"}, {"out": "/s"}),
        Unit.of("relay.1", "relay", {"in": "/m"}, {"out": "/o"}),
        known=known, workers=1, hang_timeout=0.2, on_lost=on_lost,
    )  # fmt: skip
    late, relayed = collected(host, "/s"), collected(host, "/o")
    host.publish("/n", 1)
    host.publish("/n", 2)
    assert lost.wait(PATIENCE)
    assert (reasons[0].cid, reasons[0].reason) == ("add.1", "it hangs: no answer for 0.2 s")
    assert reasons[0].waiting == 1
    host.publish("/m", "on")
    wait_until(lambda: relayed == ["on"])
    stuck.set()
    host.publish("/m", "and on")
    wait_until(lambda: len(relayed) == 2)
    assert late == [], "what it gives after it was lost comes too late"


def dark_camera() -> Sources:
    known = sources()
    known.factory("count")(
        lambda parameters: Function(lambda now: 1 if now < 5.25 else None, (), ("out",), period=0.5, max_silence=2.0)
    )
    return known


def test_a_source_that_goes_dark_is_lost_with_its_reason() -> None:
    clock, lost = SimulationClock(), []
    host = started(
        Unit.of("count.1", "count", {}, {"out": "/n"}), Unit.of("relay.1", "relay", {"in": "/n"}, {"out": "/o"}),
        clock=clock, known=dark_camera(), on_lost=lost.append,
    )  # fmt: skip
    clock.advance_to(7.9)
    assert not lost
    clock.advance_to(8.0)
    assert [(each.cid, each.reason) for each in lost] == [("count.1", "it is silent: no sample for 2 s")]
    assert {unit.cid for unit in host.units()} == {"relay.1"}, "a unit that gets nothing is not to blame"


def test_in_real_time_too_a_silent_unit_is_lost(threaded: Any) -> None:
    known, lost = sources(), threading.Event()
    known.function("relay", lambda value: None, max_silence=0.05)
    host = threaded(
        Unit.of("relay.1", "relay", {"in": "/n"}, {"out": "/o"}),
        known=known, hang_timeout=0.1, on_lost=lambda unit: lost.set(),
    )  # fmt: skip
    host.publish("/n", 1)
    assert lost.wait(PATIENCE)
    assert host.lost[0].reason == "it is silent: no sample for 0.05 s"


def test_processor_time_is_measured_by_the_clock_that_is_given() -> None:
    ticks = iter(range(10**9))
    host = started(Unit.of("relay.1", "relay", {"in": "/n"}, {"out": "/o"}), cpu_time=lambda: float(next(ticks)))
    for value in range(10):
        host.publish("/n", value)
    assert host.instances()["relay.1"].cpu == 10.0


def test_sources_are_named_and_never_imported() -> None:
    with pytest.raises(InputError, match="did you mean 'relay'"):
        sources().make(Unit.of("x.1", "x"), replace(RELAY, source="relai"))
    with pytest.raises(InputError, match="is registered"):
        sources().make(Unit.of("x.1", "x"), replace(RELAY, source="os.system"))
