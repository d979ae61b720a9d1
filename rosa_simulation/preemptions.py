"""Joins a command gate to the task layer: skills hear that their command is taken and handed back; it is counted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from rosa_core.clock import SimulationClock
from rosa_reflexes import DELIBERATION_SILENT, GateEvent, HandedBack, Preempted, SensorFaultChanged
from rosa_simulation.narrator import Narrator

MINUTE = 60.0
OSCILLATION = 1.0
"""Two changes of hands within so many seconds count as an oscillation."""


class Preemptible(Protocol):
    """A skill whose command can be taken."""

    def preempted(self, event: Preempted) -> None:
        """A reflex has the command: pause."""
        ...

    def handed_back(self, event: HandedBack) -> None:
        """It is over: go on from where the robot is now, or give up."""
        ...


class Preemptions:
    """Observes a gate.

    Args:
        clock: simulated time.
        wake: lets the task layer look at once what is to be done; called when the command is handed back.

    Attributes:
        number: how often a reflex took the command from deliberation.
        switches: how often the command changed between deliberation and reflexes.
        oscillations: how many of them came within a second of the one before.
    """

    def __init__(self, clock: SimulationClock, wake: Callable[[], None]) -> None:
        self.number = self.switches = self.oscillations = 0
        self._clock, self._wake = clock, wake
        self._times: list[float] = []
        self._switched_at: float | None = None
        self._skills: list[Preemptible] = []

    def watch(self, skill: Preemptible) -> None:
        """This skill commands the actuators from now on."""
        self._skills.append(skill)

    def unwatch(self, skill: Preemptible) -> None:
        """It does so no longer."""
        self._skills = [other for other in self._skills if other is not skill]

    def per_minute(self) -> float:
        """How often the command was taken in the last minute."""
        since = self._clock.now() - MINUTE
        self._times = [time for time in self._times if time > since]
        return float(len(self._times))

    def on_gate_event(self, event: GateEvent) -> None:
        """For the gate's ``on_event``."""
        if isinstance(event, Preempted) and event.from_reflex is None:
            self.number += event.reflex != DELIBERATION_SILENT
            self._times.append(event.time)
            self._switch(event.time)
            for skill in tuple(self._skills):
                skill.preempted(event)
        elif isinstance(event, HandedBack):
            self._switch(event.time)
            for skill in tuple(self._skills):
                skill.handed_back(event)
            self._wake()

    def _switch(self, time: float) -> None:
        self.switches += 1
        self.oscillations += self._switched_at is not None and time - self._switched_at < OSCILLATION
        self._switched_at = time


def narrate_gate(narrator: Narrator, event: GateEvent) -> None:
    """Describe who takes the command and why, who hands it back, and which sensors are faulty."""
    if isinstance(event, Preempted):
        narrator.cause(f"'{event.reflex}' takes the command: {event.reason}")
        narrator.fact(
            "preempted",
            reflex=event.reflex,
            command=dict(event.command),
            reason=event.reason,
            from_reflex=event.from_reflex,
        )
    elif isinstance(event, HandedBack):
        narrator.cause(f"'{event.reflex}' hands the command back after {event.held_s:.2f} s")
        narrator.fact("handed back", reflex=event.reflex, held_s=round(event.held_s, 6))
    elif isinstance(event, SensorFaultChanged):
        narrator.cause(f"sensor {event.sensor} " + ("works again" if event.fault is None else f"is {event.fault}"))
        narrator.fact("sensor fault", sensor=event.sensor, fault=None if event.fault is None else event.fault.value)
