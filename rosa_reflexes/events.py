"""What a command gate reports."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from rosa_reflexes.commands import Command
from rosa_reflexes.sensors import Fault


class Answer(StrEnum):
    """What becomes of a command of deliberation."""

    ACCEPTED = "accepted"
    STALE = "stale"
    """It was decided on before a reflex fired, or before that one handed the command back."""
    PREEMPTED = "preempted"
    """A reflex holds the command."""
    INVALID = "invalid"
    """A value is not a finite number."""


@dataclass(frozen=True, slots=True)
class GateEvent:
    """Something happened at a gate, at a time in s; ``epoch`` is the one after it."""

    time: float
    epoch: int


@dataclass(frozen=True, slots=True)
class Preempted(GateEvent):
    """A reflex took the command, from deliberation or from another reflex."""

    reflex: str
    command: Command
    reason: str
    from_reflex: str | None = None


@dataclass(frozen=True, slots=True)
class HandedBack(GateEvent):
    """The last reflex was released: deliberation has the command again."""

    reflex: str
    held_s: float


@dataclass(frozen=True, slots=True)
class Refused(GateEvent):
    """A command of deliberation was refused."""

    answer: Answer


@dataclass(frozen=True, slots=True)
class SensorFaultChanged(GateEvent):
    """A sensor has become faulty, or (None) works again."""

    sensor: str
    fault: Fault | None


@dataclass(frozen=True, slots=True)
class ReflexRaised(GateEvent):
    """A reflex raised: it counts as fired, with the gate's safe command."""

    reflex: str
    error: str
