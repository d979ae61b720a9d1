"""The command gate: who commands, when it changes hands, and what is refused."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import pytest

from rosa_core import SimulationClock
from rosa_reflexes import (
    DELIBERATION_SILENT,
    Answer,
    Bounds,
    Command,
    CommandGate,
    Fault,
    GateEvent,
    HandedBack,
    Preempted,
    Reflex,
    ReflexRaised,
    SensorFaultChanged,
    Watchdog,
    parse_rule,
)
from rosa_reflexes.sensors import Readings, SensorLimits

STOP = {"v": 0.0}
TURN = {"v": 0.1}
GO = {"v": 1.0}


def reflex(name: str, rule: str, command: Command = STOP, **more: float) -> Reflex:
    read = parse_rule(rule)
    return Reflex(
        name,
        read.names,
        read.trigger,
        command,
        read.release,
        release_after=read.release_after,
        describe=read.trigger_text,
        **more,
    )


@dataclass
class Bench:
    """A gate with two range sensors, and all that it does."""

    reflexes: tuple[Reflex, ...] = (reflex("keep clear", "front < 0.35 -> stop; release > 0.5 for 0.3 s"),)
    sensors: tuple[SensorLimits, ...] = (SensorLimits("front"), SensorLimits("left"))
    bounds: dict[str, Bounds] = field(default_factory=dict)
    watchdog: Watchdog | None = None

    def __post_init__(self) -> None:
        self.clock = SimulationClock()
        self.sent: list[Command] = []
        self.events: list[GateEvent] = []
        self.gate = CommandGate(
            self.sent.append,
            self.clock,
            self.sensors,
            self.reflexes,
            safe_command=STOP,
            parameters={"limit": 0.35},
            bounds=self.bounds,
            watchdog=self.watchdog,
            on_event=self.events.append,
        )

    def at(self, time: float) -> CommandGate:
        self.clock.advance_to(time)
        return self.gate

    def of(self, kind: type[GateEvent]) -> list[GateEvent]:
        return [event for event in self.events if isinstance(event, kind)]


def test_deliberation_commands_while_nothing_fires() -> None:
    bench = Bench()
    bench.gate.sense({"front": 1.0})
    assert bench.gate.submit(GO, bench.gate.epoch) is Answer.ACCEPTED
    assert bench.sent == [GO]
    assert bench.gate.holder is None
    assert bench.gate.why() == "deliberation commands v 1"


def test_a_sample_that_triggers_a_reflex_is_answered_in_the_same_call() -> None:
    bench = Bench()
    bench.gate.submit(GO, bench.gate.epoch)
    bench.at(2.0).sense({"front": 0.3})
    assert bench.sent == [GO, STOP]
    (event,) = bench.of(Preempted)
    assert isinstance(event, Preempted)
    assert (event.time, event.epoch, event.reflex, event.command) == (2.0, 1, "keep clear", STOP)
    assert bench.gate.why() == "'keep clear' commands v 0 since 2.00 s: front < 0.35 (front 0.3)"


def test_a_command_that_was_decided_on_before_a_reflex_is_stale_for_ever() -> None:
    bench = Bench()
    before = bench.gate.epoch
    bench.gate.sense({"front": 0.3})
    assert bench.gate.submit(GO, before) is Answer.STALE
    during = bench.gate.epoch
    assert bench.gate.submit(GO, during) is Answer.PREEMPTED
    bench.at(1.0).sense({"front": 0.6})
    bench.at(1.3).sense({"front": 0.6})
    assert bench.gate.holder is None
    assert bench.gate.submit(GO, during) is Answer.STALE
    assert bench.gate.submit(GO, bench.gate.epoch) is Answer.ACCEPTED
    assert bench.sent == [STOP, GO]
    assert bench.gate.refusals == {Answer.STALE: 2, Answer.PREEMPTED: 1, Answer.INVALID: 0}


def test_a_reflex_is_released_when_its_condition_has_held_without_a_break() -> None:
    bench = Bench()
    for time, front in ((0.0, 0.3), (0.1, 0.6), (0.3, 0.45), (0.4, 0.6), (0.6, 0.6)):
        bench.at(time).sense({"front": front})
        assert bench.gate.holder == "keep clear"
    bench.at(0.75).check()  # time alone completes the 0.3 s
    assert bench.gate.holder is None
    (event,) = bench.of(HandedBack)
    assert isinstance(event, HandedBack)
    assert event.held_s == pytest.approx(0.75)


def test_a_reflex_stays_at_least_for_its_dwell() -> None:
    bench = Bench((reflex("keep clear", "front < 0.35 -> stop", dwell=1.0),))
    bench.gate.sense({"front": 0.3})
    bench.at(0.9).sense({"front": 2.0})
    assert bench.gate.holder == "keep clear"
    bench.at(1.0).check()
    assert bench.gate.holder is None


def test_of_several_reflexes_the_one_with_the_greatest_priority_commands() -> None:
    turn = reflex("turn", "left < 0.3 -> turn", TURN, priority=1.0)
    stop = reflex("stop", "front < 0.3 -> stop", STOP, priority=2.0)
    bench = Bench((turn, stop))
    bench.gate.sense({"left": 0.1})
    bench.gate.sense({"front": 0.1})
    assert bench.gate.latched() == ("stop", "turn")
    bench.gate.sense({"front": 1.0})
    assert bench.gate.holder == "turn"
    bench.gate.sense({"left": 1.0})
    assert bench.gate.holder is None
    assert bench.sent == [TURN, STOP, TURN]
    assert [event.epoch for event in bench.of(Preempted)] == [1, 2, 3]
    assert bench.gate.preemptions == 1


def test_a_reflex_may_command_by_what_it_sees() -> None:
    def slower(readings: Readings) -> Command:
        return {"v": readings["front"] / 2}

    slow = Reflex("slow down", ("front",), lambda readings: readings["front"] < 1.0, slower)
    bench = Bench((slow,))
    for front in (0.8, 0.8, 0.4, 2.0):
        bench.gate.sense({"front": front})
    assert bench.sent == [{"v": 0.4}, {"v": 0.2}]


def test_a_parameter_moves_the_limit_at_once() -> None:
    bench = Bench((reflex("keep clear", "front < limit -> stop"),))
    bench.gate.sense({"front": 0.5})
    assert bench.gate.holder is None
    bench.gate.set_parameter("limit", 0.6)
    assert bench.gate.holder == "keep clear"
    with pytest.raises(ValueError, match="limit"):
        bench.gate.set_parameter("limit", math.nan)
    with pytest.raises(LookupError, match="'limits'"):
        bench.gate.set_parameter("limits", 1.0)


def test_commands_of_deliberation_keep_to_bounds_and_rates_a_reflex_only_to_bounds() -> None:
    fast = reflex("dodge", "front < 0.35 -> dodge", {"v": -9.0})
    bench = Bench((fast,), bounds={"v": Bounds(-0.5, 0.8, rate=1.0)})
    bench.gate.submit(GO, 0)
    bench.at(0.1).submit(GO, 0)
    bench.at(9.0).submit(GO, 0)
    bench.gate.sense({"front": 0.1})
    assert [command["v"] for command in bench.sent] == pytest.approx([0.0, 0.1, 0.8, -0.5])


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_command_that_is_no_number_is_refused(value: float) -> None:
    bench = Bench()
    assert bench.gate.submit({"v": value}, 0) is Answer.INVALID
    assert bench.sent == []


def test_silent_deliberation_is_replaced_until_it_submits_again() -> None:
    bench = Bench(watchdog=Watchdog(0.5, {"v": 0.05}))
    bench.gate.submit(GO, 0)
    bench.at(0.5).check()
    assert bench.gate.holder is None
    bench.at(0.51).check()
    assert bench.gate.holder == DELIBERATION_SILENT
    assert bench.gate.submit(GO, 0) is Answer.STALE  # but it has shown that it is there
    assert bench.gate.holder is None
    assert bench.gate.submit(GO, bench.gate.epoch) is Answer.ACCEPTED
    assert bench.sent == [GO, {"v": 0.05}, GO]


@pytest.mark.parametrize(
    ("samples", "fault"),
    [
        ([(0.0, 1.0), (0.1, math.nan)], Fault.NOT_A_NUMBER),
        ([(0.0, 1.0), (0.1, 7.0)], Fault.OUT_OF_RANGE),
        ([(0.0, 1.0), (0.3, 1.0), (0.6, 1.0)], Fault.STUCK),
        ([(0.0, 1.0)], Fault.SILENT),
    ],
)
def test_a_faulty_sensor_is_a_trigger_and_recovers(samples: list[tuple[float, float]], fault: Fault) -> None:
    guard = reflex("distrust", "faulty(front) -> stop")
    bench = Bench((guard,), (SensorLimits("front", 0.0, 5.0, silent_after=0.7, stuck_after=0.5),))
    for time, value in samples:
        bench.at(time).sense({"front": value})
    bench.at(0.75).check()
    assert bench.gate.readings.fault("front") is fault
    assert bench.gate.holder == "distrust"
    assert bench.gate.why().endswith(f"faulty(front) (front is {fault})")
    bench.at(0.9).sense({"front": 2.0})
    assert bench.gate.holder is None
    changes = [(event.sensor, event.fault) for event in bench.events if isinstance(event, SensorFaultChanged)]
    assert changes == [("front", fault), ("front", None)]


def test_a_reflex_that_raises_is_a_reflex_that_fired() -> None:
    def broken(readings: Readings) -> bool:
        if readings["front"] < 1.0:
            raise RuntimeError("no idea")
        return False

    bench = Bench((Reflex("broken", ("front",), broken, GO),))
    bench.gate.sense({"front": 0.5})
    bench.gate.sense({"front": 0.5})
    assert (bench.gate.holder, bench.sent) == ("broken", [STOP])
    (event,) = bench.of(ReflexRaised)
    assert isinstance(event, ReflexRaised)
    assert event.error == "RuntimeError: no idea"
    bench.gate.sense({"front": 2.0})
    assert bench.gate.holder is None


def test_a_reflex_whose_command_raises_commands_what_is_safe() -> None:
    def broken(_readings: Readings) -> Command:
        raise RuntimeError("no idea")

    bench = Bench((Reflex("broken", ("front",), lambda readings: readings["front"] < 1.0, broken),))
    bench.gate.sense({"front": 0.5})
    assert bench.sent == [STOP]
    assert len(bench.of(ReflexRaised)) == 1


def test_what_does_not_fit_together_is_refused() -> None:
    one = reflex("keep clear", "front < 1 -> stop")
    with pytest.raises(ValueError, match="stands twice"):
        Bench((one, one))
    with pytest.raises(ValueError, match="no such sensor"):
        Bench((reflex("keep clear", "back < 1 -> stop"),))
    with pytest.raises(LookupError):
        Bench().gate.sense({"back": 1.0})
    with pytest.raises(ValueError, match="reads no sensor"):
        Reflex("blind", (), lambda _: True, STOP)
