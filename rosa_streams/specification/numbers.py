"""Numbers in specifications."""

from __future__ import annotations

import math


def not_negative(value: object) -> float | None:
    """The value as a finite number of at least 0, or None if it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    try:
        number = float(value)
    except (ValueError, OverflowError):
        return None
    return number if math.isfinite(number) and number >= 0 else None
