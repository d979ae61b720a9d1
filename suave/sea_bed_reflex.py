"""The reflex that keeps the vehicle clear of the sea bed: it takes the depth setpoint from whatever node gives one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from rosa_core.clock import Clock
from rosa_reflexes import Command, GateEvent, read_reflexes
from suave.world.environment import SEA_BED
from suave.world.vehicle import Vector, Vehicle

_FILE = Path(__file__).with_name("reflexes.yaml")


class SeaBedReflex:
    """A command gate before the vehicle's depth setpoint.

    Args:
        vehicle: whose setpoints pass through it from now on.
        clock: where the time comes from.
        on_event: hears what happens at the gate.
    """

    def __init__(self, vehicle: Vehicle, clock: Clock, on_event: Callable[[GateEvent], object]) -> None:
        self.gate = read_reflexes(_FILE).gate(self._actuate, clock, on_event)
        self._vehicle = vehicle
        self._depth = 0.0
        vehicle.guard = self.guarded

    def guarded(self, target: Vector) -> Vector:
        """The setpoint that is flown to, at each step of the vehicle's control."""
        self.gate.sense({"altitude": self._vehicle.position[2] - SEA_BED})
        self.gate.submit({"z": target[2]}, self.gate.epoch)
        return target[0], target[1], self._depth

    def _actuate(self, command: Command) -> None:
        self._depth = command["z"]
