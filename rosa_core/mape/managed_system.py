"""The port to the robot's architecture: what the executor can do to a component."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from rosa_core.model.elements import ParameterValue


class ManagedSystem(Protocol):
    """A robot whose components can be started, stopped and given parameters.

    A call that raises, or returns False, has failed; anything else, None too, is a success. A failing call is an
    outcome that the adaptation loop deals with: it tries again, and reports the component as failed in the end.

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

    def activate(self, component: str) -> bool | None:
        """Start a component.

        Args:
            component: the name of a node in the knowledge model; it may run already.

        Returns:
            False if it does not run; None counts as success.
        """
        ...

    def deactivate(self, component: str) -> bool | None:
        """Stop a component.

        Args:
            component: the name of a node in the knowledge model; it may have stopped already.

        Returns:
            False if it still runs; None counts as success.
        """
        ...

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool | None:
        """Let a component run with these parameters from now on, whether it runs already or is started afterwards.

        Args:
            component: its name in the knowledge model.
            parameters: values by key, in the units in which the model states them; others stay as they are.

        Returns:
            False if it does not take them; None counts as success.
        """
        ...
