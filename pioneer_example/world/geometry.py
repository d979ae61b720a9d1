"""Plane geometry: rectangles and circles, distances between them, and rays. Lengths in m, angles in rad."""

from __future__ import annotations

import math
from dataclasses import dataclass

Pose = tuple[float, float, float]
"""x, y, heading."""


@dataclass(frozen=True, slots=True)
class Rectangle:
    """A rectangle along the axes, by its middle and half of its sides."""

    x: float
    y: float
    half_x: float
    half_y: float

    def distance(self, x: float, y: float) -> float:
        """From a point to its edge; 0 inside."""
        return math.hypot(max(abs(x - self.x) - self.half_x, 0.0), max(abs(y - self.y) - self.half_y, 0.0))

    def ray(self, x: float, y: float, cos: float, sin: float) -> float:
        """How far it is along a ray to it; infinite if it is not met."""
        near, far = -math.inf, math.inf
        for at, middle, half, along in ((x, self.x, self.half_x, cos), (y, self.y, self.half_y, sin)):
            if abs(along) < 1e-12:
                if abs(at - middle) > half:
                    return math.inf
                continue
            ends = sorted(((middle - half - at) / along, (middle + half - at) / along))
            near, far = max(near, ends[0]), min(far, ends[1])
        return near if 0.0 <= near <= far else math.inf


@dataclass(frozen=True, slots=True)
class Circle:
    """A circle."""

    x: float
    y: float
    radius: float

    def distance(self, x: float, y: float) -> float:
        """From a point to its edge; 0 inside."""
        return max(math.hypot(x - self.x, y - self.y) - self.radius, 0.0)

    def ray(self, x: float, y: float, cos: float, sin: float) -> float:
        """How far it is along a ray to it; infinite if it is not met."""
        dx, dy = self.x - x, self.y - y
        along = dx * cos + dy * sin
        beside = dx * dx + dy * dy - along * along
        if along < 0.0 or beside > self.radius**2:
            return math.inf
        return max(along - math.sqrt(self.radius**2 - beside), 0.0)


def wrapped(angle: float) -> float:
    """The angle from -pi to pi.

    >>> round(wrapped(1.5 * math.pi) / math.pi, 3)
    -0.5
    """
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def bearing(pose: Pose, x: float, y: float) -> float:
    """The direction of a point from a robot, 0 ahead and positive to the left."""
    return wrapped(math.atan2(y - pose[1], x - pose[0]) - pose[2])
