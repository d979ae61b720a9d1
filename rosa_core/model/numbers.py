"""Numbers as the knowledge base takes them: finite, or refused."""

from __future__ import annotations

import math

from rosa_core.errors import InvalidValueError


def finite(value: float, what: str) -> float:
    """The number as a float.

    >>> finite(3, "a measurement of depth")
    3.0

    Args:
        value: what was given.
        what: what it was to be, for the error.

    Raises:
        InvalidValueError: if it is not a finite number.
    """
    try:
        number = math.nan if isinstance(value, bool | str) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise InvalidValueError(f"{what} must be a finite number, not {_shown(value)}")
    return number


def _shown(value: object) -> str:
    try:
        return repr(value)[:60]
    except ValueError:  # an integer of thousands of digits
        return f"a {type(value).__name__} too large to print"
