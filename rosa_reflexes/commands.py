"""Commands to actuators, and the bounds within which deliberation may command them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

Command = Mapping[str, float]
"""A value for each channel of the actuators, such as ``{"left_wheel": 0.2, "right_wheel": 0.2}`` in m/s."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """What a channel may be commanded, in the channel's own unit.

    Attributes:
        lowest: the least value.
        highest: the greatest value.
        rate: by how much the value may change in a second; a reflex is not held to it.

    Raises:
        ValueError: if there is no value within the bounds, or the rate is not positive.
    """

    lowest: float = -math.inf
    highest: float = math.inf
    rate: float = math.inf

    def __post_init__(self) -> None:
        if not self.lowest <= self.highest:
            raise ValueError(f"no value is at least {self.lowest} and at most {self.highest}")
        if not self.rate > 0:
            raise ValueError(f"a rate must be positive, not {self.rate}")

    def hold(self, value: float) -> float:
        """The nearest value within the bounds."""
        return min(max(value, self.lowest), self.highest)

    def approach(self, value: float, previous: float, seconds: float) -> float:
        """The nearest value within the bounds that can be had ``seconds`` after ``previous``."""
        step = self.rate * seconds
        return self.hold(min(max(value, previous - step), previous + step))


def is_finite(command: Command) -> bool:
    """Whether every value is a finite number."""
    return all(math.isfinite(value) for value in command.values())


def held(command: Command, bounds: Mapping[str, Bounds]) -> Command:
    """The command within the bounds of its channels."""
    if not bounds:
        return command
    return {name: bounds[name].hold(value) if name in bounds else value for name, value in command.items()}


def approached(command: Command, previous: Command, seconds: float, bounds: Mapping[str, Bounds]) -> Command:
    """The command within bounds and rates, ``seconds`` after the previous one.

    >>> approached({"v": 1.0}, {"v": 0.0}, 0.5, {"v": Bounds(highest=0.8, rate=1.0)})
    {'v': 0.5}
    """
    if not bounds:
        return command
    return {
        name: bounds[name].approach(value, previous.get(name, 0.0), seconds) if name in bounds else value
        for name, value in command.items()
    }
