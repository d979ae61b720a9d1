"""Searches in a growing spiral, at the altitude that its parameter says."""

from __future__ import annotations

import math
from typing import cast

from rosa_core.clock import SimulationClock
from rosa_simulation.lifecycle_node import LifecycleNode, Observer
from suave.world.environment import FIELD_OF_VIEW, SEA_BED
from suave.world.vehicle import Vehicle

_STEP = 0.1
"""The angle between two setpoints, rad."""
_REACHED = 0.4
"""A setpoint is reached when x, y and z are each within this, m."""
_MOST_MISSES = 10


class SpiralSearch(LifecycleNode):
    """Sends a setpoint a second at best, each 0.1 rad further on a spiral round the start.

    A revolution widens the spiral by what is seen at the present altitude. Parameter ``spiral_altitude``: height
    above the sea bed, m. A search that was interrupted goes on where it was.

    Args:
        clock: of the simulation.
        service_time: how long a call of the node takes, s.
        observer: called when the node changes.
        vehicle: that searches; the spiral is round where it is now.
        start: seconds; setpoints are sent from then on.
    """

    name = "f_generate_search_path_node"

    def __init__(
        self, clock: SimulationClock, service_time: float, observer: Observer, vehicle: Vehicle, start: float
    ) -> None:
        super().__init__(clock, service_time, observer)
        self.parameters = {"spiral_altitude": 1.0}
        self._vehicle = vehicle
        self._start = start
        self._centre = vehicle.position[:2]
        self._index = 0
        self._radius = 0.0
        self._misses = 0
        self._setpoint: tuple[float, float, float] | None = None

    @property
    def altitude(self) -> float:
        """Height of the search above the sea bed, m."""
        return cast(float, self.parameters["spiral_altitude"])

    def on_activate(self) -> None:
        """Send setpoints from the time at which the vehicle follows them."""
        self._setpoint = None
        self.every(1.0, self._next, start=max(self._start, self.clock.now()))

    def on_parameters(self) -> None:
        """A change of altitude moves the search one step on."""
        self._index += 1

    def _next(self) -> None:
        target, estimate = self._setpoint, self._vehicle.estimate
        if target is not None and any(abs(t - e) > _REACHED for t, e in zip(target, estimate, strict=True)):
            self._misses += 1
            if self._misses <= _MOST_MISSES:
                return
        else:
            self._index += 1
            width = 2.0 * self.altitude * FIELD_OF_VIEW
            self._radius += width * _STEP / (2.0 * math.pi)
        self._misses = 0
        angle = _STEP * self._index
        x, y = self._centre
        self._setpoint = self._vehicle.target = (
            x + self._radius * math.cos(angle),
            y + self._radius * math.sin(angle),
            SEA_BED + self.altitude,
        )
