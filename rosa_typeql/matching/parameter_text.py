"""Component parameters as TypeQL has them: values written as text, beside the name of their type."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from rosa_core.model.elements import ParameterType, ParameterValue, Scalar

_ITEM = re.compile(r"""\s*("(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^,\[\]]*?)\s*(,|$)""", re.DOTALL)


def parameter_value(text: str, wanted: ParameterType) -> ParameterValue | None:
    """The value that a text is of a type.

    Args:
        text: booleans are ``true`` and ``false`` in any case, numbers as usual and finite, arrays ``[a, b]``, whose
            texts may be quoted.
        wanted: the type.

    Returns:
        the value; None if the text is none of that type.

    >>> parameter_value("[0.5, 2]", ParameterType.DOUBLE_ARRAY)
    (0.5, 2.0)
    """
    if not wanted.value.endswith("_array"):
        return _CONVERSIONS[wanted](text)
    items = _items(text)
    if items is None:
        return None
    convert = _CONVERSIONS[ParameterType(wanted.value.removesuffix("_array"))]
    values = [convert(item) for item in items]
    return None if None in values else tuple(value for value in values if value is not None)


def suggested_type(text: str) -> ParameterType:
    """The type that a text looks like: the first of boolean, long, double, an array of these or of texts, text.

    >>> suggested_type("[1, 2]").value
    'long_array'
    """
    scalars = ("boolean", "long", "double")
    arrays = (*(f"{scalar}_array" for scalar in scalars), "string_array") if _items(text) else ()
    kinds = map(ParameterType, (*scalars, *arrays))
    return next((kind for kind in kinds if parameter_value(text, kind) is not None), ParameterType.STRING)


def parameter_text(value: ParameterValue) -> str:
    """The text of a value; :func:`parameter_value` of it, with the value's type, is the value again.

    >>> parameter_text((True, False))
    '[true, false]'
    """
    if isinstance(value, tuple):
        return f"[{', '.join(_item_text(item) for item in value)}]"
    return _scalar_text(value)


def _scalar_text(value: Scalar) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _item_text(item: Scalar) -> str:
    if not isinstance(item, str) or (item and item == item.strip() and not re.search(r"[\[\],'\"\\]", item)):
        return _scalar_text(item)
    escaped = item.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _items(text: str) -> list[str] | None:
    inside = text.strip()
    if len(inside) < 2 or inside[0] != "[" or inside[-1] != "]":
        return None
    inside = inside[1:-1].strip()
    if not inside:
        return []
    items = []
    at = 0
    while at <= len(inside):
        match = _ITEM.match(inside, at)
        if match is None or (match.end() == len(inside) and match[2] and not inside[at : match.start(2)].strip()):
            return None
        items.append(_unquoted(match[1]))
        if not match[2]:
            return items
        at = match.end()
    return None


def _unquoted(item: str) -> str:
    if len(item) > 1 and item[0] == item[-1] and item[0] in "\"'":
        return re.sub(r"\\(.)", r"\1", item[1:-1], flags=re.DOTALL)
    return item


def _boolean(text: str) -> bool | None:
    return {"true": True, "false": False}.get(text.strip().lower())


def _long(text: str) -> int | None:
    return int(text) if re.fullmatch(r"\s*[+-]?[0-9]{1,19}\s*", text) else None


def _double(text: str) -> float | None:
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def _string(text: str) -> str | None:
    return text


_CONVERSIONS: dict[ParameterType, Callable[[str], Scalar | None]] = {
    ParameterType.BOOLEAN: _boolean,
    ParameterType.LONG: _long,
    ParameterType.DOUBLE: _double,
    ParameterType.STRING: _string,
}
