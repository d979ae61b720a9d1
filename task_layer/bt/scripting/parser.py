"""The compiler of scripts to functions; the grammar is in ``script.lark``."""

from __future__ import annotations

import math
import re
from collections.abc import Collection
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from task_layer.bt.ports.conversion import ConversionError
from task_layer.bt.scripting.assignment import assignment
from task_layer.bt.scripting.operators import chain, comparison, conditional, prefixed
from task_layer.bt.scripting.scope import Evaluate, Scope, ScriptError

if TYPE_CHECKING:
    from lark import Lark, Token
    from lark.exceptions import UnexpectedInput

MAX_LENGTH = 10_000
"""Characters of a script."""

MAX_DEPTH = 30
"""Levels of parentheses and ``?:``."""


@dataclass(frozen=True, slots=True)
class Script:
    """A compiled script.

    Attributes:
        text: the source.
        statements: its statements, in order.
    """

    text: str
    statements: tuple[Evaluate, ...]

    def run(self, scope: Scope) -> object:
        """Run all statements, and return the value of the last one.

        Raises:
            ScriptError: if it does something that cannot be done.
        """
        value: object = None
        try:
            for statement in self.statements:
                value = statement(scope)
        except (ScriptError, ConversionError, LookupError) as error:
            raise ScriptError(f"in the script {_shortened(self.text)!r}: {error}") from None
        return value


@lru_cache(maxsize=1024)
def compile_script(text: str) -> Script:
    """Compile a script.

    Raises:
        ScriptError: if it has an error, with the column.

    >>> from task_layer.bt.ports.blackboard import Blackboard
    >>> compile_script("a := 2; a * 3").run(Scope(Blackboard()))
    6.0
    """
    from lark.exceptions import LarkError, UnexpectedInput, VisitError

    _check_size(text)
    parser = _parser()
    try:
        parsed: Any = parser.parse(text)
    except UnexpectedInput as error:
        raise _syntax_error(error, text) from None
    except VisitError as error:
        raise error.orig_exc from None
    except LarkError as error:
        raise ScriptError(f"it cannot be read: {error}") from None
    return Script(text, parsed)


def _check_size(text: str) -> None:
    if len(text) > MAX_LENGTH:
        raise ScriptError(f"it has {len(text)} characters; at most {MAX_LENGTH} are allowed")
    depth = 0
    for match in re.finditer(r"'[^']*'|\"[^\"]*\"|:=|[()?:]", text):
        depth += {"(": 1, "?": 1, ")": -1, ":": -1}.get(match.group(), 0)
        if depth > MAX_DEPTH:
            raise _at(text, match.start(), f"parentheses and '?:' nest more than {MAX_DEPTH} deep")


@lru_cache(maxsize=1)
def _parser() -> Lark:
    from lark import Lark

    grammar = Path(__file__).with_name("script.lark").read_text(encoding="utf-8")
    # LALR with built-in callbacks compiles while it parses: there is no syntax tree to recurse over.
    return Lark(grammar, start="script", parser="lalr", lexer="basic", transformer=_Compiler())


class _Compiler:
    """The callbacks of the grammar's rules, which compile the children of a rule to a function."""

    def script(self, children: list[Any]) -> tuple[Evaluate, ...]:
        return tuple(children)

    def assignment(self, children: list[Any]) -> Evaluate:
        name, symbol, value = children
        return assignment(str(name), str(symbol), value)

    def conditional(self, children: list[Any]) -> Evaluate:
        return conditional(*children)

    def logical(self, children: list[Any]) -> Evaluate:
        return chain(children[::2], children[1::2])

    def comparison(self, children: list[Any]) -> Evaluate:
        return comparison(children[::2], children[1::2]) if len(children) > 1 else children[0]

    def operand(self, children: list[Any]) -> Evaluate:
        return _operand(children[::2], children[1::2])

    def unit(self, children: list[Any]) -> _Unit:
        *prefixes, atom = children
        if isinstance(atom, _Number):
            if prefixes and prefixes[-1] == "+":
                del prefixes[-1]
            atom = _constant(atom.value)
        for prefix in prefixes:
            if prefix == "+":
                raise ScriptError(f"column {prefix.column}: a '+' in front of something that is not a number")
        return _Unit(prefixed([str(prefix) for prefix in prefixes], atom), tuple(prefixes))

    def number(self, children: list[Any]) -> _Number:
        return _Number(_number(children[0]))

    def text(self, children: list[Any]) -> Evaluate:
        return _constant(str(children[0])[1:-1])

    def boolean(self, children: list[Any]) -> Evaluate:
        return _constant(int(children[0] == "true"))

    def name(self, children: list[Any]) -> Evaluate:
        name = str(children[0])
        return lambda scope: scope.value(name)

    def nested(self, children: list[Any]) -> Evaluate:
        inner: Evaluate = children[0]
        return inner


