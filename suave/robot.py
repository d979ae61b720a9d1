"""The robot in its world: everything that a managing system finds there, in simulated time."""

from __future__ import annotations

from functools import partial

import numpy as np

from rosa_core.clock import SimulationClock
from rosa_simulation.lifecycle_node import LifecycleNode
from rosa_simulation.robot import SimulatedRobot
from suave import monitors
from suave.components.follow_pipeline import FollowPipeline
from suave.components.recharge_battery import RechargeBattery
from suave.components.recover_thrusters import RecoverThrusters
from suave.components.spiral_search import SpiralSearch
from suave.events import SuaveEvent
from suave.mission_config import MissionConfig, ThrusterEvent
from suave.world.environment import Battery, PipelineDetector, WaterVisibility
from suave.world.parameters import WorldParameters
from suave.world.vehicle import Vehicle


class SuaveRobot(SimulatedRobot):
    """The AUV with its four nodes and three monitors; a managed system for any managing system.

    Uncertainties, monitors and the battery start when the vehicle is set to GUIDED mode, which is when the mission
    begins.

    Args:
        clock: simulated time, on which everything is scheduled.
        config: the mission's uncertainties.
        rng: where start and noise are drawn from.
        with_battery: the extended mission has a battery that runs low.
        parameters: numbers of the world.
    """

    def __init__(
        self,
        clock: SimulationClock,
        config: MissionConfig,
        rng: np.random.Generator,
        *,
        with_battery: bool,
        parameters: WorldParameters | None = None,
    ) -> None:
        super().__init__(clock)
        self.config = config
        self.parameters = parameters or WorldParameters()
        self.vehicle = Vehicle(self.parameters, rng)
        self.battery: Battery | None = None
        self.armed = False
        self.guided_at: float | None = None
        self.pipeline_found = False
        self.with_battery = with_battery
        self._detector = PipelineDetector()
        self._water = WaterVisibility(
            config.water_visibility_min,
            config.water_visibility_max,
            config.water_visibility_period,
            config.water_visibility_sec_shift,
        )
        clock.call_every(self.parameters.control_period, self._step)

    # -- the autopilot --

    def arm(self) -> None:
        """Switch the thrusters on."""
        self.armed = True

    def set_guided(self) -> None:
        """Follow setpoints from now on: the mission begins.

        Raises:
            RuntimeError: if the thrusters are not armed.
        """
        if not self.armed:
            raise RuntimeError("arm the thrusters before setting GUIDED mode")
        if self.guided_at is not None:
            return
        now = self.guided_at = self.clock.now()
        self._start_nodes(now)
        self.report(SuaveEvent.GUIDED)
        self.clock.call_every(self.config.qa_publishing_period, self._publish_visibility, start=now)
        if self.with_battery:
            self.battery = Battery(self.config.discharge_time, now)
            self.clock.call_every(self.config.qa_publishing_period, self._publish_battery, start=now)
            self._watch_battery()
        when = now
        for event in self.config.thruster_events:
            when += event.delay
            self.clock.call_at(when, partial(self._thruster_event, event))
        self.clock.call_at(now + self.config.time_limit, self._time_is_up)

    def mission_time(self) -> float:
        """Seconds since the mission began; 0 before."""
        return 0.0 if self.guided_at is None else self.clock.now() - self.guided_at

    # -- what can be known of the world --

    def visibility(self) -> float:
        """How far one sees in the water now, m."""
        return self._water.at(self.mission_time())

    @property
    def pipeline_inspected(self) -> bool:
        """Whether the pipeline was followed to its end and back."""
        return self.guided_at is not None and self.follow.done

    # -- inside --

    def _start_nodes(self, now: float) -> None:
        clock, p, vehicle = self.clock, self.parameters, self.vehicle
        observer = self.node_changed
        self.search = SpiralSearch(clock, p.service_time, observer, vehicle, now + p.settling_time)
        self.follow = FollowPipeline(clock, p.service_time, observer, vehicle, self._inspected)
        self.recover = RecoverThrusters(clock, p, observer, vehicle, lambda n: self._set_thruster(n, True))
        nodes: list[LifecycleNode] = [self.search, self.follow, self.recover]
        if self.with_battery:
            nodes.append(RechargeBattery(clock, p.service_time, observer, vehicle, self._recharge))
        self.nodes = {node.name: node for node in nodes}

    def _step(self) -> None:
        self.vehicle.step()
        searching = self.guided_at is not None and not self.pipeline_found
        if searching and self._detector.sees(self.vehicle.position, self.visibility()):
            self.pipeline_found = True
            self.report(SuaveEvent.PIPELINE_FOUND)

    def _thruster_event(self, event: ThrusterEvent) -> None:
        self._set_thruster(event.number, not event.fails)

    def _set_thruster(self, number: int, works: bool) -> None:
        failed = number in self.vehicle.failed_thrusters()
        if failed != works:
            return
        self.vehicle.set_thruster(number, works)
        self.report(SuaveEvent.THRUSTER_RECOVERED if works else SuaveEvent.THRUSTER_FAILED, str(number))
        if not works:
            self.recover.thruster_failed()
        self.publish(monitors.thruster(self.clock.now(), number, works))

    def _recharge(self) -> None:
        if self.battery is not None:
            self.battery.recharge(self.clock.now())
            self.vehicle.powered = True
            self._watch_battery()
            self.report(SuaveEvent.RECHARGED)
            self._publish_battery()

    def _watch_battery(self) -> None:
        """An empty battery drives no thruster."""
        battery = self.battery
        if battery is None:
            return
        charges = battery.charges

        def empty() -> None:
            if battery.charges == charges:
                self.vehicle.powered = False
                self.report(SuaveEvent.BATTERY_EMPTY)

        self.clock.call_later(self.config.discharge_time, empty)

    def _publish_visibility(self) -> None:
        self.publish(monitors.water_visibility(self.clock.now(), self.visibility()))

    def _publish_battery(self) -> None:
        if self.battery is not None:
            now = self.clock.now()
            self.publish(monitors.battery_level(now, self.battery.level(now)))

    def _inspected(self) -> None:
        self.report(SuaveEvent.PIPELINE_INSPECTED)

    def _time_is_up(self) -> None:
        self.over = True
        self.report(SuaveEvent.TIME_LIMIT)
