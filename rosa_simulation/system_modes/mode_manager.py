"""Puts systems and nodes into their modes."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping

from rosa_core.mape.managed_system import ManagedSystem
from rosa_simulation.system_modes.model import INACTIVE, NodePart, PartState, SystemModes

logger = logging.getLogger(__name__)


class ModeManager:
    """Changes the modes of a robot's parts, by the port to its architecture.

    A node that becomes active is given the parameters of its mode first, so that it starts with the right ones. A
    node that is known to be in the state that is wanted is left alone.

    Args:
        modes: the robot's parts and their modes.
        managed_system: the robot's architecture.
    """

    def __init__(self, modes: SystemModes, managed_system: ManagedSystem) -> None:
        self.modes = modes
        self._system = managed_system
        self._current: dict[str, str] = {}
        self._active: dict[str, bool] = {}

    def mode(self, name: str) -> str | None:
        """The mode that a part was last put into; None if it never was, or that failed.

        Args:
            name: of the system or node.
        """
        return self._current.get(name)

    def change_mode(self, name: str, mode: str) -> bool:
        """Put a system or node into a mode.

        Args:
            name: of the system or node.
            mode: one of its modes.

        Returns:
            whether every call that this took was successful; if not, the next change tries again.

        Raises:
            LookupError: if there is no such part, or it has no such mode.
        """
        self.modes.check(name, mode)
        part = self.modes.part(name)
        if isinstance(part, NodePart):
            done = self._current.get(name) == mode or self._set_parameters(part, mode)
        else:
            done = self._put_all(part.modes[mode])
        if done:
            self._current[name] = mode
        else:
            self._current.pop(name, None)
        return done

    def _put_all(self, states: Mapping[str, PartState]) -> bool:
        done = True
        for part, state in states.items():
            done = self._put(part, state) and done
        return done

    def _put(self, name: str, state: PartState) -> bool:
        part = self.modes.part(name)
        if isinstance(part, NodePart):
            return self._put_node(name, state)
        if state.active:
            return self.change_mode(name, state.mode)
        self._current.pop(name, None)
        return self._put_all(dict.fromkeys(part.parts, INACTIVE))

    def _put_node(self, name: str, state: PartState) -> bool:
        if state.active and not self.change_mode(name, state.mode):
            return False
        if self._active.get(name) is state.active:
            return True
        done = self._call(name, self._system.activate if state.active else self._system.deactivate)
        if done:
            self._active[name] = state.active
        return done

    def _set_parameters(self, node: NodePart, mode: str) -> bool:
        parameters = node.modes[mode]
        return not parameters or self._call(node.name, lambda name: self._system.set_parameters(name, parameters))

    def _call(self, node: str, call: Callable[[str], bool | None]) -> bool:
        try:
            done = call(node) is not False
            reason = "it was refused"
        except Exception as error:
            done, reason = False, f"{type(error).__name__}: {error}"
        if not done:
            logger.warning("changing the mode of '%s' failed: %s", node, reason)
        return done
