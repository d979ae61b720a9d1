"""The operators of the scripting language, on values of the blackboard."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence

from task_layer.bt.ports.conversion import is_number, parse_float, to_bool, to_float, to_int, to_text
from task_layer.bt.scripting.scope import Evaluate, Scope, ScriptError, joined

Operation = Callable[[object, object], object]

_EPSILON = 2.0**-23
"""Numbers this near to each other are equal: the resolution of a float of 32 bits."""


def chain(operands: Sequence[Evaluate], operators: Sequence[str]) -> Evaluate:
    """``a + b - c``: all operators of one level, from the left."""
    steps = tuple((_OPERATIONS[symbol], operand) for symbol, operand in zip(operators, operands[1:], strict=True))
    first = operands[0]

    def evaluate(scope: Scope) -> object:
        value = first(scope)
        for operation, operand in steps:
            value = operation(value, operand(scope))
        return value

    return evaluate if steps else first


def comparison(operands: Sequence[Evaluate], operators: Sequence[str]) -> Evaluate:
    """``a < b < c``: 1 if each comparison with its neighbour holds, otherwise 0."""
    steps = tuple((_COMPARISONS[symbol], operand) for symbol, operand in zip(operators, operands[1:], strict=True))
    first = operands[0]

    def evaluate(scope: Scope) -> object:
        left = first(scope)
        for holds, operand in steps:
            right = operand(scope)
            if not holds(*_comparable(left, right, scope.enums)):
                return 0.0
            left = right
        return 1.0

    return evaluate


def prefixed(symbols: Sequence[str], operand: Evaluate) -> Evaluate:
    """``-a``, ``!a`` or ``~a``, any number of them."""
    operations = tuple(_PREFIXES[symbol] for symbol in reversed(symbols))

    def evaluate(scope: Scope) -> object:
        value = operand(scope)
        for operation in operations:
            value = operation(value)
        return value

    return evaluate if operations else operand


def conditional(condition: Evaluate, then: Evaluate, otherwise: Evaluate) -> Evaluate:
    """``a ? b : c``; the condition is a number, or a text that is one."""

    def evaluate(scope: Scope) -> object:
        return then(scope) if to_float(condition(scope)) != 0.0 else otherwise(scope)

    return evaluate


def number_in_text(text: str, enums: Mapping[str, float]) -> float:
    """The number that a text stands for where a number is needed: true, false, an enum's name, or a number."""
    if text in ("true", "false"):
        return float(text == "true")
    return float(enums[text]) if text in enums else parse_float(text)


def arithmetic(symbol: str, left: object, right: object) -> object:
    """One of ``+ - * /`` on two numbers."""
    return _ARITHMETIC[symbol](to_float(left), to_float(right))


def _divided(left: float, right: float) -> float:
    if right == 0.0:
        if left == 0.0 or math.isnan(left):
            return math.nan
        return math.copysign(math.inf, left) * math.copysign(1.0, right)
    return left / right


def _arithmetic(symbol: str) -> Operation:
    def apply(left: object, right: object) -> object:
        if symbol == "+" and isinstance(left, str) and isinstance(right, str):
            return joined(left, right)
        _numbers(symbol, left, right)
        return arithmetic(symbol, left, right)

    return apply


def _bits(symbol: str) -> Operation:
    operation: Callable[[int, int], int] = _BIT_OPERATIONS[symbol]

    def apply(left: object, right: object) -> object:
        _numbers(symbol, left, right)
        # BehaviorTree.CPP refuses whole numbers that a double cannot hold here too.
        to_float(left), to_float(right)
        return float(operation(to_int(left), to_int(right)))

    return apply


def _logical(symbol: str) -> Operation:
    def apply(left: object, right: object) -> object:
        _numbers(symbol, left, right)
        one, other = to_bool(left), to_bool(right)
        return float(one and other if symbol == "&&" else one or other)

    return apply


def _concatenated(left: object, right: object) -> object:
    if isinstance(left, str) or isinstance(right, str):
        return joined(to_text(left), to_text(right))
    raise ScriptError("'..' needs a text on one side at least")


def _numbers(symbol: str, *values: object) -> None:
    if not all(is_number(value) for value in values):
        raise ScriptError(f"'{symbol}' cannot be applied to {' and '.join(_kind(value) for value in values)}")


def _kind(value: object) -> str:
    if isinstance(value, str):
        return "a text"
    return "a number" if is_number(value) else f"a {type(value).__name__}"


def _negated(value: object) -> object:
    _numbers("-", value)
    return -to_float(value)


def _not(value: object) -> object:
    _numbers("!", value)
    return float(to_float(value) == 0.0)


def _complement(value: object) -> object:
    _numbers("~", value)
    number = to_float(value)
    if not abs(number) < 2.0**63:
        raise ScriptError(f"'~' cannot be applied to {number}")
    return float(~int(number))


def _comparable(left: object, right: object, enums: Mapping[str, float]) -> tuple[object, object]:
    if isinstance(left, str) and isinstance(right, str):
        return left, right
    if not (isinstance(left, str) or is_number(left)) or not (isinstance(right, str) or is_number(right)):
        raise ScriptError(f"{_kind(left)} and {_kind(right)} cannot be compared")
    return _comparison_number(left, enums), _comparison_number(right, enums)


def _comparison_number(value: object, enums: Mapping[str, float]) -> float:
    return number_in_text(value, enums) if isinstance(value, str) else to_float(value)


def _same(left: object, right: object) -> bool:
    if isinstance(left, float) and isinstance(right, float):
        return abs(left - right) <= _EPSILON
    return left == right


# As in BehaviorTree.CPP each order is the opposite of its contrary, so that it holds if one side is not a number.
_COMPARISONS: dict[str, Callable[..., bool]] = {
    "==": _same,
    "!=": lambda left, right: not _same(left, right),
    "<": lambda left, right: not left >= right,
    ">": lambda left, right: not left <= right,
    "<=": lambda left, right: not left > right,
    ">=": lambda left, right: not left < right,
}
_ARITHMETIC: dict[str, Callable[[float, float], float]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": _divided,
}
_BIT_OPERATIONS: dict[str, Callable[[int, int], int]] = {"&": operator.and_, "|": operator.or_, "^": operator.xor}
_PREFIXES: dict[str, Callable[[object], object]] = {"-": _negated, "!": _not, "~": _complement}
_OPERATIONS: dict[str, Operation] = {
    **{symbol: _arithmetic(symbol) for symbol in _ARITHMETIC},
    **{symbol: _bits(symbol) for symbol in _BIT_OPERATIONS},
    **{symbol: _logical(symbol) for symbol in ("&&", "||")},
    "..": _concatenated,
}
