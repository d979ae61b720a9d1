"""How long an execution goes on trying, and what it does not try for now."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ExecutionLimits:
    """How long the executor goes on trying. Times are in s of the clock's time.

    Attributes:
        attempts: how often a step may fail before it is no longer planned.
        retry_delay: how long a step that failed is not planned again, in s.
        patience: how long to wait while there is no plan, in s.
        replans: how many plans may be made after the first.
        step_timeout: how long a step may take, in s.
        effect_delay: how long after a step its effects may take to be seen, where they are sensed, in s.

    Raises:
        ValueError: if a limit is negative or NaN, or no attempt is left.
    """

    attempts: int = 3
    retry_delay: float = 5.0
    patience: float = 60.0
    replans: int = 200
    step_timeout: float = math.inf
    effect_delay: float = 1.0

    def __post_init__(self) -> None:
        if self.attempts < 1 or self.replans < 0:
            raise ValueError("at least one attempt is needed, and the number of replans cannot be negative")
        times = (self.retry_delay, self.patience, self.step_timeout, self.effect_delay)
        if not all(time >= 0 for time in times):
            raise ValueError("the limits of an execution cannot be negative or NaN")


class Failures:
    """Which steps failed, how often, and which of them are not to be tried (yet).

    Args:
        limits: after how many failures, and for how long.
    """

    def __init__(self, limits: ExecutionLimits) -> None:
        self._limits = limits
        self._counts: dict[str, int] = {}
        self._until: dict[str, float] = {}

    def add(self, step: str, now: float) -> None:
        """A step failed."""
        count = self._counts[step] = self._counts.get(step, 0) + 1
        self._until[step] = math.inf if count >= self._limits.attempts else now + self._limits.retry_delay

    def reset(self, step: str) -> None:
        """A step was completed: what went wrong with it before does not count."""
        self._counts.pop(step, None)
        self._until.pop(step, None)

    def suspended(self, now: float) -> dict[str, int]:
        """The steps that may not be planned now, with how often they failed."""
        return {step: self._counts[step] for step, until in self._until.items() if now < until}
