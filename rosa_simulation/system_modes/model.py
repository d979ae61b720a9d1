"""System modes as data: nodes, systems of parts, and their modes (Nordmann et al., 2021)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rosa_core.errors import nearest
from rosa_core.model.elements import ParameterValue

DEFAULT_MODE = "__DEFAULT__"
"""The mode that every part has, and that it is in when it is merely active."""


@dataclass(frozen=True, slots=True)
class PartState:
    """What a mode of a system wants of a part.

    Attributes:
        active: whether the part is to be active.
        mode: in which it is to be, if it is active.
    """

    active: bool
    mode: str = DEFAULT_MODE


INACTIVE = PartState(False)


@dataclass(frozen=True, slots=True)
class NodePart:
    """A lifecycle node; each of its modes is a set of parameters.

    Attributes:
        modes: parameters by mode, in order of declaration.
    """

    name: str
    modes: Mapping[str, Mapping[str, ParameterValue]]


@dataclass(frozen=True, slots=True)
class SystemPart:
    """A group of parts; each of its modes says what state they are in.

    Attributes:
        parts: the names of its members.
        modes: states of parts by mode; a part that a mode leaves out stays as it is.
    """

    name: str
    parts: tuple[str, ...]
    modes: Mapping[str, Mapping[str, PartState]]


@dataclass(frozen=True, slots=True)
class SystemModes:
    """All parts of a robot, systems and nodes alike.

    Attributes:
        parts: by name.
    """

    parts: Mapping[str, SystemPart | NodePart]

    def part(self, name: str) -> SystemPart | NodePart:
        """The part of that name.

        Args:
            name: of the system or node.

        Raises:
            LookupError: if there is none.
        """
        try:
            return self.parts[name]
        except KeyError:
            raise LookupError(f"there is no part '{name}'{_hint(name, self.parts)}") from None

    def modes(self, name: str) -> tuple[str, ...]:
        """The modes of a part, in order of declaration.

        Args:
            name: of the system or node.

        Raises:
            LookupError: if there is no such part.
        """
        return tuple(self.part(name).modes)

    def check(self, name: str, mode: str) -> None:
        """Make sure that there is such a part with such a mode.

        Args:
            name: of the system or node.
            mode: of that part.

        Raises:
            LookupError: if there is not.
        """
        modes = self.part(name).modes
        if mode not in modes:
            raise LookupError(f"'{name}' has no mode '{mode}'{_hint(mode, modes)}")

    def effort(self) -> dict[str, int]:
        """How much had to be modelled, counted as in the ROSA paper (table 7): parts, their modes, parameter values."""
        parts = self.parts.values()
        nodes = [part for part in parts if isinstance(part, NodePart)]
        return {
            "parts": len(self.parts),
            "modes": sum(len(part.modes) for part in parts),
            "parameters": sum(len(values) for node in nodes for values in node.modes.values()),
        }


def _hint(name: str, known: Mapping[str, object]) -> str:
    near = nearest(name, known)
    return f"; {near}" if near else f"; there are: {', '.join(known)}"
