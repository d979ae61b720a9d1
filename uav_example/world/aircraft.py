"""The aircraft's body: where it is, its battery and its gripper."""

from __future__ import annotations

import math
from dataclasses import dataclass

Vector = tuple[float, float, float]


class Aircraft:
    """A point that flies straight to its target at constant speed, or hovers. Positions are (x, y, z) in m.

    Args:
        position: where it starts.
        speed: horizontally, m/s.
        climb_speed: vertically, m/s.
    """

    def __init__(self, position: Vector, speed: float, climb_speed: float) -> None:
        self.position = position
        self.target: Vector | None = None
        self._speed = speed
        self._climb_speed = climb_speed

    @property
    def landed(self) -> bool:
        """Whether it is on the ground."""
        return self.position[2] <= 0.0

    @property
    def at_target(self) -> bool:
        """Whether it is where it was sent."""
        return self.target is not None and math.dist(self.position, self.target) < 1e-6

    def step(self, seconds: float) -> None:
        """Fly on for so long."""
        if self.target is None:
            return
        (x, y, z), (tx, ty, tz) = self.position, self.target
        gap = math.dist((x, y), (tx, ty))
        share = min(1.0, self._speed * seconds / gap) if gap else 1.0
        climb = self._climb_speed * seconds
        self.position = (
            tx if share == 1.0 else x + share * (tx - x),
            ty if share == 1.0 else y + share * (ty - y),
            tz if abs(tz - z) <= climb else z + math.copysign(climb, tz - z),
        )


@dataclass(slots=True)
class Battery:
    """A charge from 1 (full) to 0 (empty).

    Attributes:
        level: the charge now.
        used: what has been taken from it.
    """

    level: float
    used: float = 0.0

    @property
    def full(self) -> bool:
        """Whether nothing more goes in."""
        return self.level >= 1.0

    def drain(self, charge: float) -> None:
        """Take so much from it, or what is left."""
        taken = min(charge, self.level)
        self.level -= taken
        self.used += taken

    def charge(self, charge: float) -> None:
        """Put so much into it."""
        self.level = min(1.0, self.level + charge)


@dataclass(slots=True)
class Gripper:
    """A gripper that fails after a time of use.

    Attributes:
        life: time of use that is left until it fails, s.
        folded: whether it is folded under the body; unfolded it is in the infra-red camera's way.
    """

    life: float
    folded: bool = True

    @property
    def works(self) -> bool:
        """Whether it has not failed yet."""
        return self.life > 0.0

    def use(self, seconds: float) -> None:
        """Work for so long."""
        self.life -= seconds
