"""The Pioneer in its arena: a managed system whose wheels are reached through a command gate."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from pioneer_example import monitors
from pioneer_example.events import PioneerEvent
from pioneer_example.models import DRIVE, LIDAR, SONAR_RING
from pioneer_example.ranging import (
    LIDAR_NOISE,
    LIDAR_PERIOD,
    SONAR_PERIOD,
    DriveNode,
    RangeNode,
    Samples,
    stopping_distance,
)
from pioneer_example.reflexes import KEEP_CLEAR, pioneer_reflexes
from pioneer_example.world.arena import EXPLORER, PIONEER, RADIUS, Arena
from pioneer_example.world.backend import Backend, Wheels
from pioneer_example.world.explorer import Explorer
from pioneer_example.world.geometry import Pose, bearing
from pioneer_example.world.sonar_ring import Noise, free_ahead, nearest_in
from rosa_core.clock import SimulationClock
from rosa_reflexes import Answer, Command, GateEvent, SensorFaultChanged
from rosa_simulation.lifecycle_node import LifecycleNode
from rosa_simulation.robot import SimulatedRobot
from rosa_simulation.robot_event import NodeChange

PERIOD = 0.02
"""Seconds between two steps of the simulation."""
MONITORING_PERIOD = 5.0
_SIDES = {"left": (0.85, 1.6), "right": (-1.6, -0.85)}
_REAR = (2.2, 3.15)
REACHED = 0.15
"""The robot has reached the origin within this distance, m."""


class PioneerRobot(SimulatedRobot):
    """A Pioneer P3DX with a sonar ring, a lidar and two driven wheels, and another robot in the same arena.

    Args:
        clock: simulated time, on which everything is scheduled.
        arena: what there is.
        backend: what simulates it.
        settings: the values of the scenario's parameters.
        rng: where noise is drawn from.

    Attributes:
        gate: the only way to the wheels, unless the gate is bypassed.
        samples: the ranges of the last scan, m; None where none came.
        collisions: how often the robot began to touch something.
        least_clearance: from the robot's edge to anything else, m, the least so far.
        path_length: m.
        is_reactive: whether a reflex, or a reactive action, has the command.
        actions: how many actions or commands deliberation and reflexes have begun.
    """

    def __init__(
        self,
        clock: SimulationClock,
        arena: Arena,
        backend: Backend,
        settings: Mapping[str, Any],
        rng: np.random.Generator,
    ) -> None:
        super().__init__(clock)
        self.arena, self.backend = arena, backend
        self.samples: Samples = ()
        self.collisions, self.path_length, self.actions = 0, 0.0, 0
        self.least_clearance = math.inf
        self.is_reactive = False
        self.wheels: Wheels = (0.0, 0.0)
        self._explorer = Explorer(settings["explorer_speed"], np.random.default_rng(rng.integers(2**32)))
        self._explorer_wheels: Wheels = (0.0, 0.0)
        self._pose = self._true_pose = backend.pose(PIONEER)
        self._touched_at = -math.inf
        self._bypassed = False
        self._steps = 0
        observer = self.node_changed
        noise = Noise(settings["noise"], settings["dropouts"])
        self.sonar = RangeNode(SONAR_RING, clock, observer, self, period=SONAR_PERIOD, noise=noise, rng=rng)
        self.lidar = RangeNode(LIDAR, clock, observer, self, period=LIDAR_PERIOD, noise=LIDAR_NOISE, rng=rng)
        self.drive = DriveNode(clock, observer, settings["speed"], self._limits_change)
        nodes: list[LifecycleNode] = [self.sonar, self.lidar, self.drive]
        self.nodes = {node.name: node for node in nodes}
        self.gate = pioneer_reflexes().gate(self._actuate, clock, self._on_gate_event)
        self.on_gate_event: list[Any] = []
        self._limits_change()

    def begin(self, time_limit: float, fault: str, fault_at: float) -> None:
        """The mission begins: the world moves from now on, and time is limited (s).

        Args:
            time_limit: s.
            fault: what becomes of the sonar ring, or ``none``.
            fault_at: when, s.
        """
        clock, now = self.clock, self.clock.now()
        self.report(PioneerEvent.DEPARTED, "({:.2f}, {:.2f})".format(*self._pose[:2]))
        clock.call_every(PERIOD, self._step)
        clock.call_every(MONITORING_PERIOD, self._monitor)
        clock.call_at(now + time_limit, self._time_is_up)
        if fault != "none":
            clock.call_at(now + fault_at, lambda: self._break_sonar(fault))

    def set_up(self) -> None:
        """Start what it takes to drive with sonar, for those who manage no components."""
        self.activate(SONAR_RING)
        self.activate(DRIVE)

    # -- the two ways to the wheels --

    def bypass_gate(self) -> None:
        """The wheels are reached directly with :meth:`set_wheels` from now on; reflexes do nothing."""
        self._bypassed = True

    def submit(self, left: float, right: float, epoch: int) -> Answer:
        """Deliberation commands the wheels, m/s, as it decided in an epoch of the gate."""
        self.actions += 1
        return self.gate.submit({"left": left, "right": right}, epoch)

    def set_wheels(self, wheels: Wheels) -> None:
        """Command the wheels, m/s."""
        self.wheels = wheels

    def begin_action(self, name: str, *, reactive: bool) -> None:
        """An action begins, on one of the routes."""
        self.actions += 1
        if reactive != self.is_reactive:
            self.is_reactive = reactive
            self.report(PioneerEvent.ROUTE, f"{'reactive' if reactive else 'deliberative'} route: {name}")

    # -- what is known --

    @property
    def pose(self) -> Pose:
        """Where the robot is: x, y in m, heading in rad; from sensors that know the true position."""
        return self._pose

    @property
    def speed(self) -> float:
        """The speed that it is to drive with, m/s; 0 while the drive is not active."""
        speed = self.drive.parameters["speed"]
        return float(speed) if self.drive.active and isinstance(speed, float) else 0.0

    @property
    def distance_to_origin(self) -> float:
        """m."""
        return math.hypot(self._pose[0], self._pose[1])

    @property
    def reached(self) -> bool:
        """Whether it is at the origin."""
        return self.distance_to_origin < REACHED

    @property
    def clearance(self) -> float:
        """From the robot's edge to the nearest thing, m."""
        x, y, _ = self._pose
        ox, oy, _ = self.backend.pose(EXPLORER)
        still = min(obstacle.distance(x, y) for obstacle in self.arena.obstacles)
        return min(still, math.hypot(ox - x, oy - y) - RADIUS) - RADIUS

    def true_ranges(self) -> list[float]:
        """What its sonars would hear without noise, m."""
        return self.backend.ranges(PIONEER)

    def scanned(self, samples: Samples) -> None:
        """A scan has come in: reflexes see it in the same call."""
        self.samples = samples
        if self._bypassed:
            return
        came = [sample for sample in samples if sample is not None]
        if not came:
            return
        values = {"ring": sum(came) / len(came)}
        found = {"range.front": free_ahead(samples), "range.rear": nearest_in(samples, *_REAR, behind=True)}
        found |= {f"range.{side}": nearest_in(samples, *sector) for side, sector in _SIDES.items()}
        values |= {name: value for name, value in found.items() if value is not None}
        self.gate.sense(values)

    def why(self) -> str:
        """Why the robot does what it does, in a line."""
        return "nothing guards the wheels" if self._bypassed else self.gate.why()

    # -- inside --

    def _step(self) -> None:
        if self.over:
            return
        if self._steps % 3 == 0:
            self._explorer_wheels = self._explorer.command(self.backend.ranges(EXPLORER))
        self._steps += 1
        self.backend.step(PERIOD, {PIONEER: self.wheels, EXPLORER: self._explorer_wheels})
        before, self._pose = self._pose, self.backend.pose(PIONEER)
        self.path_length += math.hypot(self._pose[0] - before[0], self._pose[1] - before[1])
        self.least_clearance = min(self.least_clearance, self.clearance)
        touching = self.backend.touches(PIONEER)
        if touching:
            # While it scrapes along something that is one collision.
            if self.clock.now() - self._touched_at > 1.0:
                self.collisions += 1
                self.report(PioneerEvent.COLLISION)
            self._touched_at = self.clock.now()
        if not self._bypassed:
            turn = math.copysign(1.0, self.wheels[1] - self.wheels[0]) if self.gate.holder == KEEP_CLEAR.name else 0.0
            self.gate.sense({"goal.bearing": bearing(self._pose, 0.0, 0.0), "own.turn": turn})
            self.gate.check()
        if self.reached:
            self.over = True
            self.report(PioneerEvent.ORIGIN_REACHED)

    def _actuate(self, command: Command) -> None:
        if not self._bypassed:
            self.wheels = (command["left"], command["right"])

    def _on_gate_event(self, event: GateEvent) -> None:
        if isinstance(event, SensorFaultChanged) and event.sensor == "ring":
            self._ring_changed(event)
        for observer in self.on_gate_event:
            observer(event)

    def _ring_changed(self, event: SensorFaultChanged) -> None:
        """What measures ranges has failed, so far as one can see: the knowledge base is to know."""
        node = self.sonar if self.sonar.active else self.lidar
        if event.fault is not None and node.active:
            self.publish(monitors.component(self.clock.now(), node.name, works=False))

    def node_changed(self, node: LifecycleNode, change: NodeChange) -> None:
        """Report the change; the reflexes' limits follow what is active."""
        super().node_changed(node, change)
        if isinstance(node, RangeNode) and change is NodeChange.ACTIVATED:
            self.publish(monitors.range_rate(self.clock.now(), 1.0 / node.period))
        self._limits_change()

    def _limits_change(self) -> None:
        speed = self.drive.parameters["speed"]
        period = LIDAR_PERIOD if self.lidar.active and not self.sonar.active else SONAR_PERIOD
        if isinstance(speed, float):
            distance = stopping_distance(speed, period)
            self.gate.set_parameter("stop_distance", distance)
            self.gate.set_parameter("pass_distance", distance + 0.15)

    def _monitor(self) -> None:
        now = self.clock.now()
        came = [sample for sample in self.samples if sample is not None and math.isfinite(sample)]
        if came:
            self.publish(monitors.clearance(now, min(came)))

    def _break_sonar(self, fault: str) -> None:
        self.sonar.fault = fault
        self.report(PioneerEvent.SONAR_FAILED, fault)

    def _time_is_up(self) -> None:
        if not self.over:
            self.over = True
            self.report(PioneerEvent.TIME_LIMIT)
