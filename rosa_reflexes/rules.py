"""Reflexes written in one line of text, compiled once to functions. The grammar is in ``rule.lark``.

``range.front < 0.35 -> stop; release > 0.5 for 0.3 s``: trigger, command, release condition, and for how long that must
hold. A release condition that begins with a comparison is about what the trigger compares.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosa_reflexes.reflex import Condition
from rosa_reflexes.sensors import Readings

if TYPE_CHECKING:
    from lark import Lark
    from lark.exceptions import UnexpectedInput

LONGEST = 1000
"""How many characters a rule may have."""

DEEPEST = 20
"""How deep parentheses may nest."""

_COMPARE: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_ARITHMETIC: dict[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": lambda one, other: one / other if other else math.nan,
}
_FUNCTIONS: dict[str, Callable[..., float]] = {"min": min, "max": max, "abs": abs}

Value = Callable[[Readings], float]


class RuleError(ValueError):
    """A rule that cannot be read; ``column`` counts from 1, None if the whole rule is at fault."""

    def __init__(self, what: str, column: int | None = None) -> None:
        super().__init__(what if column is None else f"{what}, at column {column}")
        self.column = column


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule that was read.

    Attributes:
        text: the rule as it is written.
        names: the sensors and parameters that it names, in order.
        sensors: those of them of whose faults it speaks; they must be sensors.
        trigger: when the reflex fires.
        trigger_text: the trigger as it is written.
        command: the name of the command.
        release: when it is over; None: when the trigger does not hold.
        release_after: for how long that must have held, s.
    """

    text: str
    names: tuple[str, ...]
    sensors: frozenset[str]
    trigger: Condition
    trigger_text: str
    command: str
    release: Condition | None
    release_after: float


def parse_rule(text: str) -> Rule:
    """Read a rule.

    >>> rule = parse_rule("range.front < 0.35 -> stop; release > 0.5 for 0.3 s")
    >>> rule.names, rule.command, rule.release_after
    (('range.front',), 'stop', 0.3)

    Raises:
        RuleError: if it is none, with the column, or if it would be released where it fires.
    """
    from lark.exceptions import LarkError, UnexpectedInput, VisitError

    if len(text) > LONGEST:
        raise RuleError(f"a rule has at most {LONGEST} characters, and this one {len(text)}")
    if _depth(text) > DEEPEST:
        raise RuleError(f"parentheses nest at most {DEEPEST} deep")
    compiler = _Compiler()
    try:
        tree = _parser().parse(text)
        return compiler.compile(text, tree)
    except UnexpectedInput as error:
        raise _unreadable(text, error) from None
    except VisitError as error:
        raise error.orig_exc from None
    except LarkError as error:
        raise RuleError(f"it cannot be read: {error}") from None


@lru_cache(maxsize=1)
def _parser() -> Lark:
    from lark import Lark

    grammar = Path(__file__).with_name("rule.lark").read_text(encoding="utf-8")
    return Lark(grammar, start="rule", parser="lalr", propagate_positions=True, maybe_placeholders=False)


def _depth(text: str) -> int:
    depth = most = 0
    for character in text:
        depth += (character == "(") - (character == ")")
        most = max(most, depth)
    return most


def _unreadable(text: str, error: UnexpectedInput) -> RuleError:
    from lark.exceptions import UnexpectedToken

    if "->" not in text:
        return RuleError("a rule says what is commanded: range.front < 0.35 -> stop")
    if isinstance(error, UnexpectedToken) and error.token.type == "$END":
        return RuleError("the rule ends too early", len(text) + 1)
    column: int = error.column
    return RuleError(f"it cannot be read from {text[column - 1 : column + 19]!r}", column)


