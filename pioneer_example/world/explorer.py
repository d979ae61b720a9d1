"""The second robot: it explores, and knows nothing of frameworks."""

from __future__ import annotations

import numpy as np

from pioneer_example.world.backend import Wheels
from pioneer_example.world.sonar_ring import Noise, free_ahead

_NOISE = Noise(0.01, 0.02)
_NEAR, _FREE = 0.4, 0.7


class Explorer:
    """Drives straight on until something is near, then turns until it is not.

    Args:
        speed: m/s.
        rng: where noise and directions are drawn from.
    """

    def __init__(self, speed: float, rng: np.random.Generator) -> None:
        self._speed, self._rng = speed, rng
        self._turn = 0.0

    def command(self, ranges: list[float]) -> Wheels:
        """What it does now, of what its sonars hear."""
        free = free_ahead(_NOISE.measure(ranges, self._rng)) or 0.0
        if self._turn == 0.0 and free < _NEAR:
            self._turn = 0.12 if self._rng.random() < 0.5 else -0.12
        elif free > _FREE:
            self._turn = 0.0
        return (-self._turn, self._turn) if self._turn else (self._speed, self._speed)
