"""Formulas brought into the form that progression works on: atoms, not, and, or, until; past operators apart."""

from __future__ import annotations

from dataclasses import dataclass, field

from rosa_streams.temporal.formula import (
    Atom,
    Binary,
    Comparison,
    Constant,
    Formula,
    Holds,
    Matching,
    Not,
    Spatial,
    Timed,
    TimedBinary,
)
from rosa_streams.temporal.progression import AtomAt, Fixed, Junction, Negation, PastAt, Static, UntilAt


@dataclass(frozen=True, slots=True)
class SinceAt:
    """A since-operator: its operands (the left None where it is true) and its window."""

    left: Static | None
    right: Static
    low: int
    high: int | None


@dataclass
class Compiled:
    """A formula in parts.

    Attributes:
        root: the formula.
        atoms: what ``AtomAt`` numbers.
        untils: what ``UntilAt`` numbers; the same operands have the same number.
        sinces: what ``PastAt`` numbers; inner ones come first.
    """

    root: Static
    atoms: dict[Atom, int] = field(default_factory=dict)
    untils: dict[tuple[Static | None, Static], int] = field(default_factory=dict)
    sinces: dict[SinceAt, int] = field(default_factory=dict)


def compiled(formula: Formula) -> Compiled:
    """Bring a formula into its parts."""
    result = Compiled(Fixed(True))
    result.root = _Compiler(result).static(formula)
    return result


class _Compiler:
    """Numbers atoms and operators on the way."""

    def __init__(self, into: Compiled) -> None:
        self._into = into

    def static(self, formula: Formula) -> Static:
        if isinstance(formula, Comparison | Matching | Holds | Spatial):
            return AtomAt(self._into.atoms.setdefault(formula, len(self._into.atoms)))
        if isinstance(formula, Constant):
            return Fixed(formula.value)
        if isinstance(formula, Not):
            return _not(self.static(formula.operand))
        if isinstance(formula, Binary):
            left, right = self.static(formula.left), self.static(formula.right)
            if formula.operator == "->":
                left = _not(left)
            return _junction(formula.operator == "and", left, right)
        if isinstance(formula, Timed):
            return self._timed(formula)
        left, right = self.static(formula.left), self.static(formula.right)
        known = None if left == Fixed(True) else left
        return self._binary(formula, known, right)

    def _timed(self, formula: Timed) -> Static:
        operand = self.static(formula.operand)
        dual = formula.operator in {"G", "H"}
        operator = "U" if formula.operator in {"G", "F"} else "S"
        inner = TimedBinary(operator, formula.interval, formula.operand, formula.operand)
        found = self._binary(inner, None, _not(operand) if dual else operand)
        return _not(found) if dual else found

    def _binary(self, formula: TimedBinary, left: Static | None, right: Static) -> Static:
        low, high = formula.interval.low, formula.interval.high
        if formula.operator == "U":
            number = self._into.untils.setdefault((left, right), len(self._into.untils))
            return UntilAt(number, low, high)
        return PastAt(self._into.sinces.setdefault(SinceAt(left, right, low, high), len(self._into.sinces)))


def _not(formula: Static) -> Static:
    if isinstance(formula, Fixed):
        return Fixed(not formula.value)
    return formula.operand if isinstance(formula, Negation) else Negation(formula)


def _junction(is_and: bool, left: Static, right: Static) -> Static:
    operands: list[Static] = []
    for each in (left, right):
        if isinstance(each, Junction) and each.is_and == is_and:
            operands += each.operands
        else:
            operands.append(each)
    return Junction(is_and, tuple(dict.fromkeys(operands)))
