"""Flies to the recharge station and recharges."""

from __future__ import annotations

from collections.abc import Callable

from rosa_core.clock import SimulationClock
from rosa_simulation.lifecycle_node import LifecycleNode, Observer
from suave.world.environment import RECHARGE_STATION
from suave.world.vehicle import Vehicle

_REACHED = 0.5
_POLL_PERIOD = 5.0


class RechargeBattery(LifecycleNode):
    """Looks every 5 s whether the station is reached (x, y and z each within 0.5 m), and then recharges.

    Args:
        clock: of the simulation.
        service_time: how long a call of the node takes, s.
        observer: called when the node changes.
        vehicle: sent to the station.
        recharge: called at every look at which it is there.
    """

    name = "generate_recharge_path_node"

    def __init__(
        self,
        clock: SimulationClock,
        service_time: float,
        observer: Observer,
        vehicle: Vehicle,
        recharge: Callable[[], None],
    ) -> None:
        super().__init__(clock, service_time, observer)
        self._vehicle = vehicle
        self._recharge = recharge

    def on_activate(self) -> None:
        """Fly to the station."""
        self._vehicle.target = RECHARGE_STATION
        self.every(_POLL_PERIOD, self._look)

    def _look(self) -> None:
        pairs = zip(RECHARGE_STATION, self._vehicle.estimate, strict=True)
        if all(abs(s - e) <= _REACHED for s, e in pairs):
            self._recharge()
