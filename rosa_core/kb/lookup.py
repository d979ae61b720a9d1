"""Names, kinds and values as the knowledge base is given them: resolved, or refused with what would do."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeVar

from rosa_core.errors import InvalidValueError, UnknownElementError, nearest
from rosa_core.inference.network import Node
from rosa_core.kb import reconfiguration
from rosa_core.model.elements import ElementKind
from rosa_core.model.status import Result

_N = TypeVar("_N")


def find(group: Mapping[str, _N], kind: ElementKind, name: str) -> _N:
    """The node of that name, or the error that names the nearest one known."""
    try:
        return group[name]
    except (KeyError, TypeError):
        words = kind.value.replace("_", " ")
        hint = nearest(str(name), group)
        raise UnknownElementError(f"there is no {words} '{name}'" + (f"; {hint}" if hint else "")) from None


_STATUS_KINDS = tuple(kind for kind in ElementKind if kind not in (ElementKind.MEASURE, ElementKind.CONSTRAINT))


def kind_of(kind: ElementKind | str) -> ElementKind:
    """A kind of element that has a name and a status, or the error that lists them."""
    for known in _STATUS_KINDS:
        if kind == known:
            return known
    raise InvalidValueError(f"'{kind}' is not one of: {', '.join(_STATUS_KINDS)}")


def result_of(result: Result | str) -> Result:
    """A result by its word, or the error that lists them."""
    try:
        return Result(result)
    except ValueError:
        raise InvalidValueError(f"'{result}' is not one of: {', '.join(Result)}") from None


def names_of(nodes: Iterable[Node]) -> list[str]:
    """Names in order of declaration."""
    return [node.name for node in reconfiguration.declared_order(nodes)]
