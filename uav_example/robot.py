"""The robot: its nodes and monitors in its world, to be managed by any managing system."""

from __future__ import annotations

from rosa_simulation.lifecycle_node import LifecycleNode
from rosa_simulation.robot import SimulatedRobot
from rosa_simulation.robot_event import NodeChange, RobotEvent
from uav_example import monitors, nodes
from uav_example.events import UavEvent
from uav_example.nodes import Search, make_nodes
from uav_example.world.world import World


class UavRobot(SimulatedRobot):
    """The UAV; a managed system.

    Its nodes take effect a service time after a call. The battery is drained by what is being done, and published
    once a period; the gripper, when it fails. The hardware (gripper, infra-red camera) has nothing to be called. The
    mission is over when the battery is empty, or the time is up.

    Args:
        world: where it flies.
    """

    def __init__(self, world: World) -> None:
        super().__init__(world.clock)
        self.world = world
        self.search = Search(world)
        self.nodes = make_nodes(world, self.search, self.node_changed)
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
        self.clock.call_at(p.time_limit, lambda: world.report(UavEvent.TIME_LIMIT))

    @property
    def survey_done(self) -> bool:
        """Whether the area is searched and every sample that was found is analysed."""
        return self.search.done and self.world.waiting is None

    def publish_battery(self) -> None:
        """Publish the charge of the battery."""
        self.publish(monitors.battery_level(self.clock.now(), self.world.battery.level))

    def node_changed(self, node: LifecycleNode, change: NodeChange) -> None:
        """Report the change of a node as an event of the world.

        Args:
            node: that changed.
            change: what happened to it.
        """
        self.world.report(change, node.name)

    def _drain(self) -> None:
        world, p = self.world, self.world.parameters
        at_work = [drain for name, drain in self._drains.items() if self.nodes[name].active]
        resting = 0.0 if world.aircraft.landed else p.drain_hover
        world.drain(max(at_work, default=resting) * p.control_period)

    def _on_event(self, event: RobotEvent) -> None:
        self.announce(event)
        if event.kind is UavEvent.GRIPPER_FAILED:
            self.publish(monitors.gripper_failed(event.time))
        elif event.kind is UavEvent.CHARGED:
            self.publish_battery()
        elif event.kind in (UavEvent.BATTERY_EMPTY, UavEvent.TIME_LIMIT):
            self.over = True
