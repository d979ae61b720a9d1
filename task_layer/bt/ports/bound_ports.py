"""The ports of one node: their texts in the XML, and the blackboard that these refer to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from rosa_core import RosaError
from task_layer.bt.ports.blackboard import Blackboard, BlackboardError
from task_layer.bt.ports.conversion import ConversionError, converted
from task_layer.bt.ports.port import Direction, Port


class PortError(RosaError, ValueError):
    """A port that has no value, or not one of its type."""


@dataclass(frozen=True, slots=True)
class Literal:
    """A value that is written in the XML."""

    value: Any
    text: str


@dataclass(frozen=True, slots=True)
class Reference:
    """The name of an entry of the blackboard: ``{key}``."""

    key: str
    text: str


PortValue = Literal | Reference


def referenced_key(text: str, port: str) -> str | None:
    """The key in a text like ``{key}``, None in any other; ``{=}`` means the key with the port's name."""
    text = text.strip()
    if len(text) < 3 or not (text.startswith("{") and text.endswith("}")):
        return None
    return port if text == "{=}" else text[1:-1]


@dataclass(frozen=True, slots=True)
class BlackboardParameter:
    """A parameter of a node that reads an entry of the blackboard."""

    blackboard: Blackboard
    key: str
    port: Port
    text: str

    def __call__(self) -> Any:
        """The entry's value, converted to the type of the port."""
        try:
            return converted(self.blackboard.get(self.key), self.port.type)
        except (ConversionError, BlackboardError) as error:
            raise PortError(f"port '{self.port.name}': {error}") from None


class Ports:
    """The ports of one node, read and written by name.

    Args:
        declared: the ports that the node has.
        values: their values, or defaults, by name; ports that may be left out may be missing.
        blackboard: the blackboard that ``{key}`` refers to.

    >>> from task_layer.bt.ports.port import OutputPort
    >>> blackboard = Blackboard()
    >>> ports = Ports([OutputPort("depth", float)], {"depth": Reference("d", "{d}")}, blackboard)
    >>> ports["depth"] = 3
    >>> blackboard.get("d")
    3.0
    """

    def __init__(self, declared: Iterable[Port], values: Mapping[str, PortValue], blackboard: Blackboard) -> None:
        self.blackboard = blackboard
        self._declared = {port.name: port for port in declared}
        self._values = dict(values)
        self._readers = {
            name: BlackboardParameter(blackboard, value.key, self._declared[name], value.text)
            for name, value in self._values.items()
            if isinstance(value, Reference)
        }

    def __getitem__(self, name: str) -> Any:
        """The present value of a port.

        Raises:
            PortError: if there is none, or it is not of the port's type.
        """
        reader = self._readers.get(name)
        if reader is not None:
            return reader()
        value = self._values.get(name)
        if not isinstance(value, Literal):
            raise PortError(f"port '{name}' has no value" if name in self._declared else f"there is no port '{name}'")
        return value.value

    def get(self, name: str, default: Any = None) -> Any:
        """The present value of a port.

        Args:
            name: the port's name.
            default: the result if it has no value, or not one of its type.
        """
        try:
            return self[name]
        except PortError:
            return default

    def get_or_raise(self, name: str, default: Any = None) -> Any:
        """The present value of a port, as ``get_input`` of py_trees' typed ports returns it.

        Args:
            name: the port's name.
            default: the result if it has no value.

        Raises:
            PortError: if it has no value and ``default`` is None.
        """
        return self[name] if default is None else self.get(name, default)

    def __setitem__(self, name: str, value: object) -> None:
        """Write the entry that an output port names; nothing happens if the port was left out.

        Raises:
            PortError: if it is no output port, has a constant instead of an entry, or the value is not of its type.
        """
        port = self._declared.get(name)
        if port is None or port.direction is Direction.IN:
            raise PortError(f"there is no output port '{name}'")
        target = self._values.get(name)
        if target is None:
            return
        if isinstance(target, Literal):
            raise PortError(f"port '{name}' cannot be written: it is the constant {target.text[:60]!r}")
        try:
            self.blackboard.set(target.key, converted(value, port.type))
        except (ConversionError, BlackboardError) as error:
            raise PortError(f"port '{name}': {error}") from None

    def __contains__(self, name: str) -> bool:
        return name in self._values

    def parameter(self, name: str) -> Any:
        """A port as a parameter of a node: its value, or a function that reads the blackboard."""
        return self._readers[name] if name in self._readers else self[name]

    def key(self, name: str) -> str:
        """The name of the entry that a port means, with braces or without.

        Raises:
            PortError: if it means none.
        """
        value = self._values.get(name)
        key = value.key if isinstance(value, Reference) else "" if value is None else value.text.strip()
        if not key:
            raise PortError(f"port '{name}' must name an entry of the blackboard")
        return key

    def constant(self, name: str) -> Any:
        """The value of a port that must be known when the tree is loaded; None if nothing is written.

        Raises:
            PortError: if it names an entry of the blackboard that holds nothing yet.
        """
        if name not in self._values:
            return None
        try:
            return self[name]
        except PortError as error:
            raise PortError(f"{error}; it must be known when the tree is loaded") from None
