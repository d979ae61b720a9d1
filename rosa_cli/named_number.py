"""Options of the form ``NAME=NUMBER``."""

from __future__ import annotations

import math

from rosa_core import InputError
from rosa_core.errors import Problem


def named_number(option: str, text: str, example: str) -> tuple[str, float]:
    """The name and the finite number of an option.

    Args:
        option: what it is called on the command line.
        text: what was given.
        example: of what could be given.

    Example:
        >>> named_number("--measure", "battery_level=0.24", "m=1")
        ('battery_level', 0.24)

    Raises:
        InputError: if the text is not of that form; it shows the example.
    """
    name, equals, value = text.rpartition("=")
    try:
        number = float(value)
    except ValueError:
        number = math.nan
    if not equals or not name or not math.isfinite(number):
        hint = f"write it as NAME=NUMBER, such as {example}"
        raise InputError(Problem(f"{option} {text}: not a name and a number", hint=hint))
    return name, number
