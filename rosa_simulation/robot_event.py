"""What happens to a robot, as its world reports it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class NodeChange(Enum):
    """What a lifecycle node reports of itself; the values are the words of run records."""

    ACTIVATED = "activated"
    DEACTIVATED = "deactivated"
    PARAMETERS = "parameters"


@dataclass(frozen=True, slots=True)
class RobotEvent:
    """Something that happened to a robot.

    Attributes:
        time: when, in s of the simulation's clock.
        kind: what happened: a :class:`NodeChange`, or a member of the robot's own enum, whose value is the word for it
            in run records.
        subject: what it happened to, such as a node's name or a thruster's number; empty if that is clear.
    """

    time: float
    kind: Enum
    subject: str = ""
