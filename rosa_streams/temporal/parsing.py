"""Formulas as text.

From what binds least: ``->`` (to the right), ``or``, ``and``, ``U`` and ``S`` (to the right), then ``not``, ``G``,
``F``, ``H``, ``O``, then atoms. The operators may be spelled out: always, eventually, until, historically, once, since.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Decimal, InvalidOperation
from typing import NamedTuple, NoReturn

from rosa_core.errors import nearest
from rosa_streams.errors import FormulaError, pointing
from rosa_streams.temporal.formula import (
    TICKS_PER_SECOND,
    Binary,
    Comparison,
    Constant,
    Distance,
    Formula,
    Holds,
    Interval,
    Matching,
    Not,
    Number,
    Spatial,
    Term,
    Text,
    Timed,
    TimedBinary,
    Variable,
)

LONGEST = 20_000
"""How many characters a formula may have."""

DEEPEST = 60
"""How deep a formula may be nested."""

RCC8 = ("DC", "EC", "PO", "EQ", "TPP", "NTPP", "TPPi", "NTPPi")
RELATIONS = ("inside", *RCC8)

_TOKEN = re.compile(
    r"""\s*(?:
    (?P<number>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)
    |(?P<name>[^\W\d][\w.]*)
    |(?P<text>'[^'\n]*'|"[^"\n]*")
    |(?P<sign>->|<=|>=|==|!=|&&|\|\||[<>=!&|()\[\],])
    )""",
    re.VERBOSE,
)
_SPELLINGS = {
    "always": "G", "eventually": "F", "until": "U", "historically": "H", "once": "O", "since": "S",
    "&": "and", "&&": "and", "|": "or", "||": "or", "!": "not", "implies": "->",
}  # fmt: skip
_UNARY = {"G", "F", "H", "O"}
_BINARY = {"U", "S"}
_COMPARISONS = {"<", "<=", ">", ">=", "==", "!=", "="}
_RESERVED = {*_UNARY, *_BINARY, "and", "or", "not", "true", "false", "matches", "inf", *_SPELLINGS}
_UNITS = {"us": 1, "ms": 1000, "s": 10**6, "min": 60 * 10**6, "h": 3600 * 10**6}
_FARTHEST = 10**15 * TICKS_PER_SECOND


class _Token(NamedTuple):
    kind: str
    text: str
    offset: int


def parse_formula(text: str) -> Formula:
    """Read a formula such as ``G (lost -> F[0,5] found)``; bounds are seconds unless a unit follows.

    Raises:
        FormulaError: if it cannot be read; the message points at the place.

    >>> str(parse_formula("always (x > 3 -> eventually[0, 500 ms] mode == 'attack')"))
    "G (x > 3 -> F[0,0.5] mode == 'attack')"
    """
    return _Reader(text).whole()


class _Reader:
    """A recursive-descent reader of one formula."""

    def __init__(self, text: str) -> None:
        self._text = text
        if len(text) > LONGEST:
            raise FormulaError(pointing(f"a formula has at most {LONGEST} characters; it stops", text, LONGEST))
        self._tokens = self._split()
        self._next = 0
        self._depth = 0

    def whole(self) -> Formula:
        formula = self._implication()
        token = self._peek()
        if token.kind != "end":
            self._fail(f"expected an operator or the end, found {_shown(token)}", token)
        return formula

    def _split(self) -> list[_Token]:
        tokens: list[_Token] = []
        text, at = self._text, 0
        end = len(text.rstrip())
        while at < end:
            match = _TOKEN.match(text, at)
            if match is None:
                offset = at + len(text[at:]) - len(text[at:].lstrip())
                what = "a text without its closing quote" if text[offset] in "'\"" else f"cannot read '{text[offset]}'"
                self._fail(what, _Token("sign", "", offset))
            kind = str(match.lastgroup)
            word = match[kind]
            tokens.append(_Token(kind, _SPELLINGS.get(word, word) if kind != "text" else word, match.start(kind)))
            at = match.end()
        tokens.append(_Token("end", "the end", end))
        return tokens

    def _peek(self, ahead: int = 0) -> _Token:
        return self._tokens[min(self._next + ahead, len(self._tokens) - 1)]

    def _take(self) -> _Token:
        token = self._peek()
        self._next += 1
        return token

    def _at(self, *texts: str) -> bool:
        token = self._peek()
        return token.kind != "text" and token.text in texts

    def _expect(self, text: str) -> _Token:
        token = self._take()
        if token.text != text or token.kind == "text":
            self._fail(f"expected '{text}', found {_shown(token)}", token)
        return token

    def _implication(self) -> Formula:
        self._depth += 1
        if self._depth > DEEPEST:
            self._fail(f"nested more than {DEEPEST} levels deep", self._peek())
        left = self._disjunction()
        if self._at("->"):
            self._take()
            left = Binary("->", left, self._implication())
        self._depth -= 1
        return left

    def _disjunction(self) -> Formula:
        return self._chain("or", lambda: self._chain("and", self._until))

    def _chain(self, operator: str, operand: Callable[[], Formula]) -> Formula:
        operands: list[Formula] = [operand()]
        while self._at(operator):
            self._take()
            operands.append(operand())
        return _balanced(operator, operands)

    def _until(self) -> Formula:
        left = self._unary()
        if not self._at(*_BINARY):
            return left
        operator = self._take().text
        interval = self._interval()
        self._depth += 1
        if self._depth > DEEPEST:
            self._fail(f"nested more than {DEEPEST} levels deep", self._peek())
        right = self._until()
        self._depth -= 1
        return TimedBinary(operator, interval, left, right)

    def _unary(self) -> Formula:
        prefixes: list[tuple[str, Interval]] = []
        while self._at("not", *_UNARY):
            operator = self._take().text
            prefixes.append((operator, Interval() if operator == "not" else self._interval()))
            if len(prefixes) + self._depth > DEEPEST:
                self._fail(f"nested more than {DEEPEST} levels deep", self._peek())
        formula = self._primary()
        for operator, interval in reversed(prefixes):
            formula = Not(formula) if operator == "not" else Timed(operator, interval, formula)
        return formula

    def _primary(self) -> Formula:
        if self._at("("):
            self._take()
            formula = self._implication()
            self._expect(")")
            return formula
        token = self._peek()
        if self._at("true", "false") and self._peek(1).text not in _COMPARISONS:
            self._take()
            return Constant(token.text == "true")
        if token.kind == "name" and self._peek(1).text == "(" and token.text != "distance":
            return self._spatial()
        return self._atom()

    def _spatial(self) -> Formula:
        token = self._take()
        if token.text not in RELATIONS:
            hint = nearest(token.text, (*RELATIONS, "distance")) or f"known are {', '.join(RELATIONS)} and distance"
            self._fail(f"unknown relation '{token.text}'", token, hint)
        first, second = self._pair()
        return Spatial(token.text, first, second)

    def _pair(self) -> tuple[Variable, Variable]:
        self._expect("(")
        first = self._variable()
        self._expect(",")
        second = self._variable()
        self._expect(")")
        return first, second

    def _atom(self) -> Formula:
        start = self._peek()
        left = self._term()
        token = self._peek()
        if token.kind == "sign" and token.text in _COMPARISONS:
            operator = "==" if self._take().text == "=" else token.text
            if self._at("true", "false") and operator in {"==", "!="} and isinstance(left, Variable):
                positive = (self._take().text == "true") == (operator == "==")
                return Holds(left) if positive else Not(Holds(left))
            right = self._term()
            self._comparable(left, operator, right, start)
            return Comparison(left, operator, right)
        if not isinstance(left, Variable):
            self._fail(f"expected a comparison such as < or ==, found {_shown(token)}", token)
        if self._at("matches"):
            self._take()
            pattern = self._take()
            if pattern.kind != "text":
                self._fail(f"expected a pattern in quotes, found {_shown(pattern)}", pattern)
            return Matching(left, pattern.text[1:-1])
        return Holds(left)

    def _comparable(self, left: Term, operator: str, right: Term, start: _Token) -> None:
        if isinstance(left, Number | Text) and isinstance(right, Number | Text):
            self._fail("a comparison needs a variable on one side at least", start)
        if isinstance(left, Text) or isinstance(right, Text):
            if operator not in {"==", "!="}:
                self._fail(f"texts are compared with == and !=, not {operator}", start)
            if isinstance(left, Distance) or isinstance(right, Distance):
                self._fail("a distance is no text", start)

    def _term(self) -> Term:
        token = self._peek()
        if token.kind == "number":
            self._take()
            return Number(float(token.text))
        if token.kind == "text":
            self._take()
            return Text(token.text[1:-1])
        if token.text == "distance" and self._peek(1).text == "(":
            self._take()
            return Distance(*self._pair())
        return self._variable()

    def _variable(self) -> Variable:
        token = self._take()
        if token.kind != "name" or token.text in _RESERVED:
            self._fail(f"expected a formula, found {_shown(token)}", token)
        return Variable(token.text)

    def _interval(self) -> Interval:
        if not self._at("["):
            return Interval()
        opening = self._take()
        low = self._bound()
        self._expect(",")
        if self._at("inf"):
            self._take()
            closing = self._take()
            if closing.text not in {"]", ")"}:
                self._fail(f"expected ']', found {_shown(closing)}", closing)
            return Interval(low, None)
        high = self._bound()
        self._expect("]")
        if high < low:
            self._fail("a window ends before it begins", opening, "write the lower bound first")
        return Interval(low, high)

    def _bound(self) -> int:
        token = self._take()
        if token.kind != "number":
            self._fail(f"expected a number of seconds, found {_shown(token)}", token)
        unit = _UNITS[self._take().text] if self._peek().text in _UNITS else TICKS_PER_SECOND
        try:
            ticks = Decimal(token.text) * unit
        except InvalidOperation:
            self._fail("a bound is too large", token)
        if ticks < 0:
            self._fail("a bound is at least 0", token, "past operators look back: H, O and S")
        if ticks > _FARTHEST or ticks != int(ticks):
            self._fail("a bound is a whole number of microseconds, and not beyond all measure", token)
        return int(ticks)

    def _fail(self, what: str, token: _Token, hint: str | None = None) -> NoReturn:
        raise FormulaError(pointing(what, self._text, token.offset, hint=hint))


def _balanced(operator: str, operands: list[Formula]) -> Formula:
    """A tree of small depth, whatever the number of operands."""
    if len(operands) == 1:
        return operands[0]
    middle = (len(operands) + 1) // 2
    return Binary(operator, _balanced(operator, operands[:middle]), _balanced(operator, operands[middle:]))


def _shown(token: _Token) -> str:
    return token.text if token.kind in {"end", "text"} else f"'{token.text}'"
