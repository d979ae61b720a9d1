"""A component that can be activated and deactivated, as a ROS 2 lifecycle node can."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from rosa_core.clock import SimulationClock, Timer
from rosa_core.model.elements import ParameterValue
from rosa_simulation.robot_event import NodeChange

Observer = Callable[["LifecycleNode", NodeChange], None]
"""Called with a node and what has changed of it."""


class LifecycleNode:
    """A node that is inactive at first, and does its work while it is active.

    Subclasses set ``name`` (the component's name in the knowledge model), add their ``parameters`` with their initial
    values, and override :meth:`on_activate`. Every node has the parameter ``system_mode_marker``, by which system modes
    recognise a mode of a node that has no other parameter.

    Args:
        clock: simulated time.
        service_time: how long after a call it takes effect, s.
        observer: called after every change.

    Attributes:
        active: whether it is active.
        parameters: the present value of each parameter.
    """

    name: str

    def __init__(self, clock: SimulationClock, service_time: float, observer: Observer) -> None:
        self.clock = clock
        self.active = False
        self.parameters: dict[str, ParameterValue] = {"system_mode_marker": ""}
        self._service_time = service_time
        self._observer = observer
        self._timers: list[Timer] = []

    def activate(self) -> None:
        """Start working."""
        self.clock.call_later(self._service_time, self._activate)

    def deactivate(self) -> None:
        """Stop working."""
        self.clock.call_later(self._service_time, self._deactivate)

    def set_parameters(self, parameters: Mapping[str, ParameterValue]) -> None:
        """Work with these parameters from now on.

        Args:
            parameters: new values by the names of parameters that the node has.

        Raises:
            KeyError: if the node has no such parameter.
            TypeError: if a value is not of the parameter's type.
        """
        for key, value in parameters.items():
            if key not in self.parameters:
                raise KeyError(f"{self.name} has no parameter '{key}'")
            wanted = type(self.parameters[key])
            if type(value) is not wanted:
                raise TypeError(f"parameter '{key}' of {self.name} is a {wanted.__name__}, not {value!r}")
        self.clock.call_later(self._service_time, lambda: self._set_parameters(dict(parameters)))

    def on_activate(self) -> None:
        """What the node does when it starts."""

    def on_parameters(self) -> None:
        """What the node does when its parameters have changed."""

    def every(self, period: float, callback: Callable[[], None], *, start: float | None = None) -> None:
        """Call back periodically as long as the node is active.

        Args:
            period: s between two calls.
            callback: what is called.
            start: when it is called first, in s of the clock; by default one period from now.
        """
        self._timers.append(self.clock.call_every(period, callback, start=start))

    def _activate(self) -> None:
        if not self.active:
            self.active = True
            self.on_activate()
            self._observer(self, NodeChange.ACTIVATED)

    def _deactivate(self) -> None:
        if self.active:
            self.active = False
            for timer in self._timers:
                timer.cancel()
            self._timers.clear()
            self._observer(self, NodeChange.DEACTIVATED)

    def _set_parameters(self, parameters: dict[str, ParameterValue]) -> None:
        self.parameters.update(parameters)
        self.on_parameters()
        self._observer(self, NodeChange.PARAMETERS)
