"""The robot: its nodes and monitors in its world, to be managed by any managing system."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from rosa_core.mape.diagnostics import DiagnosticArray
from rosa_core.model.elements import ParameterValue
from rosa_simulation.lifecycle_node import LifecycleNode
from uav_example import monitors, nodes
from uav_example.nodes import Search, UavNode, make_nodes
from uav_example.world.world import World, WorldEvent


class UavRobot:
    """The UAV; a managed system.

    Its nodes take effect a service time after a call. The battery is drained by what is being done, and published
    once a period; the gripper, when it fails. The hardware (gripper, infra-red camera) has nothing to be called.

    Args:
        world: where it flies.

    Attributes:
        on_event: hear of everything that happens, before it is published as diagnostics.
        on_diagnostics: hear what the monitors publish.
        on_call: hear when a managing system calls a component, with the component's name.
        over: whether the mission was broken off: the battery is empty, or the time is up.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.clock = world.clock
        self.search = Search(world)
        self.nodes: dict[str, UavNode] = make_nodes(world, self.search, self._node_changed)
        self.on_event: list[Callable[[WorldEvent], None]] = []
        self.on_diagnostics: list[Callable[[DiagnosticArray], None]] = []
        self.on_call: list[Callable[[str], None]] = []
        self.over = False
        p = world.parameters
        self._drains = {
            nodes.SEARCH_PATH: p.drain_search,
            nodes.PICK_PATH: p.drain_analyze,
            nodes.ANALYZE_PATH: p.drain_analyze_in_situ,
            nodes.HOME_PATH: p.drain_return_base,
            nodes.LAND_PATH: p.drain_land_fold,
        }
        world.on_event.append(self._on_event)
        self.clock.call_every(p.control_period, self._drain)
        self.clock.call_every(p.publishing_period, self.publish_battery, start=0.0)
        self.clock.call_at(p.time_limit, lambda: world.tell("time limit"))

    def activate(self, component: str) -> bool:
        """Activate a node; False if there is none of that name."""
        return self._call(component, lambda node: node.activate())

    def deactivate(self, component: str) -> bool:
        """Deactivate a node; False if there is none of that name."""
        return self._call(component, lambda node: node.deactivate())

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool:
        """Set parameters of a node; False if there is none of that name."""
        return self._call(component, lambda node: node.set_parameters(parameters))

    @property
    def survey_done(self) -> bool:
        """Whether the area is searched and every sample that was found is analysed."""
        return self.search.done and self.world.waiting is None

    def publish_battery(self) -> None:
        """Publish the charge of the battery."""
        self._publish(monitors.battery_level(self.clock.now(), self.world.battery.level))

    def _call(self, component: str, call: Callable[[LifecycleNode], None]) -> bool:
        node = self.nodes.get(component)
        if node is None:
            return False
        for observer in self.on_call:
            observer(component)
        call(node)
        return True

    def _drain(self) -> None:
        world, p = self.world, self.world.parameters
        at_work = [drain for name, drain in self._drains.items() if self.nodes[name].active]
        resting = 0.0 if world.aircraft.landed else p.drain_hover
        world.drain(max(at_work, default=resting) * p.control_period)

    def _on_event(self, event: WorldEvent) -> None:
        for observer in self.on_event:
            observer(event)
        if event.what == "gripper failed":
            self._publish(monitors.gripper_failed(event.time))
        elif event.what == "charged":
            self.publish_battery()
        elif event.what in ("battery empty", "time limit"):
            self.over = True

    def _publish(self, diagnostics: DiagnosticArray) -> None:
        for subscriber in self.on_diagnostics:
            subscriber(diagnostics)

    def _node_changed(self, node: LifecycleNode, change: str) -> None:
        self.world.tell(change, node.name)
