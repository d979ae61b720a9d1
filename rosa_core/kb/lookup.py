"""Names, kinds and values as the knowledge base is given them: found, or refused with what would do."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeVar

from rosa_core.errors import InvalidValueError, UnknownElementError, nearest
from rosa_core.inference.network import (
    ActionNode,
    ComponentNode,
    ConfigurationNode,
    DesignNode,
    FunctionNode,
    MeasureNode,
    Node,
)
from rosa_core.kb import reconfiguration
from rosa_core.kb.state import RuntimeState
from rosa_core.model.elements import ElementKind
from rosa_core.model.status import Result

_N = TypeVar("_N")


def find(group: Mapping[str, _N], kind: ElementKind, name: str) -> _N:
    """The node of that name, or the error that names the nearest one known.

    Args:
        group: nodes by name.
        kind: of these nodes, for the error's words.
        name: which to find.

    Raises:
        UnknownElementError: if there is none of that name; it names the nearest that there is.
    """
    try:
        return group[name]
    except (KeyError, TypeError):
        words = kind.value.replace("_", " ")
        hint = nearest(str(name), group)
        raise UnknownElementError(f"there is no {words} '{name}'" + (f"; {hint}" if hint else "")) from None


class Lookup:
    """The nodes of a state's inference network by name; the state may grow and shrink meanwhile.

    Every method raises :class:`~rosa_core.errors.UnknownElementError` for a name that is not known.
    """

    __slots__ = ("_state",)

    def __init__(self, state: RuntimeState) -> None:
        self._state = state

    def node(self, kind: ElementKind | str, name: str) -> Node:
        """The node of an element that has a status.

        Args:
            kind: ``action``, ``function``, ``component``, ``function_design`` or ``component_configuration``.
            name: unique within the kind.

        Raises:
            InvalidValueError: if there is no such kind.
            UnknownElementError: if there is no such element.
        """
        known = kind_of(kind)
        return find(self._state.reasoner.of_kind(known), known, name)

    def measure(self, name: str) -> MeasureNode:
        """A measure."""
        return find(self._state.reasoner.measures, ElementKind.MEASURE, name)

    def action(self, name: str) -> ActionNode:
        """An action."""
        return find(self._state.reasoner.actions, ElementKind.ACTION, name)

    def function(self, name: str) -> FunctionNode:
        """A function."""
        return find(self._state.reasoner.functions, ElementKind.FUNCTION, name)

    def component(self, name: str) -> ComponentNode:
        """A component."""
        return find(self._state.reasoner.components, ElementKind.COMPONENT, name)

    def design(self, name: str) -> DesignNode:
        """A function design."""
        return find(self._state.reasoner.designs, ElementKind.FUNCTION_DESIGN, name)

    def configuration(self, name: str) -> ConfigurationNode:
        """A component configuration."""
        return find(self._state.reasoner.configurations, ElementKind.COMPONENT_CONFIGURATION, name)


_STATUS_KINDS = tuple(kind for kind in ElementKind if kind not in (ElementKind.MEASURE, ElementKind.CONSTRAINT))


def kind_of(kind: ElementKind | str) -> ElementKind:
    """A kind of element that has a name and a status.

    Args:
        kind: the kind or its word.

    Raises:
        InvalidValueError: if it is none; the error lists them.

    Example:
        >>> kind_of("function_design")
        <ElementKind.FUNCTION_DESIGN: 'function_design'>
    """
    for known in _STATUS_KINDS:
        if kind == known:
            return known
    raise InvalidValueError(f"'{kind}' is not one of: {', '.join(_STATUS_KINDS)}")


def result_of(result: Result | str) -> Result:
    """A result by its word.

    Args:
        result: ``completed``, ``failed`` or ``abandoned``.

    Raises:
        InvalidValueError: if it is none of these; the error lists them.
    """
    try:
        return Result(result)
    except ValueError:
        raise InvalidValueError(f"'{result}' is not one of: {', '.join(Result)}") from None


def names_of(nodes: Iterable[Node]) -> list[str]:
    """Names in order of declaration."""
    return [node.name for node in reconfiguration.declared_order(nodes)]
