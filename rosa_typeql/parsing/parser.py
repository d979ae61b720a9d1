"""TypeQL text to plain data: what a model file inserts, and what a query asks. The grammar is in ``typeql.lark``."""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Sequence
from datetime import UTC, datetime
from functools import lru_cache
from itertools import count
from pathlib import Path
from typing import Any, TypeVar

from lark import Lark, Token, Transformer, v_args
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


def parse_model(text: str, file: str) -> tuple[InsertStatement, ...]:
    """The insert statements of a model file.

    Args:
        text: what stands in it.
        file: its name, for messages.

    Raises:
        InputError: if it is not one; with file, line and, where there is one, the hint.
    """
    if not _without_comments(text):
        raise InputError(Problem("the file is empty", Location(file), "it needs at least an 'insert'"))
    statements: tuple[InsertStatement, ...] = _parse(text, "model", file)
    return statements


def parse_query(text: str, source: str = "query") -> Query:
    """What a query asks.

    Args:
        text: the query.
        source: what messages call it.

    Raises:
        InputError: if it is not a read query; with line and, where there is one, the hint.

    >>> parse_query("match $a isa Action, has name $n; get $n; limit 2;").limit
    2
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


def _as_they_are(_builder: _Builder, *children: Any) -> tuple[Any, ...]:
    return children


@v_args(inline=True)
class _Builder(Transformer[Token, Any]):
    """The callbacks of the grammar's rules: children to data."""

    model = fetch = modifiers = parts = players = _as_they_are

    def __init__(self) -> None:
        super().__init__()
        self._numbers = count()

    def insert_statement(self, match: Any, insert: Token, *statements: Statement) -> InsertStatement:
        return InsertStatement(match or (), statements, _line(insert))

    def query(self, match: Any, projections: Any, modifiers: Any) -> Query:
        return Query(match, projections or (), **_modifiers(modifiers or ()))

    def match_clause(self, _: Token, *patterns: Pattern) -> tuple[Pattern, ...]:
        return patterns

    def projection(self, token: Token, name: Token | None, *attributes: Any) -> Projection:
        shown = str(token)[1:] if name is None else _label(name)
        return Projection(_variable(token), shown, tuple(a for a in attributes if a is not None), _line(token))

    def attribute_projection(self, label: Token, name: Token | None) -> tuple[str, str]:
        return str(label), _label(name or label)

    def get(self, *tokens: Token | None) -> tuple[Projection, ...]:
        return tuple(Projection(_variable(t), str(t)[1:], (), _line(t)) for t in tokens if t is not None)

    def sort(self, keyword: Token, *keys: SortKey) -> tuple[Token, Any]:
        return keyword, keys

    def sort_key(self, token: Token, direction: Token | None) -> SortKey:
        return SortKey(_variable(token), direction is not None and direction.type == "DESCENDING", _line(token))

    def offset(self, keyword: Token, number: Token) -> tuple[Token, Any]:
        return keyword, _count(number)

    limit = offset

    def aggregate(self, function: Token, token: Token | None = None) -> tuple[Token, Any]:
        return function, Aggregate(str(function), None if token is None else _variable(token), _line(function))

    def negation(self, keyword: Token, block: Any) -> Negation:
        return _not_too_deep(Negation(block[0], _line(keyword)))

    def disjunction(self, *blocks: Any) -> Disjunction:
        return _not_too_deep(Disjunction(tuple(patterns for patterns, _ in blocks), blocks[0][1]))

    def block(self, begin: Token, *patterns: Pattern) -> tuple[tuple[Pattern, ...], int]:
        return patterns, _line(begin)

    def variable_statement(self, token: Token, players: Any, parts: Any) -> Statement:
        return _statement(_variable(token), _line(token), players, parts or ())

    def relation_statement(self, players: tuple[Player, ...], token: Token | None, parts: Any) -> Statement:
        variable = Variable(f"_relation_{next(self._numbers)}", anonymous=True) if token is None else _variable(token)
        return _statement(variable, players[0].line, players, parts or ())

    def isa(self, keyword: Token, token: Token, players: Any) -> tuple[Isa, Any]:
        kind = _variable(token) if token.type == "VARIABLE" else str(token)
        return Isa(kind, keyword.type == "ISA_EXACTLY", _line(token)), players

    def has(self, keyword: Token, *rest: Any) -> Has:
        *label, value = rest
        line = _line(keyword)
        if isinstance(value, Token):
            value = _variable(value)
        elif not isinstance(value, Comparison):
            value = Comparison("=", value[0], line)
        return Has(str(label[0]) if label else None, value, line)

    def comparison(self, token: Token, operand: Any) -> Comparison:
        if isinstance(operand, tuple):
            operand = operand[0]
        else:
            operand = _variable(operand) if operand.type == "VARIABLE" else _unquoted(operand)
        operator = "=" if token == "==" else str(token)  # noqa: S105
        return Comparison(operator, operand, _line(token))

    def identity(self, token: Token) -> Variable:
        return _variable(token)

    def player(self, role: Token | None, token: Token) -> Player:
        return Player(None if role is None else str(role), _variable(token), _line(token))

    def literal(self, token: Token) -> tuple[Value]:
        return (_value(token),)


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
    all_players, sorted_parts = list(players or ()), defaultdict[type, list[Any]](list)
    for part in parts:
        match part:
            case (Isa() as isa, with_players):
                sorted_parts[Isa].append(isa)
                all_players.extend(with_players or ())
            case tuple():
                all_players.extend(part)
            case _:
                sorted_parts[type(part)].append(part)
    isas, has, comparisons, same_as = (tuple(sorted_parts[kind]) for kind in (Isa, Has, Comparison, Variable))
    return Statement(variable, line, isas, has, tuple(all_players), comparisons, same_as)


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


_ESCAPE = re.compile(r"\\(.)", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "\n": "\n", '"': '"', "'": "'", "\\": "\\"}


def _unquoted(token: Token) -> str:
    # An escape that means nothing here is left alone, so that a regex needs no double backslashes.
    return _ESCAPE.sub(lambda escape: _ESCAPES.get(escape[1], escape[0]), str(token)[1:-1])


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
