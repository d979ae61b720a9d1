"""Sixteen sonars around the robot: where they look, and what their echoes say, with noise and dropouts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from pioneer_example.world.arena import RADIUS

_DEGREES = (90, 50, 30, 10, -10, -30, -50, -90, -90, -130, -150, -170, 170, 150, 130, 90)
SONARS = tuple(math.radians(angle) for angle in _DEGREES)
"""Where each sonar looks, rad from ahead; eight to the front and eight to the rear, as on a P3DX."""
CONE = math.radians(9.0)
"""Half of the width of an echo's cone, rad: each sonar hears the nearest of three rays."""
MOUNT = 0.20
"""Distance of the sonars from the robot's middle, m."""
REACH = 5.0
"""The longest range, m."""
RAYS = tuple(angle + offset for angle in SONARS for offset in (-CONE, 0.0, CONE))


def heard(rays: Sequence[float]) -> list[float]:
    """What each sonar hears of its three rays, m."""
    return [min(*rays[first : first + 3], REACH) for first in range(0, len(rays), 3)]


@dataclass(frozen=True, slots=True)
class Noise:
    """What is wrong with measured ranges.

    Attributes:
        spread: standard deviation, m.
        dropouts: the share of samples that do not come.
    """

    spread: float
    dropouts: float

    def measure(self, ranges: Sequence[float], rng: np.random.Generator) -> list[float | None]:
        """The samples of all sonars; None where none came."""
        errors, lost = rng.normal(0.0, self.spread, len(ranges)), rng.random(len(ranges)) < self.dropouts
        return [
            None if gone else max(true + float(error), 0.0)
            for true, error, gone in zip(ranges, errors, lost, strict=True)
        ]


def free_ahead(samples: Sequence[float | None], margin: float = 0.08) -> float | None:
    """How far the robot could drive straight on, m; ``margin`` is kept free beside it. None without any sample."""
    nearest: float | None = None
    for angle, sample in zip(SONARS, samples, strict=True):
        if sample is None or abs(angle) > math.pi / 2.0 - 0.01:
            continue
        distance = sample + MOUNT
        # The echo may come from anywhere in the cone, so also from its inner edge.
        aside = min(abs(distance * math.sin(angle + offset)) for offset in (-CONE, 0.0, CONE))
        free = REACH if aside > RADIUS + margin else distance * math.cos(angle) - RADIUS
        nearest = free if nearest is None else min(nearest, free)
    return nearest


def nearest_in(samples: Sequence[float | None], lowest: float, highest: float, *, behind: bool = False) -> float | None:
    """The shortest range of the sonars that look between two angles, m.

    Args:
        samples: of all sonars, m.
        lowest: rad.
        highest: rad.
        behind: the angles are meant to both sides.

    Returns:
        None without any sample.
    """
    several = [
        sample
        for angle, sample in zip(SONARS, samples, strict=True)
        if sample is not None and lowest <= (abs(angle) if behind else angle) <= highest
    ]
    return min(several, default=None)
