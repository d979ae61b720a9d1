"""What there is to say about the execution of plans: its limits, its outcome, its record."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, StrEnum
from typing import Protocol, TypeAlias

_log = logging.getLogger(__name__)


class Named(Protocol):
    """A step or a sensed fact: something of the mission in which code of others runs."""

    @property
    def name(self) -> str:
        """As PDDL writes it."""
        ...


OnRaise: TypeAlias = Callable[[Named, Exception], None]


def log_raised(who: Named, error: Exception) -> None:
    """Log that the skill of a step, or a sensor, raised."""
    _log.error("%s raised", who.name, exc_info=error)


class ExecutionStatus(Enum):
    """How far a mission has got. WAITING: there is no plan for now."""

    RUNNING = "running"
    WAITING = "waiting"
    SUCCESS = "success"
    FAILURE = "failure"


@dataclass(frozen=True, slots=True)
class ExecutionLimits:
    """How long the executor goes on trying. Times are in s of the clock's time.

    Attributes:
        attempts: how often a step may fail before it is no longer planned.
        retry_delay: how long a step that failed is not planned again.
        patience: how long to wait while there is no plan.
        replans: how many plans may be made after the first.
        step_timeout: how long a step may take.
        effect_delay: how long after a step its effects may take to be seen, where they are sensed.
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


@dataclass(frozen=True, slots=True)
class PlanRecord:
    """One time that a plan was wanted.

    Attributes:
        time: when, in s of the clock's time.
        reason: why the plan before was not good any more.
        steps: the plan as PDDL writes it; empty if there is none.
        kept: how many of the steps, the first ones, were already running.
        no_plan: why there is no plan; empty if there is one.
        cached: whether the plan was known from before.
        engine: what made it.
        cost_s: the wall-clock time that it took, in s.
    """

    time: float
    reason: str
    steps: tuple[str, ...]
    kept: int
    no_plan: str
    cached: bool
    engine: str
    cost_s: float

    def __str__(self) -> str:
        told = f"plan {' '.join(self.steps)}" if self.steps else f"no plan: {self.no_plan}"
        return f"{told} ({self.reason})"


class StepOutcome(StrEnum):
    """What became of a step."""

    STARTED = "started"
    COMPLETED = "completed"
    FAILED = "failed"
    INTERRUPTED = "interrupted"


@dataclass(frozen=True, slots=True)
class StepRecord:
    """Something that happened to a step, at a time in s, with the reason if it was not as planned."""

    time: float
    step: str
    outcome: StepOutcome
    reason: str = ""


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

    def barred(self, now: float) -> dict[str, int]:
        """The steps that may not be planned now, with how often they failed."""
        return {step: self._counts[step] for step, until in self._until.items() if now < until}
