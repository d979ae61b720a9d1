"""TypeQL text to plain data: what a model file inserts, and what a query asks. The grammar is in ``typeql.lark``."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from functools import lru_cache
from itertools import count
from pathlib import Path
from typing import Any, TypeVar

from lark import Lark, Token
from lark.exceptions import LarkError, UnexpectedInput

from rosa_core.errors import InputError, Location, Problem
from rosa_typeql.parsing.problems import syntax_problem
from rosa_typeql.parsing.statements import (
    Aggregate,
    Comparison,
    Disjunction,
    Has,
    InsertStatement,
    Isa,
    Negation,
    Pattern,
    Player,
    Projection,
    Query,
    SortKey,
    Statement,
    Variable,
)
from rosa_typeql.schema.values import Value

MOST_NESTED = 30
"""How deep ``not {}`` and ``or`` may nest."""


def parse_model(text: str, file: str) -> list[InsertStatement]:
    """The insert statements of a model file.

    Raises:
        InputError: if it is not one; with file, line and, as far as can be told, the hint.
    """
    if not _without_comments(text):
        raise InputError(Problem("the file is empty", Location(file), "it needs at least an 'insert'"))
    statements: list[InsertStatement] = _parse(text, "model", file)
    return statements


def parse_query(text: str, source: str = "query") -> Query:
    """What a query asks.

    Raises:
        InputError: if it is not a read query; with line and, as far as can be told, the hint.
    """
    if not _without_comments(text):
        hint = "such as: match $a isa Action, has name $name; fetch $name;"
        raise InputError(Problem("the query is empty", Location(source), hint))
    query: Query = _parse(text, "query", source)
    return query


def _without_comments(text: str) -> str:
    return "\n".join(line for line in text.lstrip("\ufeff").splitlines() if line.partition("#")[0].strip())


_Nesting = TypeVar("_Nesting", Negation, Disjunction)


class _SyntaxError(Exception):
    """Something that the grammar lets pass and that still cannot be."""

    def __init__(self, line: int, what: str, hint: str | None = None) -> None:
        super().__init__(what)
        self.line, self.what, self.hint = line, what, hint


def _parse(text: str, start: str, file: str) -> Any:
    parser = _parser()
    try:
        return parser.parse(text, start=start)
    except _SyntaxError as error:
        raise InputError(Problem(error.what, Location(file, error.line), error.hint)) from None
    except UnexpectedInput as error:
        raise InputError(syntax_problem(error, text, start, file)) from None
    except (LarkError, RecursionError) as error:
        raise InputError(Problem(f"it cannot be read: {error}", Location(file))) from None


@lru_cache(maxsize=1)
def _parser() -> Lark:
    grammar = Path(__file__).with_name("typeql.lark").read_text(encoding="utf-8")
    # LALR with the callbacks built in makes the result while it parses: no tree to recurse over, however deep it nests.
    return Lark(
        grammar,
        start=["model", "query"],
        parser="lalr",
        lexer="basic",
        maybe_placeholders=True,
        transformer=_Builder(),
    )


class _Builder:
    """The callbacks of the grammar's rules: children to data."""

    def __init__(self) -> None:
        self._numbers = count()

    def model(self, children: list[Any]) -> list[InsertStatement]:
        return list(children)

    def insert_statement(self, children: list[Any]) -> InsertStatement:
        match, insert, *statements = children
        return InsertStatement(match or (), tuple(statements), insert.line)

    def query(self, children: list[Any]) -> Query:
        match, fetch, modifiers = children
        return Query(match, tuple(fetch or ()), **_modifiers(modifiers or ()))

    def match_clause(self, children: list[Any]) -> tuple[Pattern, ...]:
        return tuple(children[1:])

    def fetch(self, children: list[Any]) -> list[Projection]:
        return list(children)

    def projection(self, children: list[Any]) -> Projection:
        token, name, *attributes = children
        shown = str(token)[1:] if name is None else _label(name)
        return Projection(_variable(token), shown, tuple(a for a in attributes if a is not None), _line(token))

    def attribute_projection(self, children: list[Any]) -> tuple[str, str]:
        label, name = children
        return str(label), str(label) if name is None else _label(name)

    def get(self, children: list[Any]) -> list[Projection]:
        return [Projection(_variable(c), str(c)[1:], (), _line(c)) for c in children if c is not None]

    def modifiers(self, children: list[Any]) -> list[Any]:
        return list(children)

    def sort(self, children: list[Any]) -> tuple[Token, Any]:
        return children[0], tuple(children[1:])

    def sort_key(self, children: list[Any]) -> SortKey:
        token, direction = children
        return SortKey(_variable(token), direction is not None and direction.type == "DESCENDING", _line(token))

    def offset(self, children: list[Any]) -> tuple[Token, Any]:
        return children[0], _count(children[1])

    def limit(self, children: list[Any]) -> tuple[Token, Any]:
        return children[0], _count(children[1])

    def aggregate(self, children: list[Any]) -> tuple[Token, Any]:
        function, *variables = children
        variable = _variable(variables[0]) if variables else None
        return function, Aggregate(str(function), variable, _line(function))

    def negation(self, children: list[Any]) -> Negation:
        return _not_too_deep(Negation(children[1][0], _line(children[0])))

    def disjunction(self, children: list[Any]) -> Disjunction:
        return _not_too_deep(Disjunction(tuple(patterns for patterns, _ in children), children[0][1]))

    def block(self, children: list[Any]) -> tuple[tuple[Pattern, ...], int]:
        return tuple(children[1:]), _line(children[0])

    def variable_statement(self, children: list[Any]) -> Statement:
        token, players, parts = children
        return _statement(_variable(token), _line(token), players, parts or ())

    def relation_statement(self, children: list[Any]) -> Statement:
        players, token, parts = children
        line = players[0].line
        variable = Variable(f"_relation_{next(self._numbers)}", anonymous=True) if token is None else _variable(token)
        return _statement(variable, line, players, parts or ())

    def parts(self, children: list[Any]) -> list[Any]:
        return list(children)

    def isa(self, children: list[Any]) -> tuple[Isa, Any]:
        keyword, token, players = children
        kind = _variable(token) if token.type == "VARIABLE" else str(token)
        return Isa(kind, keyword.type == "ISA_EXACTLY", _line(token)), players

    def has(self, children: list[Any]) -> Has:
        keyword, *label, value = children
        line = _line(keyword)
        if isinstance(value, Token):
            value = _variable(value)
        elif not isinstance(value, Comparison):
            value = Comparison("=", value[0], line)
        return Has(str(label[0]) if label else None, value, line)

    def comparison(self, children: list[Any]) -> Comparison:
        token, operand = children
        if isinstance(operand, tuple):
            operand = operand[0]
        elif operand.type == "VARIABLE":
            operand = _variable(operand)
        else:
            operand = _unquoted(operand)
        operator = "=" if token == "==" else str(token)  # noqa: S105
        return Comparison(operator, operand, _line(token))

    def identity(self, children: list[Any]) -> Variable:
        return _variable(children[0])

    def players(self, children: list[Any]) -> tuple[Player, ...]:
        return tuple(children)

    def player(self, children: list[Any]) -> Player:
        role, token = children
        return Player(None if role is None else str(role), _variable(token), _line(token))

    def literal(self, children: list[Any]) -> tuple[Value]:
        return (_value(children[0]),)


