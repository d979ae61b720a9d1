"""What TypeQL text says, as plain data. Nothing here knows what a type means; lines count from 1."""

from __future__ import annotations

from dataclasses import dataclass

from rosa_typeql.schema.values import Value


@dataclass(frozen=True, slots=True)
class Variable:
    """``$name``; one without a name of its own (``$_``, or a relation without a variable) is ``anonymous``."""

    name: str
    anonymous: bool = False

    def __str__(self) -> str:
        return "$_" if self.anonymous else f"${self.name}"


@dataclass(frozen=True, slots=True)
class Isa:
    """``isa Type``; ``exactly``: ``isa!``, so not a subtype."""

    type: str | Variable
    exactly: bool
    line: int


@dataclass(frozen=True, slots=True)
class Comparison:
    """``operator`` is one of ``= != < <= > >= like contains``."""

    operator: str
    operand: Value | Variable
    line: int


@dataclass(frozen=True, slots=True)
class Has:
    """``has label value``; without a label, any attribute."""

    label: str | None
    value: Variable | Comparison
    line: int


@dataclass(frozen=True, slots=True)
class Player:
    """``role: $variable`` in a relation; without a role, any."""

    role: str | None
    variable: Variable
    line: int


@dataclass(frozen=True, slots=True)
class Statement:
    """Everything that one statement says of a variable."""

    variable: Variable
    line: int
    isa: tuple[Isa, ...] = ()
    has: tuple[Has, ...] = ()
    players: tuple[Player, ...] = ()
    comparisons: tuple[Comparison, ...] = ()
    same_as: tuple[Variable, ...] = ()


@dataclass(frozen=True, slots=True)
class Negation:
    """``not { ... }``."""

    patterns: tuple[Pattern, ...]
    line: int


@dataclass(frozen=True, slots=True)
class Disjunction:
    """``{ ... } or { ... }``; with one branch, just a block."""

    branches: tuple[tuple[Pattern, ...], ...]
    line: int


Pattern = Statement | Negation | Disjunction


@dataclass(frozen=True, slots=True)
class InsertStatement:
    """``match ... insert ...``, or ``insert ...`` without a match (then ``match`` is empty)."""

    match: tuple[Pattern, ...]
    insert: tuple[Statement, ...]
    line: int


@dataclass(frozen=True, slots=True)
class Projection:
    """What a row gives of a variable: the attributes with the names they go by, or, without any, the variable."""

    variable: Variable
    name: str
    attributes: tuple[tuple[str, str], ...]
    line: int


@dataclass(frozen=True, slots=True)
class SortKey:
    """A variable to sort by."""

    variable: Variable
    descending: bool
    line: int


@dataclass(frozen=True, slots=True)
class Aggregate:
    """``count``, or ``sum``, ``min``, ``max``, ``mean``, ``median``, ``std`` of a variable."""

    function: str
    variable: Variable | None
    line: int


@dataclass(frozen=True, slots=True)
class Query:
    """A read query. Without projections (``get;`` or nothing) a row gives all variables."""

    match: tuple[Pattern, ...]
    projections: tuple[Projection, ...]
    sort: tuple[SortKey, ...]
    offset: int
    limit: int | None
    aggregate: Aggregate | None
