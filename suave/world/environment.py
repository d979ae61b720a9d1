"""The pipeline, the water, and the battery."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from suave.world.vehicle import Vector

SEA_BED = -20.0
PIPELINE: tuple[tuple[float, float], ...] = (
    (-51.56, -15.14),
    (-44.49, -8.07),
    (-37.41, -1.0),
    (-35.0, 0.0),
    (-25.0, 0.0),
    (-15.0, 0.0),
)
"""The corners of the pipeline, (x, y) in m, on the sea bed."""
DETECTION_HEIGHT = -19.25
"""The z from which heights above the pipeline are reckoned."""
FIELD_OF_VIEW = math.tan(math.radians(30.0))
"""Half the width that is seen, per metre of height."""
RECHARGE_STATION: Vector = (-3.0, -2.0, -19.5)
_POINTS_PER_LEG = 20


def sample_pipeline() -> list[tuple[float, float]]:
    """The pipeline as points, (x, y) in m, from its far end at x = -51.56 to x = -15.

    Each leg has 20, both its ends among them, so that the corners come twice.
    """
    shares = [n / (_POINTS_PER_LEG - 1) for n in range(_POINTS_PER_LEG)]
    return [(x0 + s * (x1 - x0), y0 + s * (y1 - y0)) for (x0, y0), (x1, y1) in pairwise(PIPELINE) for s in shares]


def inspection_path() -> list[tuple[float, float]]:
    """The points to follow: along the pipeline from x = -15 and the whole way back."""
    there = sample_pipeline()[::-1]
    return there + there[-2::-1]


class PipelineDetector:
    """Sees the pipeline when a point of it is below the vehicle, close enough for the water's visibility."""

    def __init__(self) -> None:
        points = np.asarray(sample_pipeline())
        self._x, self._y = points[:, 0].copy(), points[:, 1].copy()

    def sees(self, position: Vector, visibility: float) -> bool:
        """Whether the pipeline can be seen.

        Args:
            position: of the vehicle, (x, y, z) in m.
            visibility: of the water, m.
        """
        x, y, z = position
        height = abs(z - DETECTION_HEIGHT)
        if height > visibility:
            return False
        reach = height * FIELD_OF_VIEW
        return bool(np.any((np.abs(self._x - x) <= reach) & (np.abs(self._y - y) <= reach)))


class WaterVisibility:
    """How far one sees (m): a cosine between its extremes, in steps of whole seconds since the mission began.

    Args:
        low: the worst visibility, m.
        high: the best visibility, m.
        period: of the cosine, s.
        shift: added to the mission's time, s; with none the mission begins at the best visibility.

    Example:
        >>> visibility = WaterVisibility(low=1.25, high=3.75, period=80.0, shift=0.0)
        >>> visibility.at(0.0), visibility.at(40.5)
        (3.75, 1.25)
    """

    def __init__(self, low: float, high: float, period: float, shift: float) -> None:
        self._middle, self._amplitude = (low + high) / 2.0, (high - low) / 2.0
        self._period, self._shift = period, shift

    def at(self, mission_time: float) -> float:
        """The visibility in m, ``mission_time`` seconds after the mission began."""
        seconds = math.floor(mission_time + 1e-9) + self._shift
        return self._middle + self._amplitude * math.cos(2.0 * math.pi * seconds / self._period)


class Battery:
    """Discharges linearly from full to empty.

    Args:
        discharge_time: how long that takes, s.
        since: when it is full, s.

    Attributes:
        charges: how often it was recharged.

    Example:
        >>> battery = Battery(discharge_time=200.0, since=0.0)
        >>> battery.level(50.0)
        0.75
        >>> battery.recharge(50.0)
        >>> battery.level(50.0), battery.charges
        (1.0, 1)
    """

    def __init__(self, discharge_time: float, since: float) -> None:
        self._discharge_time = discharge_time
        self._since = since
        self.charges = 0
        """How often it was recharged."""

    def level(self, now: float) -> float:
        """The charge, from 1 (full) to 0 (empty), at a time in seconds."""
        return max(0.0, 1.0 - (now - self._since) / self._discharge_time)

    def recharge(self, now: float) -> None:
        """Full again, at once."""
        self._since = now
        self.charges += 1
