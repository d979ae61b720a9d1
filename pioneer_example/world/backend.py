"""The port to what simulates the arena; the program that drives the robot is the same on all of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from pioneer_example.world.arena import ACCELERATION
from pioneer_example.world.geometry import Pose

Wheels = tuple[float, float]
"""Speeds of the left and the right wheel on the ground, m/s."""


class Backend(Protocol):
    """Two robots in an arena."""

    def step(self, seconds: float, commands: Mapping[str, Wheels]) -> None:
        """Let time pass; each robot drives as it is commanded, as fast as its wheels can follow."""
        ...

    def pose(self, robot: str) -> Pose:
        """Where a robot is."""
        ...

    def ranges(self, robot: str) -> list[float]:
        """What each sonar of a robot would hear without noise, m."""
        ...

    def touches(self, robot: str) -> bool:
        """Whether a robot touches anything but the floor."""
        ...


def ramped(wheels: Wheels, command: Wheels, seconds: float) -> Wheels:
    """The wheels' speeds after a time, on their way to those that are commanded."""
    step = ACCELERATION * seconds
    left, right = (min(max(c, w - step), w + step) for w, c in zip(wheels, command, strict=True))
    return left, right
