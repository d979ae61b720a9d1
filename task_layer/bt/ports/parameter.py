"""Parameters of nodes: a value, or something that is asked for it at every tick."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias, TypeVar

_T = TypeVar("_T")

Parameter: TypeAlias = _T | Callable[[], _T]
"""A value, or a function that gives it (an entry of the blackboard, for instance)."""


def value_of(parameter: Parameter[_T]) -> _T:
    """The parameter's value now."""
    return parameter() if callable(parameter) else parameter
