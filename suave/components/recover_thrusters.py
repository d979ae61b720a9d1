"""Recovers failed thrusters."""

from __future__ import annotations

from collections.abc import Callable

from rosa_core.clock import SimulationClock, Timer
from rosa_simulation.lifecycle_node import LifecycleNode, Observer
from suave.world.parameters import WorldParameters
from suave.world.vehicle import Vehicle


class RecoverThrusters(LifecycleNode):
    """Ten seconds after its activation it recovers one failed thruster after the other, as long as there are any.

    Args:
        clock: of the simulation.
        parameters: how long calls and recoveries take.
        observer: called when the node changes.
        vehicle: with the thrusters.
        recover: called with the number (1 to 6) of each, so that it is announced.
    """

    name = "f_maintain_motion_node"

    def __init__(
        self,
        clock: SimulationClock,
        parameters: WorldParameters,
        observer: Observer,
        vehicle: Vehicle,
        recover: Callable[[int], None],
    ) -> None:
        super().__init__(clock, parameters.service_time, observer)
        self._world = parameters
        self._vehicle = vehicle
        self._recover = recover
        self._next: Timer | None = None

    def on_activate(self) -> None:
        """Begin to recover."""
        self._schedule(self._world.recovery_time)

    def thruster_failed(self) -> None:
        """Begin anew if another thruster fails when all the others are recovered."""
        if self.active and self._next is None:
            self._schedule(self._world.recovery_time)

    def _schedule(self, delay: float) -> None:
        if self._next is not None:
            self._next.cancel()
        self._next = self.clock.call_later(delay, self._recover_one)

    def _recover_one(self) -> None:
        self._next = None
        failed = self._vehicle.failed_thrusters() if self.active else []
        if len(failed) > 1:
            self._schedule(self._world.recovery_interval)
        if failed:
            self._recover(failed[0])
