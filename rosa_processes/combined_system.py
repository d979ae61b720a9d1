"""One managed system of several, each with components of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Protocol

from rosa_core.mape import Answer, ComponentState
from rosa_core.model.elements import ParameterValue


class ObservedSystem(Protocol):
    """A managed system that can say how its components are, and announces changes."""

    def activate(self, component: str) -> Answer:
        """Start a component."""
        ...

    def deactivate(self, component: str) -> Answer:
        """Stop a component."""
        ...

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> Answer:
        """Let a component run with these parameters."""
        ...

    def state(self, component: str) -> ComponentState:
        """What a component does now."""
        ...

    def subscribe(self, on_change: Callable[[str], None]) -> Callable[[], None]:
        """Hear of changes."""
        ...


class CombinedSystem:
    """Sends every call to the system that the component belongs to.

    Args:
        systems: by the names of components.
    """

    def __init__(self, systems: Mapping[str, ObservedSystem]) -> None:
        self._systems = dict(systems)

    def activate(self, component: str) -> Answer:
        """Start a component."""
        return self._systems[component].activate(component)

    def deactivate(self, component: str) -> Answer:
        """Stop a component."""
        return self._systems[component].deactivate(component)

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> Answer:
        """Let a component run with these parameters."""
        return self._systems[component].set_parameters(component, parameters)

    def state(self, component: str) -> ComponentState:
        """What a component does now."""
        return self._systems[component].state(component)

    def subscribe(self, on_change: Callable[[str], None]) -> Callable[[], None]:
        """Hear of the changes of all."""
        distinct = {id(system): system for system in self._systems.values()}
        unsubscribes = [system.subscribe(on_change) for system in distinct.values()]

        def unsubscribe() -> None:
            for end in unsubscribes:
                end()

        return unsubscribe
