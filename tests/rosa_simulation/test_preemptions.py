"""What the task layer hears of a command gate."""

from __future__ import annotations

from rosa_core import SimulationClock
from rosa_reflexes import CommandGate, HandedBack, Preempted, SensorLimits, Watchdog
from rosa_reflexes.config import fault_reflex
from rosa_reflexes.reflex import Reflex
from rosa_simulation.narrator import Narrator
from rosa_simulation.preemptions import Preemptions, narrate_gate
from rosa_simulation.run_record import MissionEvent

STOP = {"v": 0.0}


class Watching:
    """A skill that notes what it is told."""

    def __init__(self) -> None:
        self.heard: list[str] = []

    def preempted(self, event: Preempted) -> None:
        self.heard.append(f"preempted by {event.reflex}")

    def handed_back(self, event: HandedBack) -> None:
        self.heard.append(f"handed back by {event.reflex}")


class Bench:
    def __init__(self) -> None:
        self.clock, self.woken, self.told = SimulationClock(), list[float](), list[MissionEvent]()
        self.preemptions = Preemptions(self.clock, lambda: self.woken.append(self.clock.now()))
        self.narrator = Narrator(self.clock, self.told.append, effect_time=0.01)
        reflexes = [
            Reflex("near", ("front",), lambda readings: readings["front"] < 0.5, STOP),
            Reflex("very near", ("front",), lambda readings: readings["front"] < 0.2, STOP, priority=1.0),
            fault_reflex("front", STOP),
        ]
        self.gate = CommandGate(
            lambda _: None,
            self.clock,
            [SensorLimits("front", 0.0, 5.0)],
            reflexes,
            safe_command=STOP,
            watchdog=Watchdog(200.0, STOP),
            on_event=self.on_event,
        )

    def on_event(self, event: object) -> None:
        narrate_gate(self.narrator, event)  # type: ignore[arg-type]
        self.preemptions.on_gate_event(event)  # type: ignore[arg-type]

    def sense(self, time: float, front: float) -> None:
        self.clock.advance_to(time)
        self.gate.sense({"front": front})


def test_a_skill_hears_once_that_its_command_is_taken_and_that_it_is_back() -> None:
    bench, skill, other = Bench(), Watching(), Watching()
    bench.preemptions.watch(skill)
    bench.preemptions.watch(other)
    bench.sense(1.0, 0.4)
    bench.preemptions.unwatch(other)
    bench.sense(1.5, 0.1)
    bench.sense(3.0, 0.9)
    assert skill.heard == ["preempted by near", "handed back by very near"]
    assert other.heard == ["preempted by near"]
    assert bench.woken == [3.0]


def test_switches_oscillations_and_the_rate_are_counted() -> None:
    bench = Bench()
    for time, front in ((1.0, 0.4), (1.5, 0.9), (10.0, 0.4), (12.0, 0.9)):
        bench.sense(time, front)
    one = bench.preemptions
    assert (one.number, one.switches, one.oscillations, one.per_minute()) == (2, 4, 1, 2.0)
    bench.clock.advance_to(65.0)
    assert one.per_minute() == 1.0


def test_reasons_and_faults_are_in_the_record() -> None:
    bench = Bench()
    bench.sense(1.0, 0.4)
    bench.sense(2.0, 9.0)
    bench.sense(3.0, 0.9)
    bench.narrator.close()
    assert [event.text for event in bench.told] == [
        "'near' takes the command: front 0.4",
        "sensor front is out of range",
        "'front faulty' takes the command: faulty(front) (front is out of range)",
        "sensor front works again",
        "'front faulty' hands the command back after 1.00 s",
    ]
