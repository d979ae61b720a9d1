"""Conversion of values between text, the blackboard and ports, as in BehaviorTree.CPP: without loss or not at all."""

from __future__ import annotations

import dataclasses
import math
import re
import types
from collections.abc import Callable
from enum import Enum
from typing import Any, Union, get_args, get_origin

from rosa_core import RosaError
from task_layer.bt.ports.json_values import PREFIX, dataclass_of, parse_json

_INTEGER = re.compile(r"[+-]?\d{1,19}", re.ASCII)
_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?|[+-]?inf", re.ASCII)
_LARGEST_EXACT = 2**53
_BOOLEANS = {text: value for value in (True, False) for text in (str(value), str(value).lower(), str(value).upper())}
_BOOLEANS |= {"1": True, "0": False}


class ConversionError(RosaError, ValueError):
    """A value that cannot be converted to a type, or only with a loss."""


def is_number(value: object) -> bool:
    """Whether a value counts as a number; booleans do."""
    return isinstance(value, int | float)


def to_float(value: object) -> float:
    """A number as a float."""
    if isinstance(value, float):
        return value
    if isinstance(value, int):
        if abs(value) > _LARGEST_EXACT:
            raise ConversionError(f"{value} is too large to be a floating point number")
        return float(value)
    if isinstance(value, str):
        return parse_float(value)
    raise _not_a("number", value)


def to_int(value: object) -> int:
    """A number as a whole number of 64 bits."""
    if isinstance(value, str):
        return parse_int(value)
    if isinstance(value, float):
        if not value.is_integer():
            raise ConversionError(f"{value} is not a whole number")
        value = int(value)
    if not isinstance(value, int):
        raise _not_a("whole number", value)
    if not -(2**63) <= value < 2**63:
        raise ConversionError(f"{value} has more than 64 bits")
    return int(value)


def to_bool(value: object) -> bool:
    """A number as a truth value: a whole number must be 0 or 1, another must not be negative."""
    if isinstance(value, int):
        if value not in (0, 1):
            raise ConversionError(f"{value} is neither true nor false")
        return bool(value)
    if isinstance(value, float):
        if value < 0:
            raise ConversionError(f"{value} is neither true nor false")
        return value != 0
    raise _not_a("truth value", value)


def to_text(value: object) -> str:
    """A text or a number as a text; floating point numbers get six decimals."""
    if isinstance(value, str):
        return value
    if isinstance(value, int):
        return str(int(value))
    if isinstance(value, float):
        return f"{value:f}"
    raise _not_a("text", value)


def parse_int(text: str) -> int:
    """Read a whole number."""
    if not _INTEGER.fullmatch(text.strip()):
        return to_int(parse_float(text)) if _NUMBER.fullmatch(text.strip()) else _refuse(text, "a whole number")
    return to_int(int(text))


def parse_float(text: str) -> float:
    """Read a number."""
    number = float(text) if _NUMBER.fullmatch(text.strip()) else _refuse(text, "a number")
    if math.isinf(number) and "inf" not in text:
        _refuse(text, "a number that can be held")
    return float(number)


def parse_bool(text: str) -> bool:
    """Read ``true`` or ``false``, also in capitals, or ``1`` or ``0``."""
    value = _BOOLEANS.get(text.strip())
    return _refuse(text, "true or false") if value is None else value


def number_or_text(text: str) -> int | float | str:
    """The number that a text is as a whole, or the text.

    >>> number_or_text("5"), number_or_text("0.5"), number_or_text("5 m")
    (5, 0.5, '5 m')
    """
    try:
        if _INTEGER.fullmatch(text):
            return parse_int(text)
        return parse_float(text) if _NUMBER.fullmatch(text) and "inf" not in text else text
    except ConversionError:
        return text


