"""Every short sequence of samples, commands and time at a gate with two reflexes, against a naive reading of it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import pytest

from rosa_core import SimulationClock
from rosa_reflexes import Answer, Command, CommandGate, GateEvent, HandedBack, Preempted, SensorLimits
from tests.rosa_reflexes.test_gate import GO, STOP, TURN, reflex

LOW, HIGH = 0.1, 1.0


class World:
    """A gate, a planner that may be late, and a naive reading of what the gate must do.

    The reflex ``turn`` (priority 1) fires on ``left < 0.5`` and is released as soon as that does not hold; ``stop``
    (priority 2) fires on ``front < 0.5`` and is released when ``front > 0.6`` has held for a second.
    """

    def __init__(self) -> None:
        self.clock = SimulationClock()
        self.sent: list[Command] = []
        self.events: list[GateEvent] = []
        reflexes = (
            reflex("turn", "left < 0.5 -> turn", TURN, priority=1.0),
            reflex("stop", "front < 0.5 -> stop; release > 0.6 for 1 s", STOP, priority=2.0),
        )
        self.gate = CommandGate(
            self.sent.append,
            self.clock,
            (SensorLimits("front"), SensorLimits("left")),
            reflexes,
            safe_command=STOP,
            on_event=self.events.append,
        )
        self.read_epoch = self.gate.epoch
        self.turn_fired = self.stop_fired = False
        self.front_clear_since: float | None = None
        self.changes_since_read = 0
        self.holder: str | None = None

    def front(self, value: float) -> None:
        self.gate.sense({"front": value})
        if value == LOW:
            self.stop_fired, self.front_clear_since = True, None
        elif self.stop_fired and self.front_clear_since is None:
            self.front_clear_since = self.clock.now()
        self._expect_release()

    def left(self, value: float) -> None:
        self.gate.sense({"left": value})
        self.turn_fired = value == LOW
        self._expect()

    def time(self) -> None:
        self.clock.advance_to(self.clock.now() + 0.6)
        self.gate.check()
        self._expect_release()

    def read(self) -> None:
        self.read_epoch = self.gate.epoch
        self.changes_since_read = 0

    def submit(self) -> None:
        sent = len(self.sent)
        answer = self.gate.submit(GO, self.read_epoch)
        if self.changes_since_read:
            assert answer is Answer.STALE
        elif self.holder is not None:
            assert answer is Answer.PREEMPTED
        else:
            assert answer is Answer.ACCEPTED
        assert self.sent[sent:] == ([GO] if answer is Answer.ACCEPTED else [])

    def _expect_release(self) -> None:
        clear = self.front_clear_since
        # As the gate does: by the sample or the look at which the second is over.
        if self.stop_fired and clear is not None and self.clock.now() - clear >= 1.0:
            self.stop_fired = False
        self._expect()

    def _expect(self) -> None:
        holder = "stop" if self.stop_fired else "turn" if self.turn_fired else None
        if holder != self.holder:
            self.changes_since_read += 1
            last = self.events[-1]
            assert isinstance(last, HandedBack if holder is None else Preempted)
            if holder is not None:
                assert self.sent[-1] == (STOP if holder == "stop" else TURN)
        self.holder = holder
        assert self.gate.holder == holder


STEPS: tuple[Callable[[World], None], ...] = (
    lambda world: world.front(LOW),
    lambda world: world.front(HIGH),
    lambda world: world.left(LOW),
    lambda world: world.left(HIGH),
    World.time,
    World.read,
    World.submit,
)


@pytest.mark.parametrize("first", range(len(STEPS)))
def test_every_sequence_of_five_steps(first: int) -> None:
    for rest in product(STEPS, repeat=4):
        world = World()
        for step in (STEPS[first], *rest):
            step(world)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(len(STEPS)))
def test_every_sequence_of_seven_steps(first: int) -> None:
    for rest in product(STEPS, repeat=6):
        world = World()
        for step in (STEPS[first], *rest):
            step(world)
