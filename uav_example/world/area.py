"""The area to be searched, and what lies in it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from uav_example.world.parameters import WorldParameters

_POINT_SPACING = 10.0
"""Between two points of a lane, m: a search that was interrupted leaves out less than this."""

if TYPE_CHECKING:
    import numpy as np


class Analysis(Enum):
    """How a sample was analysed."""

    PICKED_UP = "picked up"
    IN_SITU = "in situ"


@dataclass(frozen=True, slots=True)
class Sample:
    """A sample on the ground, at (x, y) in m; numbered from 1."""

    number: int
    x: float
    y: float


def scatter_samples(parameters: WorldParameters, rng: np.random.Generator) -> tuple[Sample, ...]:
    """Samples anywhere in the area, each with the same probability.

    Args:
        parameters: how many, and the area's width and depth in m.
        rng: the only source of chance.

    Returns:
        numbered from 1; (x, y) in m from the corner that is home.
    """
    places = rng.uniform((0.0, 0.0), (parameters.width, parameters.depth), (parameters.samples, 2))
    return tuple(Sample(number, float(x), float(y)) for number, (x, y) in enumerate(places, 1))


def search_path(parameters: WorldParameters) -> tuple[tuple[float, float], ...]:
    """The points (x, y) in m of lanes to and fro, spread evenly so that what lies between two is in sight.

    Example:
        >>> from uav_example.world.parameters import WorldParameters
        >>> search_path(WorldParameters(width=10.0, depth=20.0, lane_spacing=10.0))
        ((0.0, 5.0), (10.0, 5.0), (10.0, 15.0), (0.0, 15.0))
    """
    lanes = max(1, round(parameters.depth / parameters.lane_spacing))
    points = max(2, round(parameters.width / _POINT_SPACING) + 1)
    xs = [parameters.width * n / (points - 1) for n in range(points)]
    ys = [parameters.depth * (lane + 0.5) / lanes for lane in range(lanes)]
    return tuple((x, y) for lane, y in enumerate(ys) for x in (xs if lane % 2 == 0 else xs[::-1]))