def parse(text: str, wanted: Any) -> Any:
    """Read a text as a value of a type.

    Args:
        text: the text.
        wanted: ``str``, ``int``, ``float``, ``bool``, an ``Enum`` (by name or number), ``list[...]`` of these with
            ``;`` between the items, one of these or None; with ``str`` and ``object`` the text is left as it is. JSON
            after ``json:`` may be one of these, a ``dict``, a ``list`` or a dataclass.

    Raises:
        ConversionError: if the text is no such value, or values of that type cannot be read from text.

    >>> parse("1;2", list[int])
    [1, 2]
    """
    wanted = without_none(wanted)
    if wanted in (str, object, Any):
        return text
    if text.startswith(PREFIX):
        return _from_json(text, wanted)
    if wanted in _PARSERS:
        return _PARSERS[wanted](text)
    if isinstance(wanted, type) and issubclass(wanted, Enum):
        return _member(text, wanted)
    if get_origin(wanted) is list:
        (item,) = get_args(wanted)
        return [parse(part, item) for part in text.split(";")] if text else []
    raise ConversionError(f"there is no way to read {type_name(wanted)} from text; use an entry of the blackboard")


def _from_json(text: str, wanted: Any) -> Any:
    shown = text if len(text) <= 60 else f"{text[:60]}..."
    try:
        value = parse_json(text)
    except ValueError as error:
        raise ConversionError(f"{shown!r} is no JSON: {error}") from None
    try:
        return _of_json(value, wanted)
    except (ValueError, TypeError) as error:
        raise ConversionError(f"{shown!r}: {error}") from None


def _of_json(value: Any, wanted: Any) -> Any:
    """A value of JSON as one of a type."""
    wanted = without_none(wanted)
    if isinstance(wanted, type) and dataclasses.is_dataclass(wanted):
        return dataclass_of(value, wanted, _of_json)
    if get_origin(wanted) is list:
        if not isinstance(value, list):
            raise ValueError("it is no list")
        (item,) = get_args(wanted)
        return [_of_json(each, item) for each in value]
    if get_origin(wanted) is dict and isinstance(value, dict):
        _, item = get_args(wanted)
        return {name: _of_json(each, item) for name, each in value.items()}
    return converted(value, wanted)


def converted(value: object, wanted: Any) -> Any:
    """A value converted to a type without loss.

    Raises:
        ConversionError: if that is not possible.

    >>> converted(2.0, int), converted("on", str)
    (2, 'on')
    """
    wanted = without_none(wanted)
    if wanted in (object, Any):
        return value
    if isinstance(value, str) and wanted is not str and not _is(value, wanted):
        return parse(value, wanted)
    if wanted in _CONVERTERS:
        return _CONVERTERS[wanted](value)
    if get_origin(wanted) is list and isinstance(value, list | tuple):
        (item,) = get_args(wanted)
        return [converted(each, item) for each in value]
    if _is(value, wanted):
        return value
    if isinstance(wanted, type) and issubclass(wanted, Enum) and is_number(value):
        return _member(str(to_int(value)), wanted)
    raise _not_a(type_name(wanted), value)


def without_none(wanted: Any) -> Any:
    """The type ``T`` of a ``T | None``."""
    if get_origin(wanted) in (Union, types.UnionType):
        rest = [kind for kind in get_args(wanted) if kind is not types.NoneType]
        return rest[0] if len(rest) == 1 else object
    return wanted


def type_name(wanted: Any) -> str:
    """The name of a type, for messages."""
    return getattr(wanted, "__name__", str(wanted)) if get_origin(wanted) is None else str(wanted)


def _member(text: str, wanted: type[Enum]) -> Enum:
    for name, member in wanted.__members__.items():
        if text.strip() in (name, str(member.value)):
            return member
    raise ConversionError(f"{text[:60]!r} is not one of {', '.join(wanted.__members__)}")


def _is(value: object, wanted: Any) -> bool:
    return isinstance(wanted, type) and isinstance(value, wanted)


def _refuse(text: str, wanted: str) -> Any:
    shown = text if len(text) <= 60 else f"{text[:60]}..."
    raise ConversionError(f"{shown!r} is not {wanted}")


def _not_a(wanted: str, value: object) -> ConversionError:
    shown = f"the text {value[:60]!r}" if isinstance(value, str) else f"a value of type {type(value).__name__}"
    return ConversionError(f"{shown} is not a {wanted}")


_PARSERS: dict[Any, Callable[[str], Any]] = {int: parse_int, float: parse_float, bool: parse_bool}
_CONVERTERS: dict[Any, Callable[[object], Any]] = {int: to_int, float: to_float, bool: to_bool, str: to_text}
