"""What all simulated robots are: managed systems with nodes, of which events and diagnostics can be observed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import Enum

from rosa_core.clock import SimulationClock
from rosa_core.mape.diagnostics import DiagnosticArray
from rosa_core.model.elements import ParameterValue
from rosa_simulation.lifecycle_node import LifecycleNode
from rosa_simulation.robot_event import NodeChange, RobotEvent


class SimulatedRobot:
    """A managed system made of lifecycle nodes.

    Args:
        clock: simulated time, on which everything is scheduled.

    Attributes:
        nodes: the nodes that run, by the names of their components. A call to any other component fails.
        over: whether the mission has come to its end, whatever the task layer would still do.
        on_event: called with every event, before it is published as diagnostics.
        on_diagnostics: called with everything that the monitors publish.
        on_call: called with a component's name when a managing system calls that component.
    """

    def __init__(self, clock: SimulationClock) -> None:
        self.clock = clock
        self.nodes: Mapping[str, LifecycleNode] = {}
        self.over = False
        self.on_event: list[Callable[[RobotEvent], None]] = []
        self.on_diagnostics: list[Callable[[DiagnosticArray], None]] = []
        self.on_call: list[Callable[[str], None]] = []

    def activate(self, component: str) -> bool:
        """Activate a node.

        Returns:
            False if no such node runs.
        """
        return self._call(component, lambda node: node.activate())

    def deactivate(self, component: str) -> bool:
        """Deactivate a node.

        Returns:
            False if no such node runs.
        """
        return self._call(component, lambda node: node.deactivate())

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool:
        """Set parameters of a node.

        Args:
            component: the node's name.
            parameters: values by name; the node's other parameters stay.

        Returns:
            False if no such node runs.

        Raises:
            KeyError: if the node has no such parameter.
            TypeError: if a value is not of the parameter's type.
        """
        return self._call(component, lambda node: node.set_parameters(parameters))

    def report(self, kind: Enum, subject: str = "") -> None:
        """Report to all observers that something happens now.

        Args:
            kind: what happens, as in :class:`RobotEvent`.
            subject: what it happens to.
        """
        self.announce(RobotEvent(self.clock.now(), kind, subject))

    def announce(self, event: RobotEvent) -> None:
        """Call all observers of events."""
        for observer in self.on_event:
            observer(event)

    def publish(self, diagnostics: DiagnosticArray) -> None:
        """Publish what a monitor has seen."""
        for subscriber in self.on_diagnostics:
            subscriber(diagnostics)

    def node_changed(self, node: LifecycleNode, change: NodeChange) -> None:
        """Report the change of a node; for the nodes' ``observer``.

        Args:
            node: that changed.
            change: what happened to it.
        """
        self.report(change, node.name)

    def _call(self, component: str, call: Callable[[LifecycleNode], None]) -> bool:
        node = self.nodes.get(component)
        if node is None:
            return False
        for observer in self.on_call:
            observer(component)
        call(node)
        return True
