"""The nodes of the robot: two that measure ranges, and the drive."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from pioneer_example.models import DRIVE
from pioneer_example.world.arena import ACCELERATION
from pioneer_example.world.sonar_ring import Noise
from rosa_core.clock import SimulationClock
from rosa_simulation.lifecycle_node import LifecycleNode, Observer

SERVICE_TIME = 0.05
SONAR_PERIOD, LIDAR_PERIOD = 0.05, 0.2
LIDAR_NOISE = Noise(0.003, 0.0)
_MARGIN = 0.2
_ACTUATION = 0.04

Samples = Sequence[float | None]


class Ranging(Protocol):
    """What a node that measures ranges needs of its robot."""

    def true_ranges(self) -> list[float]:
        """What it would measure without noise, m."""
        ...

    def scanned(self, samples: Samples) -> None:
        """The samples of one scan."""
        ...


class RangeNode(LifecycleNode):
    """Measures ranges all around, periodically.

    Args:
        name: the component's.
        clock: simulated time.
        observer: called after every change.
        robot: whose ranges they are.
        period: s between two scans.
        noise: what is wrong with them.
        rng: where noise is drawn from.

    Attributes:
        fault: ``silent``, ``stuck``, ``nan``, or empty while it works.
    """

    def __init__(
        self,
        name: str,
        clock: SimulationClock,
        observer: Observer,
        robot: Ranging,
        *,
        period: float,
        noise: Noise,
        rng: np.random.Generator,
    ) -> None:
        self.name = name
        super().__init__(clock, SERVICE_TIME, observer)
        self.period, self.fault = period, ""
        self._robot, self._noise, self._rng = robot, noise, rng
        self._last: Samples = ()

    def on_activate(self) -> None:
        """Scan at once, and then periodically."""
        self.every(self.period, self._scan, start=self.clock.now())

    def _scan(self) -> None:
        if self.fault == "silent":
            return
        if self.fault == "nan":
            self._robot.scanned([math.nan] * len(self._last))
            return
        if self.fault != "stuck" or not self._last:
            self._last = self._noise.measure(self._robot.true_ranges(), self._rng)
        self._robot.scanned(self._last)


class DriveNode(LifecycleNode):
    """Drives at its parameter ``speed``, m/s, while it is active.

    Args:
        clock: simulated time.
        observer: called after every change.
        speed: at first.
        changed: called when the speed has changed.
    """

    name = DRIVE

    def __init__(self, clock: SimulationClock, observer: Observer, speed: float, changed: Callable[[], None]) -> None:
        super().__init__(clock, SERVICE_TIME, observer)
        self.parameters["speed"] = speed
        self._changed = changed

    def on_parameters(self) -> None:
        """The robot's limits follow."""
        self._changed()


def stopping_distance(speed: float, period: float) -> float:
    """The free distance at which the robot must brake, m: until the next scan, until the command works, and braking.

    Args:
        speed: m/s.
        period: s between two scans.

    >>> round(stopping_distance(0.4, 0.05), 3), round(stopping_distance(0.2, 0.2), 3)
    (0.289, 0.261)
    """
    return speed * (period + _ACTUATION) + speed**2 / (2.0 * ACCELERATION) + _MARGIN
