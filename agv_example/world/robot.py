"""The robot on its map: a managed system with components that fail, corridors that close, lights that change."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from agv_example import monitors
from agv_example.corridors import FULL_LIGHT, Corridor, CorridorMap
from agv_example.drive_configurations import SPEED, DriveConfiguration, DriveOptions
from agv_example.events import AgvEvent
from agv_example.planning.costs import Costs, StartUp
from agv_example.planning.route import Position
from agv_example.world.motion import Collisions, true_costs
from rosa_core.clock import SimulationClock
from rosa_core.model.elements import ParameterValue
from rosa_reflexes import CommandGate, GateEvent, read_reflexes
from rosa_simulation.robot import SimulatedRobot
from rosa_simulation.robot_event import NodeChange

PERIOD = 0.1
"""Seconds between two steps of the simulation."""
MONITORING_PERIOD = 1.0
_REFLEXES = Path(__file__).parents[1] / "reflexes.yaml"


class AgvRobot(SimulatedRobot):
    """Drives corridors as fast as its configuration allows, as long as it knows where it is.

    Args:
        clock: simulated time, on which everything is scheduled.
        corridors: the map. The robot knows it, with every change at once.
        start: the place where it stands at first.
        battery: how much energy it has, in units of draw times second.
        truth: what each configuration is like in this world.
        start_up: what it takes to start a component.
        rng: where collisions are drawn from.
    """

    def __init__(
        self,
        clock: SimulationClock,
        corridors: CorridorMap,
        start: str,
        *,
        battery: float,
        truth: DriveOptions,
        start_up: StartUp,
        rng: np.random.Generator,
    ) -> None:
        super().__init__(clock)
        self.corridors = corridors
        self.start_up = start_up
        self.at = Position(corridors.place(start).name)
        self.active: set[str] = set()
        self.failed: set[str] = set()
        self.energy = 0.0
        self.distance = 0.0
        self.collisions = Collisions(rng)
        self.reached: list[str] = []
        self._battery = battery
        self._truth = truth
        self._components = frozenset(part for one in truth.configurations for part in one.components)
        self._speed = 0.0
        self._towards: str | None = None
        self._ahead: str | None = None
        self._ready_at = 0.0
        self._stranded = False
        self._gate: CommandGate | None = None
        self._bumped = 0

    def depart(self, time_limit: float) -> None:
        """The mission begins: the world moves from now on, and monitors publish.

        Args:
            time_limit: when it ends, s from now.
        """
        now = self.clock.now()
        self.report(AgvEvent.DEPARTED, self.at.place)
        self.clock.call_every(PERIOD, self._step)
        self.clock.call_every(MONITORING_PERIOD, self._publish_battery, start=now)
        self.clock.call_at(now + time_limit, self._time_is_up)
        self._publish_light()

    # -- the managed system --

    def activate(self, component: str) -> bool:
        """Start a component, ready after ``start_up.time`` (s). False if there is none such, or it has failed.

        Args:
            component: its name.
        """
        if component not in self._components or component in self.failed:
            return False
        if component not in self.active:
            self.active.add(component)
            self._ready_at = max(self._ready_at, self.clock.now()) + self.start_up.time
            self._draw(self.start_up.energy)
            self.report(NodeChange.ACTIVATED, component)
        return True

    def deactivate(self, component: str) -> bool:
        """Stop a component."""
        if component in self.active:
            self.active.discard(component)
            self.report(NodeChange.DEACTIVATED, component)
        return component in self._components

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool:
        """Drive at another speed: ``move_speed`` in m/s, above 0.

        Args:
            component: reported as what was configured.
            parameters: only ``move_speed`` is looked at.

        Returns:
            False, and nothing changes, if the speed is missing or no number above 0.
        """
        speed = parameters.get(SPEED)
        if isinstance(speed, bool) or not isinstance(speed, int | float) or not speed > 0:
            return False
        self._speed = float(speed)
        self.report(NodeChange.PARAMETERS, component)
        return True

    def add_bumper(self, on_event: Callable[[GateEvent], object]) -> None:
        """From now on the robot moves through a command gate, whose reflex stops it after a collision.

        Args:
            on_event: hears what happens at the gate.
        """
        self._gate = read_reflexes(_REFLEXES).gate(lambda _: None, self.clock, on_event)

    # -- driving --

    def face(self, corridor: str) -> None:
        """Look into the corridor that is to be driven next; the light there is what is measured from now on.

        Args:
            corridor: its name.
        """
        if self._ahead != corridor:
            self._ahead = self.corridors.corridor(corridor).name
            self._publish_light()

    def drive(self, corridor: str, end: str) -> None:
        """Drive the corridor to one of its ends; from inside it, that may be the one at which the robot came in.

        Args:
            corridor: its name; the robot turns round in it if need be.
            end: the name of the place to drive to.

        Raises:
            ValueError: if the robot is neither in the corridor nor at an end of it, or it has no such end.
        """
        way = self.corridors.corridor(corridor)
        ends = (way.start, way.end)
        inside = self.at.corridor == corridor
        if end not in ends or not (inside or any(map(self.is_at, ends))):
            raise ValueError(f"the robot cannot drive {corridor} to {end} from where it is: {self.at}")
        if not inside:
            self.at = Position(self.at.place, corridor, 0.0)
        self.face(corridor)
        self._towards = end
        self._stranded = False
        self.report(AgvEvent.DRIVING, corridor)

    def halt(self) -> None:
        """Stand still where it is."""
        self._towards = None

    @property
    def driving_to(self) -> tuple[str, str] | None:
        """The corridor and the end to which it drives, None while it stands."""
        corridor = self.at.corridor
        return None if corridor is None or self._towards is None else (corridor, self._towards)

    @property
    def ready_at(self) -> float:
        """When all components that were started are ready, s."""
        return self._ready_at

    # -- what happens to it --

    def fail(self, component: str) -> None:
        """A component breaks."""
        if component not in self.failed:
            self.failed.add(component)
            self.report(AgvEvent.COMPONENT_FAILED, component)
            self.publish(monitors.component(self.clock.now(), component, works=False))

    def recover(self, component: str) -> None:
        """A component works again."""
        if component in self.failed:
            self.failed.discard(component)
            self.report(AgvEvent.COMPONENT_RECOVERED, component)
            self.publish(monitors.component(self.clock.now(), component, works=True))

    def close(self, corridor: str, closed: bool = True) -> None:
        """A corridor closes, or opens again.

        Args:
            corridor: its name; the robot may be in it.
            closed: False to open it.
        """
        kind = AgvEvent.CORRIDOR_CLOSED if closed else AgvEvent.CORRIDOR_OPENED
        self._change(replace(self.corridors.corridor(corridor), closed=closed), kind)

    def dim(self, corridor: str, light: float) -> None:
        """The light in a corridor changes.

        Args:
            corridor: its name.
            light: from 0, dark, to 1; measured at once if the robot faces this corridor.
        """
        changed = replace(self.corridors.corridor(corridor), light=light)
        if self._change(changed, AgvEvent.LIGHT_CHANGED) and self._ahead == corridor:
            self._publish_light()

    # -- what can be known --

    @property
    def battery_level(self) -> float:
        """The charge, 0 to 1."""
        return max(0.0, 1.0 - self.energy / self._battery)

    @property
    def energy_left(self) -> float:
        """In units of draw times second."""
        return max(0.0, self._battery - self.energy)

    def is_at(self, place: str) -> bool:
        """Whether it is at that place, and not on its way through a corridor."""
        return self.at.place == place and (self.at.corridor is None or self.at.travelled == 0.0)

    @property
    def light(self) -> float:
        """How light it is where the robot looks, 0 to 1."""
        return FULL_LIGHT if self._ahead is None else self.corridors.corridor(self._ahead).light

    @property
    def coordinates(self) -> tuple[float, float]:
        """Where it is, m."""
        here = self.corridors.place(self.at.place)
        if self.at.corridor is None:
            return here.x, here.y
        corridor = self.corridors.corridor(self.at.corridor)
        other = self.corridors.place(corridor.other_end(here.name))
        part = self.at.travelled / corridor.length
        return here.x + part * (other.x - here.x), here.y + part * (other.y - here.y)

    def running(self) -> DriveConfiguration | None:
        """The configuration in which it runs; None if it does not know where it is."""
        works = self.active - self.failed
        lit = self._truth.in_light(self.light)
        several = [
            one
            for number, one in enumerate(self._truth.configurations)
            if number in lit and one.components <= works and one.speed == self._speed
        ]
        return max(several, key=lambda one: (one.accuracy, -one.energy), default=None)

    # -- inside --

    def _step(self) -> None:
        now = self.clock.now()
        if self.over or self._towards is None or self.at.corridor is None or self.energy_left <= 0.0:
            return
        corridor = self.corridors.corridor(self.at.corridor)
        blocked = corridor.closed and self._towards != self.at.place
        running = self.running()
        if running is None or blocked:
            if not self._stranded:
                self._stranded = True
                self.report(AgvEvent.STRANDED, self.at.corridor)
            return
        self._stranded = False
        # A component may have become ready within the step.
        seconds = min(PERIOD, now - self._ready_at)
        if seconds > 0.0 and self._may_move():
            self._move(corridor, running, seconds)

    def _may_move(self) -> bool:
        """Ask the gate, if there is one."""
        gate = self._gate
        if gate is None:
            return True
        bumped, self._bumped = self.collisions.number > self._bumped, self.collisions.number
        gate.sense({"bumper": float(bumped)})
        gate.submit({"move": 1.0}, gate.epoch)
        return gate.command["move"] > 0.0

    def _move(self, corridor: Corridor, running: DriveConfiguration, seconds: float) -> None:
        back = self._towards == self.at.place
        whole = true_costs(corridor, corridor.other_end(self.at.place) if back else self.at.place, running)
        ahead = self.at.travelled if back else corridor.length - self.at.travelled
        step = min(ahead, seconds * corridor.length / whole.time)
        if not back:
            self._collide(corridor, whole, step)
        self._draw(whole.energy * step / corridor.length)
        self.distance += step
        travelled = self.at.travelled + (-step if back else step)
        if step < ahead:
            self.at = Position(self.at.place, corridor.name, travelled)
            return
        self.at = Position(self._towards or self.at.place)
        self._towards = None
        self.report(AgvEvent.ARRIVED, self.at.place)

    def _collide(self, corridor: Corridor, whole: Costs, step: float) -> None:
        for _ in range(self.collisions.add(whole.risk * step / corridor.length)):
            self.report(AgvEvent.COLLISION, corridor.name)

    def _draw(self, energy: float) -> None:
        before = self.energy_left
        self.energy += min(energy, before)
        if before > 0.0 >= self.energy_left:
            self.report(AgvEvent.BATTERY_EMPTY)
            self._publish_battery()

    def _change(self, changed: Corridor, kind: AgvEvent) -> bool:
        if self.corridors.corridor(changed.name) == changed:
            return False
        self.corridors = self.corridors.changing(changed)
        self.report(kind, changed.name)
        return True

    def _publish_light(self) -> None:
        self.publish(monitors.light(self.clock.now(), self.light))

    def _publish_battery(self) -> None:
        self.publish(monitors.battery_level(self.clock.now(), self.battery_level))

    def arrive(self, goal: str) -> None:
        """The robot is where it was to go."""
        self.reached.append(goal)
        self.report(AgvEvent.GOAL_REACHED, goal)

    def _time_is_up(self) -> None:
        if not self.over:
            self.over = True
            self.report(AgvEvent.TIME_LIMIT)
