"""Parameters of nodes: a value, or a function that is called for it at every tick."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias, TypeVar

_T = TypeVar("_T")

Parameter: TypeAlias = _T | Callable[[], _T]
"""A value, or a function that returns it (from an entry of the blackboard, for instance)."""


def value_of(parameter: Parameter[_T]) -> _T:
    """The parameter's present value."""
    return parameter() if callable(parameter) else parameter
