"""The aircraft among its samples: what is there, whoever flies it."""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING

from rosa_core.clock import SimulationClock
from rosa_simulation.robot_event import RobotEvent
from uav_example.events import UavEvent
from uav_example.world.aircraft import Aircraft, Battery, Gripper
from uav_example.world.area import Analysis, Sample, scatter_samples
from uav_example.world.parameters import WorldParameters

if TYPE_CHECKING:
    import numpy as np


class World:
    """What the nodes act on, and what reports its events.

    Args:
        clock: simulated time.
        parameters: the numbers of the world.
        rng: where the samples and the life of the gripper are drawn from.

    Attributes:
        waiting: the sample that was found and is not analysed yet.
        analyses: how each sample was analysed, by its number.
        on_event: called with everything that happens.
    """

    def __init__(self, clock: SimulationClock, parameters: WorldParameters, rng: np.random.Generator) -> None:
        self.clock = clock
        self.parameters = parameters
        self.samples = scatter_samples(parameters, rng)
        life = parameters.gripper_life * float(rng.standard_exponential())
        self.gripper = Gripper(life if parameters.gripper_fails_after is None else parameters.gripper_fails_after)
        self.aircraft = Aircraft((0.0, 0.0, parameters.home_height), parameters.speed, parameters.climb_speed)
        self.battery = Battery(parameters.initial_charge)
        self.waiting: Sample | None = None
        self.found: list[Sample] = []
        self.analyses: dict[int, Analysis] = {}
        self.on_event: list[Callable[[RobotEvent], None]] = []

    def look_for_samples(self) -> None:
        """Find the nearest sample in sight that was not found before, unless one is waiting."""
        if self.waiting is not None:
            return
        below = self.aircraft.position[:2]
        near = [(math.dist(below, (s.x, s.y)), s.number, s) for s in self.samples if s not in self.found]
        distance, _, sample = min(near, default=(math.inf, 0, None))
        if sample is not None and distance <= self.parameters.sight:
            self.waiting = sample
            self.found.append(sample)
            self.report(UavEvent.SAMPLE_FOUND, str(sample.number))

    def analysed(self, sample: Sample, analysis: Analysis) -> None:
        """A sample was analysed; with it picked up, the gripper is folded again.

        Args:
            sample: that was waiting; none is any more.
            analysis: how it was analysed.
        """
        self.analyses[sample.number] = analysis
        self.waiting = None
        if analysis is Analysis.PICKED_UP:
            self.gripper.folded = True
        self.report(UavEvent.SAMPLE_ANALYSED, str(sample.number))

    def unfold_gripper(self) -> None:
        """Reach out, if the gripper still can."""
        if self.gripper.works:
            self.gripper.folded = False

    def use_gripper(self) -> bool:
        """Work with the gripper for a control period; False if it does not work, or fails now."""
        if not self.gripper.works:
            return False
        self.gripper.use(self.parameters.control_period)
        if not self.gripper.works:
            self.report(UavEvent.GRIPPER_FAILED)
        return self.gripper.works

    def fold_gripper(self) -> None:
        """The gripper is folded."""
        self.gripper.folded = True
        self.report(UavEvent.GRIPPER_FOLDED)

    def drain(self, charge: float) -> None:
        """Take so much from the battery."""
        before = self.battery.level
        self.battery.drain(charge)
        if before > 0.0 and self.battery.level <= 0.0:
            self.report(UavEvent.BATTERY_EMPTY)

    def charge(self, charge: float) -> None:
        """Put so much into the battery."""
        was_full = self.battery.full
        self.battery.charge(charge)
        if self.battery.full and not was_full:
            self.report(UavEvent.CHARGED)

    def report(self, kind: Enum, subject: str = "") -> None:
        """Report to all observers that something happens now.

        Args:
            kind: what happens.
            subject: to which node, sample or part; empty if there is none.
        """
        event = RobotEvent(self.clock.now(), kind, subject)
        for observer in self.on_event:
            observer(event)
