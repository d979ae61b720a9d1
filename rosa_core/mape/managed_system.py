"""The port to the robot's architecture: what the executor can do to a component."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from enum import Enum
from typing import Protocol, runtime_checkable

from rosa_core.model.elements import ParameterValue

Answer = bool | None | Future[bool | None]
"""False: it has failed; None or True: it was done; a future: that is not known yet."""


class ComponentState(Enum):
    """What a component of a managed system does now."""

    ACTIVE = "active"
    """It runs and does its work."""
    INACTIVE = "inactive"
    """It does not run, and can be started."""
    ABSENT = "absent"
    """It is not there: it can be started only when it has come."""
    UNKNOWN = "unknown"
    """It is not known yet: it is starting, stopping, or does not answer."""


class ManagedSystem(Protocol):
    """A robot whose components can be started, stopped and given parameters.

    A call that raises, or returns False, has failed; anything else, None too, is a success. A failing call is an
    outcome that the adaptation loop deals with: it tries again, and reports the component as failed in the end.

    A call may also return a future with such an answer, and a system that can say how its components are, because it is
    :class:`Observable`, need not answer at all: its calls only begin something, and the state decides. While the loop
    waits for one component, it goes on with the others.

    Example:
        >>> class Printing:
        ...     def activate(self, component):
        ...         print("start", component)
        ...     def deactivate(self, component):
        ...         print("stop", component)
        ...     def set_parameters(self, component, parameters):
        ...         print("set", component, dict(parameters))
        >>> system: ManagedSystem = Printing()
    """

    def activate(self, component: str) -> Answer:
        """Start a component.

        Args:
            component: the name of a node in the knowledge model; it may run already.

        Returns:
            False if it does not run; None counts as success.
        """
        ...

    def deactivate(self, component: str) -> Answer:
        """Stop a component.

        Args:
            component: the name of a node in the knowledge model; it may have stopped already.

        Returns:
            False if it still runs; None counts as success.
        """
        ...

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> Answer:
        """Let a component run with these parameters from now on, whether it runs already or is started afterwards.

        Args:
            component: its name in the knowledge model.
            parameters: values by key, in the units in which the model states them; others stay as they are.

        Returns:
            False if it does not take them; None counts as success.
        """
        ...


@runtime_checkable
class Observable(Protocol):
    """A managed system that can say how its components are: then the state decides, whatever its calls answer."""

    def state(self, component: str) -> ComponentState:
        """What a component does now, as far as is known; must answer at once.

        From the moment that a call has begun to change a component until that is over, its state is ``UNKNOWN``.

        Args:
            component: the name of a node in the knowledge model.
        """
        ...


@runtime_checkable
class Announcing(Protocol):
    """A managed system that says at once when the state of a component may have changed."""

    def subscribe(self, on_change: Callable[[str], None]) -> Callable[[], None]:
        """Call a function with the name of every component whose state may have changed.

        Args:
            on_change: called in any thread, with no lock held; must come back at once.

        Returns:
            a function that ends it.
        """
        ...
