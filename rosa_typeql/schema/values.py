"""The values of attributes: which ones an attribute can have, and how they compare."""

from __future__ import annotations

import operator
from collections.abc import Callable
from datetime import datetime

from rosa_core.model.elements import Scalar
from rosa_typeql.schema.table import ValueKind

Value = bool | int | float | str | datetime
"""A value as it is written."""


def plain(value: Value) -> Scalar:
    """A value as facts have it: times are seconds since 1970-01-01 UTC."""
    return value.timestamp() if isinstance(value, datetime) else value


def fits(kind: ValueKind, value: Value) -> bool:
    """Whether an attribute of a kind can have this value. A time may be given in seconds too.

    Args:
        kind: of the attribute.
        value: as it is written.
    """
    match kind:
        case ValueKind.TEXT:
            return isinstance(value, str)
        case ValueKind.NUMBER:
            return isinstance(value, int | float) and not isinstance(value, bool)
        case ValueKind.BOOLEAN:
            return isinstance(value, bool)
        case ValueKind.TIME:
            return isinstance(value, int | float | datetime) and not isinstance(value, bool)
    return not isinstance(value, datetime)


def _comparing(compare: Callable[[Scalar, Scalar], bool]) -> Callable[[Scalar, Scalar], bool]:
    """Values of different kinds have no order: comparing them is never true."""
    return lambda one, other: value_rank(one)[0] == value_rank(other)[0] and compare(one, other)


def _contains(text: Scalar, part: Scalar) -> bool:
    return isinstance(text, str) and isinstance(part, str) and part.casefold() in text.casefold()


def value_rank(value: Scalar) -> tuple[int, Scalar]:
    """For sorting values of several kinds: false and true, numbers, texts."""
    if isinstance(value, bool):
        return 0, value
    return (2, value) if isinstance(value, str) else (1, value)


def same(one: Scalar, other: Scalar) -> bool:
    """Whether two values are equal; true and 1 are not.

    Args:
        one: a value.
        other: another.

    Example:
        >>> same(1, 1.0), same(1, True)
        (True, False)
    """
    return one == other and isinstance(one, bool) is isinstance(other, bool)


TESTS: dict[str, Callable[[Scalar, Scalar], bool]] = {
    "=": same,
    "!=": lambda one, other: not same(one, other),
    "<": _comparing(operator.lt),
    "<=": _comparing(operator.le),
    ">": _comparing(operator.gt),
    ">=": _comparing(operator.ge),
    "contains": _contains,
}
"""What the comparisons of TypeQL mean."""
