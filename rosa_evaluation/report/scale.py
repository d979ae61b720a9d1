"""Values to pixels, and round values for the ticks of an axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Scale:
    """Values to pixels, linearly or by their logarithm."""

    low: float
    high: float
    start: float
    end: float
    logarithmic: bool = False

    @classmethod
    def over(cls, values: Sequence[float], start: float, end: float) -> Scale:
        """Linear, with 0 in it and round ends.

        Args:
            values: at least one.
            start: where the lower end lies, px.
            end: where the upper end lies, px.

        Example:
            >>> scale = Scale.over([3.0, 17.0], 0.0, 100.0)
            >>> scale.ticks(), scale(10.0)
            ([0.0, 5.0, 10.0, 15.0, 20.0], 50.0)
        """
        low, high = min(0.0, *values), max(0.0, *values)
        step = _step(high - low or 1.0)
        if low == high:
            return cls(0.0, step, start, end)
        return cls(math.floor(low / step) * step, math.ceil(high / step - 1e-9) * step, start, end)

    @classmethod
    def over_decades(cls, values: Sequence[float], start: float, end: float) -> Scale:
        """Logarithmic, in whole decades around the values.

        Args:
            values: at least one, all positive.
            start: where the lower end lies, px.
            end: where the upper end lies, px.

        Example:
            >>> scale = Scale.over_decades([0.02, 3.0], 0.0, 300.0)
            >>> [round(scale(value)) for value in (0.01, 0.1, 10.0)]
            [0, 100, 300]
        """
        low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)) + 1e-9)
        return cls(10.0**low, 10.0 ** max(high, low + 1), start, end, logarithmic=True)

    def __call__(self, value: float) -> float:
        """Where a value lies; at an end, if it is beyond it."""
        inside = min(max(value, self.low), self.high)
        if self.logarithmic:
            share = math.log(inside / self.low) / math.log(self.high / self.low)
        else:
            share = (inside - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)

    def ticks(self) -> list[float]:
        """Round values, for the labels of the axis."""
        if self.logarithmic:
            decades = round(math.log10(self.high / self.low))
            return [self.low * 10.0**power for power in range(decades + 1)]
        step = _step(self.high - self.low)
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        return [number * step for number in range(first, last + 1)]


def _step(span: float) -> float:
    """A round distance between ticks, of which there are then five to ten."""
    power = 10.0 ** math.floor(math.log10(span / 5.0))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if span / (factor * power) <= 8.0)
