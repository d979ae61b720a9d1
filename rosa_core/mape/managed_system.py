"""The port to the robot's architecture: what the executor can do to a component."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from rosa_core.model.elements import ParameterValue


class ManagedSystem(Protocol):
    """A robot whose components can be started, stopped and given parameters.

    A call that raises, or returns False, has failed; anything else, None too, is a success. A failing call is an
    outcome that the adaptation loop deals with.
    """

    def activate(self, component: str) -> bool | None:
        """Start the component."""
        ...

    def deactivate(self, component: str) -> bool | None:
        """Stop the component."""
        ...

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> bool | None:
        """Let the component run with these parameters from now on."""
        ...