class _Compiler:
    """Makes functions of a parsed rule, and collects the names in it."""

    def __init__(self) -> None:
        self._names: dict[str, None] = {}
        self._sensors: set[str] = set()

    def compile(self, text: str, tree: Any) -> Rule:
        trigger, command, *rest = tree.children
        duration = float(rest.pop().children[0]) if rest and rest[-1].data == "duration" else 0.0
        release = self._release(trigger, rest[0]) if rest else None
        return Rule(
            text=text,
            trigger=self._condition(trigger),
            names=tuple(self._names),
            sensors=frozenset(self._sensors),
            trigger_text=" ".join(text[trigger.meta.start_pos : trigger.meta.end_pos].split()),
            command=str(command),
            release=release,
            release_after=duration,
        )

    def _release(self, trigger: Any, release: Any) -> Condition:
        if release.data != "short":
            return self._condition(release)
        compared = _only_comparison(trigger)
        if compared is None:
            raise RuleError("the release condition needs what it compares, since the trigger is more than a comparison")
        left, fires, limit = compared.children
        released, released_at = release.children
        _check_hysteresis(str(fires), _constant(limit), str(released), _constant(released_at))
        one, compare, other = self._value(left), _COMPARE[released], self._value(released_at)
        return lambda readings: compare(one(readings), other(readings))

    def _condition(self, node: Any) -> Condition:
        children = node.children
        match node.data:
            case "condition":
                parts = [self._condition(child) for child in children]
                return parts[0] if len(parts) == 1 else lambda readings: any(part(readings) for part in parts)
            case "conjunction":
                parts = [self._condition(child) for child in children]
                return parts[0] if len(parts) == 1 else lambda readings: all(part(readings) for part in parts)
            case "negated":
                inner = self._condition(children[0])
                return lambda readings: not inner(readings)
            case "faulty":
                sensor = self._name(children[0])
                self._sensors.add(sensor)
                return lambda readings: readings.fault(sensor) is not None
            case _:
                one, compare, other = self._value(children[0]), _COMPARE[children[1]], self._value(children[2])
                return lambda readings: compare(one(readings), other(readings))

    def _value(self, node: Any) -> Value:
        children = node.children
        match node.data:
            case "number":
                number = float(children[0])
                return lambda _readings: number
            case "name":
                name = self._name(children[0])
                return lambda readings: readings[name]
            case "negative":
                inner = self._value(children[0])
                return lambda readings: -inner(readings)
            case "call":
                function, arguments = _FUNCTIONS[children[0]], [self._value(child) for child in children[1:]]
                if children[0] == "abs" and len(arguments) != 1:
                    raise RuleError("abs takes one value")
                if len(arguments) == 1:
                    only = arguments[0]
                    return (lambda readings: abs(only(readings))) if children[0] == "abs" else only
                return lambda readings: function(*[argument(readings) for argument in arguments])
            case _:
                return self._chain(children)

    def _chain(self, children: list[Any]) -> Value:
        """Operations of one rank, from the left."""
        value = self._value(children[0])
        for symbol, operand in zip(children[1::2], children[2::2], strict=True):
            value = _operation(_ARITHMETIC[symbol], value, self._value(operand))
        return value

    def _name(self, token: Any) -> str:
        self._names.setdefault(str(token))
        return str(token)


def _operation(compute: Callable[[float, float], float], one: Value, other: Value) -> Value:
    return lambda readings: compute(one(readings), other(readings))


def _only_comparison(condition: Any) -> Any:
    """The comparison that a condition consists of, None if it is more than one."""
    while condition.data in ("condition", "conjunction") and len(condition.children) == 1:
        condition = condition.children[0]
    return condition if condition.data == "comparison" else None


def _constant(node: Any) -> float | None:
    """The number that an expression is, None if it is more than a number."""
    while node.data in ("sum", "product") and len(node.children) == 1:
        node = node.children[0]
    return float(node.children[0]) if node.data == "number" else None


def _check_hysteresis(fires: str, limit: float | None, released: str, released_at: float | None) -> None:
    """A reflex that is released by a value that fires it would chatter."""
    if fires[0] == released[0]:
        raise RuleError(f"it fires when the value is {fires} and is released when it is {released}: it never ends")
    if limit is None or released_at is None:
        return
    if (fires[0] == "<" and released_at < limit) or (fires[0] == ">" and released_at > limit):
        raise RuleError(f"released at {released_at:g} it would fire again at once, since it fires {fires} {limit:g}")
