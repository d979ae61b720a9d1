"""Random schedules: in the gate no stale command follows a reflex, no reflex is lost, and every latch ends."""

from __future__ import annotations

from dataclasses import dataclass, field

from hypothesis import given
from hypothesis import strategies as st

from rosa_core import SimulationClock
from rosa_reflexes import Answer, Command, CommandGate, Preempted, Reflex, SensorLimits, Watchdog, parse_rule

SAFE = {"v": 0.0, "by": 0.0}
SENSORS = ("front", "left", "down")
RULES = {"front": (10.0, 0.4), "left": (5.0, 0.0), "down": (20.0, 0.1)}  # priority, dwell


def commanded(by: float) -> Command:
    return {"v": 0.1, "by": by}


def reflexes() -> list[Reflex]:
    made = []
    for number, (name, (priority, dwell)) in enumerate(RULES.items()):
        rule = parse_rule(f"{name} < 0.3 -> stop; release > 0.5 for 0.2 s")
        made.append(
            Reflex(
                name,
                rule.names,
                rule.trigger,
                commanded(number),
                rule.release,
                release_after=rule.release_after,
                priority=priority,
                dwell=dwell,
            )
        )
    return made


steps = st.one_of(
    st.tuples(st.just("sense"), st.sampled_from(SENSORS), st.sampled_from([0.1, 0.4, 0.6, float("nan")])),
    st.tuples(st.just("wait"), st.floats(0.0, 0.6)),
    st.tuples(st.just("read"), st.integers(0, 2)),
    st.tuples(st.just("submit"), st.integers(0, 2)),
    st.tuples(st.just("check")),
)


@dataclass
class Run:
    """A gate, three deliberating threads, each with the epoch that it has read, and all that was sent."""

    clock: SimulationClock = field(default_factory=SimulationClock)
    sent: list[Command] = field(default_factory=list)
    events: list[object] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.gate = CommandGate(
            self.sent.append,
            self.clock,
            [SensorLimits(name) for name in SENSORS],
            reflexes(),
            safe_command=SAFE,
            watchdog=Watchdog(2.0, SAFE),
            on_event=self.events.append,
        )
        self.read = [(0, 0), (0, 0), (0, 0)]  # epoch, how many preemptions there had been

    def preemptions(self) -> int:
        return sum(isinstance(event, Preempted) for event in self.events)

    def take(self, step: tuple[object, ...]) -> None:
        match step:
            case ("sense", str(name), float(value)):
                self.gate.sense({name: value})
                if value < 0.3:
                    self.expect_reflex(name)
            case ("wait", float(seconds)):
                self.clock.advance_to(self.clock.now() + seconds)
            case ("read", int(thread)):
                self.read[thread] = (self.gate.epoch, self.preemptions())
            case ("submit", int(thread)):
                self.submit(thread)
            case _:
                self.gate.check()

    def expect_reflex(self, name: str) -> None:
        """It has the command in the very call, or one that is at least as urgent has."""
        latched = self.gate.latched()
        assert name in latched
        assert self.gate.holder == latched[0]
        assert max(latched, key=lambda one: RULES[one][0]) == latched[0]
        assert self.sent[-1]["by"] == list(RULES).index(latched[0])

    def submit(self, thread: int) -> None:
        epoch, preempted = self.read[thread]
        before = len(self.sent)
        answer = self.gate.submit({"v": 1.0, "by": 10.0 + thread}, epoch)
        if self.preemptions() > preempted or self.gate.latched():
            assert answer in (Answer.STALE, Answer.PREEMPTED)
        if answer is not Answer.ACCEPTED:
            assert all(command["by"] < 10.0 for command in self.sent[before:])


@given(st.lists(steps, max_size=60))
def test_no_stale_command_no_lost_reflex_and_every_latch_ends(schedule: list[tuple[object, ...]]) -> None:
    run = Run()
    for step in schedule:
        run.take(step)
    calm = dict.fromkeys(SENSORS, 0.9)
    for _ in range(5):
        run.gate.sense(calm)
        run.clock.advance_to(run.clock.now() + 0.15)
    run.gate.sense(calm)
    assert run.gate.latched() == ()
    run.gate.submit({"v": 0.0, "by": 10.0}, run.gate.epoch)
    assert run.gate.holder is None
    assert run.gate.submit({"v": 1.0, "by": 10.0}, run.gate.epoch) is Answer.ACCEPTED