@dataclass(frozen=True, slots=True)
class _Number:
    value: float


@dataclass(frozen=True, slots=True)
class _Unit:
    """An operand with the prefixes that stand before it."""

    evaluate: Evaluate
    prefixes: tuple[Token, ...]


_GROUPS = {
    **dict.fromkeys(("SIGN", "TIMES"), "arithmetic"),
    **dict.fromkeys(("BITS", "BIT_PREFIX"), "bit and '!'"),
    "CONCAT": "text",
}


def _operand(units: list[_Unit], operators: list[Token]) -> Evaluate:
    tokens = sorted([*operators, *(token for unit in units for token in unit.prefixes)], key=lambda t: t.start_pos or 0)
    for token in tokens:
        if _GROUPS[token.type] != _GROUPS[tokens[0].type]:
            groups = f"{_GROUPS[tokens[0].type]} and {_GROUPS[token.type]}"
            raise ScriptError(f"column {token.column}: {groups} operators are mixed (set parentheses)")
    tight = {"TIMES"} if tokens and tokens[0].type in ("SIGN", "TIMES") else set()
    return _in_two_levels([unit.evaluate for unit in units], operators, tight)


def _in_two_levels(operands: list[Evaluate], operators: list[Token], tight: set[str]) -> Evaluate:
    """Operators that bind tighter first: ``*`` and ``/`` before ``+`` and ``-``, ``&`` before ``|`` and ``^``."""
    groups: list[tuple[list[Evaluate], list[str]]] = [([operands[0]], [])]
    outer: list[str] = []
    for token, operand in zip(operators, operands[1:], strict=True):
        if token.type in tight or token == "&":  # noqa: S105
            groups[-1][0].append(operand)
            groups[-1][1].append(str(token))
        else:
            outer.append(str(token))
            groups.append(([operand], []))
    return chain([chain(*group) for group in groups], outer)


def _constant(value: object) -> Evaluate:
    return lambda _: value


def _number(token: Token) -> float:
    if token[:2] in ("0x", "0X"):
        value: float = int(token, 16)
    elif token.isdigit():
        value = int(token) if len(token) < 30 else 2**64
    else:
        value = float(token)
    if isinstance(value, float) and math.isfinite(value):
        return value
    if isinstance(value, float) or value >= 2**63:
        raise ScriptError(f"column {token.column}: {_shortened(token)} is too large a number")
    return value


_WORDS = {
    "SEMICOLON": "';'",
    "ASSIGN": "':=' or another assignment",
    "SIGN": "an operator",
    "NAME": "a name",
    "NUMBER": "a number",
    "TEXT": "a text in quotes",
    "RPAR": "')'",
    "COLON": "':'",
}


def _syntax_error(error: UnexpectedInput, text: str) -> ScriptError:
    from lark.exceptions import UnexpectedCharacters, UnexpectedToken

    if isinstance(error, UnexpectedToken):
        expected = _expected(error.expected)
        if error.token.type == "$END":
            return ScriptError(f"it ends in the middle of a statement{expected}")
        return _at(text, error.token.start_pos or 0, f"'{_shortened(error.token)}' cannot stand here{expected}")
    position = error.pos_in_stream or 0
    if isinstance(error, UnexpectedCharacters) and text[position] in "'\"":
        return _at(text, position, "the text that begins here does not end")
    if isinstance(error, UnexpectedCharacters) and text[position].isdigit():
        return _at(text, position, "this is not a number (digits, 0x..., 1.5 or 1.5e3)")
    return _at(text, position, f"{text[position : position + 1]!r} cannot stand here")


def _at(text: str, position: int, what: str) -> ScriptError:
    line = text.count("\n", 0, position) + 1
    column = position - text.rfind("\n", 0, position)
    return ScriptError(f"{f'line {line}, ' if line > 1 else ''}column {column}: {what}")


def _expected(expected: Collection[str]) -> str:
    # A sign is no operator where an operand is due.
    hidden = {"SIGN"} if "NUMBER" in expected else set()
    words = [word for name, word in _WORDS.items() if name in expected and name not in hidden]
    return f"; expected {', '.join(words)}" if words else ""


def _shortened(text: str) -> str:
    return text if len(text) <= 60 else f"{text[:60]}..."
