"""How a journal is kept: what a write waits for, and which writes stay."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

from rosa_core.errors import InvalidValueError


@dataclass(frozen=True, slots=True)
class Retention:
    """Which writes a journal keeps; the state itself is always kept.

    Attributes:
        writes: the last so many. None: however many there are.
        seconds: those not older than this, counted back from the last write. None: however old.

    With both, a write is dropped when neither keeps it. Writes are dropped a snapshot at a time, which leaves somewhat
    more than asked for: up to as many as lie between two snapshots.

    Raises:
        InvalidValueError: for negative numbers, and seconds that are not finite.
    """

    writes: int | None = None
    seconds: float | None = None

    def __post_init__(self) -> None:
        for what, value in (("writes", self.writes), ("seconds", self.seconds)):
            if value is not None and not (value >= 0 and math.isfinite(value)):
                raise InvalidValueError(f"a retention of {value} {what} cannot be; give a number from 0 up, or None")

    @property
    def keeps_everything(self) -> bool:
        """Whether no write is ever to go."""
        return self.writes is None and self.seconds is None


@dataclass(frozen=True, slots=True)
class JournalOptions:
    """How a journal is kept.

    Attributes:
        synchronous: what a write waits for. ``NORMAL``: the operating system has it; it survives the death of the
            process, but the last writes may be lost if the power fails. ``FULL``: the disk has it. Neither ever leaves
            the journal damaged.
        retention: which writes are kept; by default all.
        snapshot_every: after how many writes all facts are written down at once, so that reopening starts there. With
            more facts than that, after as many writes as there are facts.

    Raises:
        InvalidValueError: for any other ``synchronous``, or a ``snapshot_every`` below 1.
    """

    synchronous: Literal["NORMAL", "FULL"] = "NORMAL"
    retention: Retention = field(default_factory=Retention)
    snapshot_every: int = 1000

    def __post_init__(self) -> None:
        if self.synchronous not in ("NORMAL", "FULL"):
            raise InvalidValueError(f"synchronous is 'NORMAL' or 'FULL', not {self.synchronous!r}")
        if self.snapshot_every < 1:
            raise InvalidValueError(f"snapshot_every must be at least 1, not {self.snapshot_every}")
