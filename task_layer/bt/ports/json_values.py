"""Values of ports that are written as JSON: ``json:{"x": 1}`` (BehaviorTree.CPP 4.6 and later)."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from typing import Any, NoReturn, get_type_hints

PREFIX = "json:"


def parse_json(text: str) -> Any:
    """The value of a text that begins with ``json:``.

    Raises:
        ValueError: if it is no JSON.
    """
    try:
        return json.loads(text[len(PREFIX) :], parse_constant=_refuse_constant)
    except RecursionError:
        raise ValueError("it is nested too deep") from None


def dataclass_of(value: Any, wanted: Any, convert: Callable[[Any, Any], Any]) -> Any:
    """A dataclass whose fields are the members of a JSON object.

    Args:
        value: the JSON object.
        wanted: the dataclass.
        convert: converts the value of a member to the type of its field.

    Raises:
        ValueError: if it is no object, or its members are not the fields.
    """
    if not isinstance(value, dict):
        raise ValueError(f"{wanted.__name__} must be an object, such as {{...}}")
    hints = get_type_hints(wanted)
    fields = {field.name: field for field in dataclasses.fields(wanted) if field.init}
    unknown = [name for name in value if name not in fields]
    if unknown:
        raise ValueError(f"{wanted.__name__} has no field '{unknown[0][:60]}' (it has {', '.join(fields)})")
    missing = [
        name
        for name, field in fields.items()
        if name not in value and field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
    ]
    if missing:
        raise ValueError(f"{wanted.__name__} needs the field '{missing[0]}'")
    return wanted(**{name: convert(member, hints[name]) for name, member in value.items()})


def _refuse_constant(name: str) -> NoReturn:
    raise ValueError(f"{name} is not a number in JSON")