def _not_too_deep(pattern: _Nesting) -> _Nesting:
    # Checked as soon as a block is complete, so that nothing deeper than allowed is ever made, or recursed over.
    if _depth(pattern) > MOST_NESTED:
        raise _SyntaxError(pattern.line, f"blocks nest more than {MOST_NESTED} deep")
    return pattern


def _depth(pattern: Pattern) -> int:
    if isinstance(pattern, Statement):
        return 0
    branches = (pattern.patterns,) if isinstance(pattern, Negation) else pattern.branches
    return 1 + max(_depth(inner) for branch in branches for inner in branch)


def _line(token: Token) -> int:
    return token.line or 1


def _variable(token: Token) -> Variable:
    if token == "$_":  # noqa: S105
        return Variable(f"_{token.line}_{token.column}", anonymous=True)
    return Variable(str(token)[1:])


def _statement(variable: Variable, line: int, players: Any, parts: Sequence[Any]) -> Statement:
    isa: list[Isa] = []
    has: list[Has] = []
    told: list[Player] = list(players or ())
    comparisons: list[Comparison] = []
    same_as: list[Variable] = []
    for part in parts:
        match part:
            case Has():
                has.append(part)
            case Comparison():
                comparisons.append(part)
            case Variable():
                same_as.append(part)
            case (Isa() as said, with_players):
                isa.append(said)
                told.extend(with_players or ())
            case _:
                told.extend(part)
    return Statement(variable, line, tuple(isa), tuple(has), tuple(told), tuple(comparisons), tuple(same_as))


def _modifiers(modifiers: Sequence[tuple[Token, Any]]) -> dict[str, Any]:
    said: dict[str, Any] = {"sort": (), "offset": 0, "limit": None, "aggregate": None}
    seen = set()
    for token, value in modifiers:
        name = "aggregate" if isinstance(value, Aggregate) else str(token)
        if name in seen:
            raise _SyntaxError(_line(token), f"'{token}' stands twice", "say it once")
        seen.add(name)
        said[name] = value
    return said


def _count(token: Token) -> int:
    if not token.isdigit() or len(token) > 18:
        hint = "give a whole number, such as 10"
        raise _SyntaxError(_line(token), f"'{str(token)[:30]}' is not a number of rows", hint)
    return int(token)


def _label(token: Token) -> str:
    return _unquoted(token) if token.type == "TEXT" else str(token)


_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "\n": "\n"}


def _unquoted(token: Token) -> str:
    text = str(token)[1:-1]
    if "\\" not in text:
        return text
    return "".join(_unescaped(text))


def _unescaped(text: str) -> Iterator[str]:
    characters = iter(text)
    for character in characters:
        if character == "\\":
            escaped = next(characters, "")
            # An escape that means nothing here is left alone, so that a regex needs no double backslashes.
            yield _ESCAPES.get(escaped, escaped if escaped in "\"'\\" else f"\\{escaped}")
        else:
            yield character


def _value(token: Token) -> Value:
    match token.type:
        case "TEXT":
            return _unquoted(token)
        case "TRUE" | "FALSE":
            return token.type == "TRUE"
        case "DATETIME":
            return _datetime(token)
    return _number(token)


def _number(token: Token) -> int | float:
    number = float(token)
    if not math.isfinite(number):
        raise _SyntaxError(_line(token), f"'{str(token)[:30]}' is too large a number", "give a finite number")
    return int(token) if token.lstrip("+-").isdigit() else number


def _datetime(token: Token) -> datetime:
    # TypeDB's datetimes have no time zone; to be the same everywhere they are taken as UTC.
    day, _, time = token.partition("T")
    whole, _, fraction = time.partition(".")
    text = f"{day}T{whole}" if whole else day
    try:
        return datetime.fromisoformat(f"{text}.{fraction[:6].ljust(6, '0')}" if fraction else text).replace(tzinfo=UTC)
    except ValueError:
        raise _SyntaxError(_line(token), f"'{token}' is not a date", "write it as 2024-05-31T12:00:00") from None
