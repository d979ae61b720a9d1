"""Atoms at one state: true, false or unknown (None)."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from typing import Any

from rosa_streams.errors import FormulaError
from rosa_streams.temporal.formula import Atom, Comparison, Distance, Holds, Matching, Number, Term, Text, Variable
from rosa_streams.temporal.state import Evaluator, State

_OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq, "!=": operator.ne,
}  # fmt: skip
_WORDS = {"true": True, "false": False}


def evaluator(atom: Atom, regions: Mapping[str, Any]) -> Evaluator:
    """What evaluates an atom at a state.

    Args:
        atom: of a formula.
        regions: geometries of shapely by the names that spatial atoms use.
    """
    if isinstance(atom, Comparison):
        return _comparison(atom, regions)
    if isinstance(atom, Matching):
        return _matching(atom)
    if isinstance(atom, Holds):
        return _holds(atom)
    from rosa_streams.temporal.spatial import spatial_evaluator

    return spatial_evaluator(atom, regions)


def _comparison(atom: Comparison, regions: Mapping[str, Any]) -> Evaluator:
    compare = _OPERATORS[atom.operator]
    if isinstance(atom.left, Variable) and isinstance(atom.right, Number):
        return _variable_and_number(atom, atom.left.name, compare, atom.right.value)
    left, right = _term(atom.left, regions), _term(atom.right, regions)
    ordered = atom.operator not in {"==", "!="}

    def evaluate(state: State) -> bool | None:
        first, second = left(state), right(state)
        if first is None or second is None or first != first or second != second:  # noqa: PLR0124 (NaN)
            return None
        if ordered and (isinstance(first, str) or isinstance(second, str)):
            raise _not_comparable(atom, first if isinstance(first, str) else second)
        return bool(compare(first, second))

    return evaluate


def _variable_and_number(atom: Comparison, name: str, compare: Callable[[Any, Any], Any], number: float) -> Evaluator:
    equality = atom.operator in {"==", "!="}

    def evaluate(state: State) -> bool | None:
        value = state.get(name)
        if value is None or value != value:  # noqa: PLR0124 (NaN)
            return None
        try:
            return bool(compare(value, number))
        except TypeError:
            if equality:
                return atom.operator == "!="
            raise _not_comparable(atom, value) from None

    return evaluate


def _not_comparable(atom: Comparison, value: object) -> FormulaError:
    return FormulaError(f"'{atom}' compares numbers, and one of its values is {value!r}")


def _term(term: Term, regions: Mapping[str, Any]) -> Callable[[State], Any]:
    if isinstance(term, Variable):
        name = term.name
        return lambda state: state.get(name)
    if isinstance(term, Distance):
        from rosa_streams.temporal.spatial import distance_evaluator

        return distance_evaluator(term, regions)
    constant = term.value
    return lambda _: constant


def _matching(atom: Matching) -> Evaluator:
    name, pattern = atom.variable.name, atom.pattern

    def evaluate(state: State) -> bool | None:
        value = state.get(name)
        return None if value is None else wildcard_match(pattern, str(value))

    return evaluate


def wildcard_match(pattern: str, text: str) -> bool:
    """Whether the whole text fits a pattern with ``*`` and ``?``; takes at most len(pattern) * len(text) steps.

    >>> wildcard_match("att*k", "attack"), wildcard_match("att?k", "attack")
    (True, False)
    """
    at = place = 0
    star, retry = -1, 0
    while place < len(text):
        if at < len(pattern) and pattern[at] == "*":
            star, retry = at, place
            at += 1
        elif at < len(pattern) and pattern[at] in {"?", text[place]}:
            at += 1
            place += 1
        elif star >= 0:
            retry += 1
            at, place = star + 1, retry
        else:
            return False
    return set(pattern[at:]) <= {"*"}


def _holds(atom: Holds) -> Evaluator:
    name = atom.variable.name

    def evaluate(state: State) -> bool | None:
        value = state.get(name)
        if value is None or value != value:  # noqa: PLR0124 (NaN)
            return None
        if isinstance(value, str):
            if value.lower() not in _WORDS:
                raise FormulaError(f"'{name}' stands for true or false, and its value is {value!r}")
            return _WORDS[value.lower()]
        return bool(value)

    return evaluate


def text_variables(found: tuple[Atom, ...]) -> frozenset[str]:
    """The variables that are compared with texts: what a recording holds of them is text."""
    names = set()
    for atom in found:
        if isinstance(atom, Matching):
            names.add(atom.variable.name)
        elif isinstance(atom, Comparison):
            sides = (atom.left, atom.right)
            if any(isinstance(side, Text) for side in sides):
                names.update(side.name for side in sides if isinstance(side, Variable))
    return frozenset(names)
