"""Formulas of metric temporal logic: their parts as facts.

Times are whole ticks of a microsecond, so that windows have exact edges.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

TICKS_PER_SECOND = 1_000_000


@dataclass(frozen=True, slots=True)
class Interval:
    """The window of a temporal operator, in ticks after (or before) the present state; ``high`` None is unbounded."""

    low: int = 0
    high: int | None = None

    def __str__(self) -> str:
        if self.low == 0 and self.high is None:
            return ""
        high = "inf" if self.high is None else _seconds(self.high)
        return f"[{_seconds(self.low)},{high}]"


def _seconds(ticks: int) -> str:
    whole, part = divmod(ticks, TICKS_PER_SECOND)
    return f"{whole}.{part:06d}".rstrip("0").rstrip(".")


@dataclass(frozen=True, slots=True)
class Variable:
    """The value of a variable of the state, or a named region."""

    name: str

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, slots=True)
class Number:
    """A number in the formula."""

    value: float

    def __str__(self) -> str:
        return f"{self.value:g}" if float(f"{self.value:g}") == self.value else repr(self.value)


@dataclass(frozen=True, slots=True)
class Text:
    """A text in the formula."""

    value: str

    def __str__(self) -> str:
        return f"'{self.value}'" if "'" not in self.value else f'"{self.value}"'


@dataclass(frozen=True, slots=True)
class Distance:
    """The distance between two points or regions, in the unit of their coordinates."""

    first: Variable
    second: Variable

    def __str__(self) -> str:
        return f"distance({self.first}, {self.second})"


Term: TypeAlias = Variable | Number | Text | Distance


@dataclass(frozen=True, slots=True)
class Comparison:
    """An atom such as ``x > 3`` or ``mode == 'attack'``."""

    left: Term
    operator: str
    right: Term

    def __str__(self) -> str:
        return f"{self.left} {self.operator} {self.right}"


@dataclass(frozen=True, slots=True)
class Matching:
    """An atom such as ``mode matches 'att*'``: the whole text, with ``*`` and ``?`` as wildcards."""

    variable: Variable
    pattern: str

    def __str__(self) -> str:
        return f"{self.variable} matches {Text(self.pattern)}"


@dataclass(frozen=True, slots=True)
class Holds:
    """An atom that is a variable: it holds if the value is true or a number other than 0."""

    variable: Variable

    def __str__(self) -> str:
        return str(self.variable)


@dataclass(frozen=True, slots=True)
class Spatial:
    """An atom such as ``inside(ball, our_half)`` or ``NTPP(a, b)`` (RCC-8)."""

    relation: str
    first: Variable
    second: Variable

    def __str__(self) -> str:
        return f"{self.relation}({self.first}, {self.second})"


@dataclass(frozen=True, slots=True)
class Constant:
    """``true`` or ``false``."""

    value: bool

    def __str__(self) -> str:
        return str(self.value).lower()


Atom: TypeAlias = Comparison | Matching | Holds | Spatial


@dataclass(frozen=True, slots=True)
class Not:
    """``not f``."""

    operand: Formula

    def __str__(self) -> str:
        return f"not {_inner(self.operand)}"


@dataclass(frozen=True, slots=True)
class Binary:
    """``f and g``, ``f or g``, ``f -> g``."""

    operator: str
    left: Formula
    right: Formula

    def __str__(self) -> str:
        return f"{_inner(self.left)} {self.operator} {_inner(self.right)}"


@dataclass(frozen=True, slots=True)
class Timed:
    """``G f``, ``F f`` (future), ``H f``, ``O f`` (past), with a window."""

    operator: str
    interval: Interval
    operand: Formula

    def __str__(self) -> str:
        return f"{self.operator}{self.interval} {_inner(self.operand)}"


@dataclass(frozen=True, slots=True)
class TimedBinary:
    """``f U g`` (until) and ``f S g`` (since), with a window."""

    operator: str
    interval: Interval
    left: Formula
    right: Formula

    def __str__(self) -> str:
        return f"{_inner(self.left)} {self.operator}{self.interval} {_inner(self.right)}"


Formula: TypeAlias = Atom | Constant | Not | Binary | Timed | TimedBinary


def _inner(formula: Formula) -> str:
    return f"({formula})" if isinstance(formula, Binary | TimedBinary) else str(formula)


def parts(formula: Formula) -> Iterator[Formula]:
    """The formula and everything in it, operands first."""
    if isinstance(formula, Not | Timed):
        yield from parts(formula.operand)
    elif isinstance(formula, Binary | TimedBinary):
        yield from parts(formula.left)
        yield from parts(formula.right)
    yield formula


def atoms(formula: Formula) -> tuple[Atom, ...]:
    """The atoms of a formula, once each, in order of appearance."""
    found = (each for each in parts(formula) if isinstance(each, Comparison | Matching | Holds | Spatial))
    return tuple(dict.fromkeys(found))


def variables(formula: Formula) -> tuple[str, ...]:
    """The names that the atoms of a formula mention (variables and regions), once each, in order."""
    names: dict[str, None] = {}
    for atom in atoms(formula):
        for name in _atom_variables(atom):
            names[name] = None
    return tuple(names)


def _atom_variables(atom: Atom) -> Iterator[str]:
    if isinstance(atom, Comparison):
        for term in (atom.left, atom.right):
            if isinstance(term, Variable):
                yield term.name
            elif isinstance(term, Distance):
                yield term.first.name
                yield term.second.name
    elif isinstance(atom, Spatial):
        yield atom.first.name
        yield atom.second.name
    else:
        yield atom.variable.name
