"""What can make an element unfeasible: a component that has failed, or a measure whose value lies in a region."""

from __future__ import annotations

import math
from typing import NamedTuple

from rosa_core.model.elements import shown_number

Position = tuple[float, int]
"""A place between values: ``(v, 0)`` is just before v, ``(v, 1)`` just after it."""

LEAST: Position = (-math.inf, 1)
GREATEST: Position = (math.inf, 0)


class Region(NamedTuple):
    """The values of a measure between two positions.

    >>> print(Region("visibility", LEAST, (1.25, 0)))
    visibility < 1.25
    >>> print(Region("visibility", (1.25, 0), (2.25, 1)))
    1.25 <= visibility <= 2.25
    >>> print(Region("visibility", LEAST, GREATEST))
    visibility at any value

    Args:
        measure: its name.
        low: where the region begins; :data:`LEAST` if it has no lower end.
        high: where it ends; :data:`GREATEST` if it has no upper end.
    """

    measure: str
    low: Position = LEAST
    high: Position = GREATEST

    @property
    def above(self) -> float | None:
        """The lower end, in the measure's unit; None if there is none."""
        return None if self.low == LEAST else self.low[0]

    @property
    def below(self) -> float | None:
        """The upper end, in the measure's unit; None if there is none."""
        return None if self.high == GREATEST else self.high[0]

    @property
    def is_whole(self) -> bool:
        """Whether every value lies in it."""
        return self.low == LEAST and self.high == GREATEST

    def contains(self, other: Region) -> bool:
        """Whether every value of another region of the measure lies in this one."""
        return self.low <= other.low and other.high <= self.high

    def holds(self, value: float | None) -> bool:
        """Whether a value lies in the region, in the measure's unit; None, before it is measured, does not."""
        return value is not None and self.low <= (value, 0) and (value, 1) <= self.high

    def some_value(self) -> float:
        """A value that lies in the region; the region must not be empty."""
        (low, after_low), (high, after_high) = self.low, self.high
        if not after_low:
            return low
        if after_high:
            return high
        if math.isinf(low):
            return 0.0 if math.isinf(high) else _beyond(high, -1.0)
        return _beyond(low, 1.0) if math.isinf(high) else low / 2 + high / 2

    def __str__(self) -> str:
        least = "<" if self.low[1] else "<="
        most = "<=" if self.high[1] else "<"
        if self.is_whole:
            return f"{self.measure} at any value"
        if self.above is None:
            return f"{self.measure} {most} {shown_number(self.high[0])}"
        if self.below is None:
            return f"{self.measure} {least.replace('<', '>')} {shown_number(self.low[0])}"
        if self.above == self.below:
            return f"{self.measure} = {shown_number(self.low[0])}"
        return f"{shown_number(self.low[0])} {least} {self.measure} {most} {shown_number(self.high[0])}"


def _beyond(limit: float, step: float) -> float:
    value = limit + step
    return value if value != limit and math.isfinite(value) else math.nextafter(limit, math.copysign(math.inf, step))


Cause = str | Region
"""A component that has failed, by name, or a region that a measure's value lies in."""
CauseSet = frozenset[Cause]
"""Causes that hold together: at most one region of each measure."""


def cause_key(cause: Cause) -> tuple[str, int, Position, Position]:
    """By what causes are sorted: name, failures before regions, then from low to high."""
    if isinstance(cause, Region):
        return (cause.measure, 1, cause.low, cause.high)
    return (cause, 0, LEAST, LEAST)


def sorted_causes(causes: CauseSet) -> tuple[Cause, ...]:
    """The causes by name."""
    return tuple(sorted(causes, key=cause_key))


def cause_text(cause: Cause) -> str:
    """The cause in words.

    >>> cause_text("lidar")
    'lidar failed'
    """
    return str(cause) if isinstance(cause, Region) else f"{cause} failed"


def cause_document(cause: Cause) -> dict[str, object]:
    """The cause as JSON has it. ``above`` and ``below`` are exclusive unless a key says that they are included.

    >>> cause_document("lidar")
    {'failed': 'lidar'}
    >>> cause_document(Region("light", LEAST, (0.9, 0)))
    {'measure': 'light', 'above': None, 'below': 0.9}
    >>> cause_document(Region("light", LEAST, (0.9, 1)))
    {'measure': 'light', 'above': None, 'below': 0.9, 'below_included': True}
    """
    return region_document(cause) if isinstance(cause, Region) else {"failed": cause}


def region_document(region: Region) -> dict[str, object]:
    """A region as JSON has it, see :func:`cause_document`."""
    document: dict[str, object] = {"measure": region.measure, "above": region.above, "below": region.below}
    if region.above is not None and not region.low[1]:
        document["above_included"] = True
    if region.below is not None and region.high[1]:
        document["below_included"] = True
    return document
