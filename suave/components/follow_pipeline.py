"""Follows the pipeline and inspects it."""

from __future__ import annotations

import math
from collections.abc import Callable

from rosa_core.clock import SimulationClock
from rosa_simulation.lifecycle_node import LifecycleNode, Observer
from suave.world.environment import inspection_path
from suave.world.vehicle import Vehicle

_HEIGHT = -18.75
_REACHED = 0.5
_POLL_PERIOD = 2.0


class FollowPipeline(LifecycleNode):
    """Flies from point to point along the pipeline and back, and goes on where it was when it was interrupted.

    Every 2 s it looks whether the present point is reached (x, y and z each within 0.5 m); points that are reached
    already are passed over together.

    Attributes:
        distance: length of pipeline inspected since the node was last activated, m (the exemplar's metric).
        total_distance: the same over the whole mission, m.
        done: whether the whole path was followed.
    """

    name = "f_follow_pipeline_node"

    def __init__(
        self,
        clock: SimulationClock,
        service_time: float,
        observer: Observer,
        vehicle: Vehicle,
        on_done: Callable[[], None],
    ) -> None:
        super().__init__(clock, service_time, observer)
        self._vehicle = vehicle
        self._path = inspection_path()
        self._index = 0
        self._on_done = on_done
        self._stint_began = 0
        self.distance = 0.0
        self.total_distance = 0.0

    @property
    def done(self) -> bool:
        """Whether the whole path was followed."""
        return self._index >= len(self._path)

    def on_activate(self) -> None:
        """Fly to the point that is due."""
        self.distance = 0.0
        self._stint_began = self._index
        self._aim()
        self.every(_POLL_PERIOD, self._advance)

    def _aim(self) -> None:
        if not self.done:
            x, y = self._path[self._index]
            self._vehicle.target = (x, y, _HEIGHT)

    def _advance(self) -> None:
        before = self._index
        while not self.done and self._reached():
            if self._index > self._stint_began:
                gap = math.dist(self._path[self._index - 1], self._path[self._index])
                self.distance += gap
                self.total_distance += gap
            self._index += 1
        if self._index != before:
            self._aim()
            if self.done:
                self._on_done()

    def _reached(self) -> bool:
        point = (*self._path[self._index], _HEIGHT)
        return all(abs(p - e) <= _REACHED for p, e in zip(point, self._vehicle.estimate, strict=True))
