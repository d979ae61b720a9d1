"""How much time and how many attempts a component gets."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rosa_core.errors import InvalidValueError


@dataclass(frozen=True, slots=True)
class Limits:
    """What is expected of one component; beyond it counts as failed.

    Args:
        activation: how long it may take to run, in s.
        deactivation: how long it may take to stop, in s.
        parameters: how long it may take to take parameters, in s.
        attempts: how often a change is tried, at least 1.
        restarts: how often it may end unbidden within ``restarts_within`` and be started again; the next time it has
            failed. With 0 the first end is a failure, so that another design takes over at once.
        restarts_within: over how long its ends are counted, in s.
        recovery: after how long a component that failed may be tried again, in s; None: not by itself.

    Raises:
        InvalidValueError: if a time is not positive, or a number is too small.
    """

    activation: float = 10.0
    deactivation: float = 10.0
    parameters: float = 5.0
    attempts: int = 3
    restarts: int = 0
    restarts_within: float = 60.0
    recovery: float | None = None

    def __post_init__(self) -> None:
        for name in ("activation", "deactivation", "parameters", "restarts_within", "recovery"):
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise InvalidValueError(f"{name} must be positive, not {value}")
        if self.attempts < 1:
            raise InvalidValueError(f"attempts must be at least 1, not {self.attempts}")
        if self.restarts < 0:
            raise InvalidValueError(f"restarts must be at least 0, not {self.restarts}")


LimitsByComponent = Mapping[str, Limits]
"""The limits of components by name; those that are not there have the usual ones."""
NO_LIMITS: LimitsByComponent = {}
