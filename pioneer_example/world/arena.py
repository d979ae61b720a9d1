"""The arena of a run: walls, a box that the planner does not know, and where the two robots start."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from pioneer_example.world.geometry import Pose, Rectangle

RADIUS = 0.23
"""Of both robots, m: a Pioneer P3DX is 0.455 m long and 0.381 m wide."""
AXLE = 0.33
"""Distance of the wheels, m."""
WHEEL = 0.0975
"""Radius of a wheel, m."""
ACCELERATION = 1.5
"""How fast a wheel's speed can change, m/s2."""
PIONEER, EXPLORER = "pioneer", "explorer"

_LEFT, _RIGHT, _BOTTOM, _TOP = -1.4, 3.0, -1.4, 3.2
_THICK = 0.05


@dataclass(frozen=True, slots=True)
class Arena:
    """What there is, and where it starts.

    Attributes:
        walls: they stand still.
        box: so does this.
        starts: the pose of each robot.
    """

    walls: tuple[Rectangle, ...]
    box: Rectangle
    starts: dict[str, Pose]

    @property
    def obstacles(self) -> tuple[Rectangle, ...]:
        """All that stands still."""
        return (*self.walls, self.box)


def draw_arena(rng: np.random.Generator) -> Arena:
    """The arena of one run; starts and the box's place are left to chance, within reason."""
    width, height = (_RIGHT - _LEFT) / 2.0, (_TOP - _BOTTOM) / 2.0
    middle_x, middle_y = (_LEFT + _RIGHT) / 2.0, (_BOTTOM + _TOP) / 2.0
    walls = (
        Rectangle(middle_x, _TOP, width, _THICK),
        Rectangle(middle_x, _BOTTOM, width, _THICK),
        Rectangle(_LEFT, middle_y, _THICK, height),
        Rectangle(_RIGHT, middle_y, _THICK, height),
        Rectangle(_LEFT + 0.2, 1.3, 0.2, _THICK),
        Rectangle(_RIGHT - 0.45, 1.5, 0.45, _THICK),
    )
    x, y = 1.5 + rng.uniform(-0.35, 0.35), 2.5 + rng.uniform(-0.15, 0.2)
    part = rng.uniform(0.4, 0.65)
    box = Rectangle(
        part * x + rng.uniform(-0.25, 0.25), part * y + rng.uniform(-0.15, 0.15), rng.uniform(0.15, 0.25), 0.2
    )
    starts = {
        PIONEER: (x, y, rng.uniform(-math.pi, math.pi)),
        EXPLORER: (1.6 + rng.uniform(-0.5, 0.5), -0.6 + rng.uniform(-0.3, 0.3), rng.uniform(-math.pi, math.pi)),
    }
    return Arena(walls, box, starts)
