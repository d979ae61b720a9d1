"""The record of an execution: its outcome, its plans, its steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, StrEnum


class ExecutionStatus(Enum):
    """How far a mission has got. WAITING: there is no plan for now."""

    RUNNING = "running"
    WAITING = "waiting"
    SUCCESS = "success"
    FAILURE = "failure"

    @property
    def is_over(self) -> bool:
        """Whether the mission has come to its end."""
        return self in (ExecutionStatus.SUCCESS, ExecutionStatus.FAILURE)


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
        outcome = f"plan {' '.join(self.steps)}" if self.steps else f"no plan: {self.no_plan}"
        return f"{outcome} ({self.reason})"


class StepOutcome(StrEnum):
    """What became of a step."""

    STARTED = "started"
    COMPLETED = "completed"
    FAILED = "failed"
    INTERRUPTED = "interrupted"


@dataclass(frozen=True, slots=True)
class StepRecord:
    """What became of a step.

    Attributes:
        time: when, in s of the clock's time.
        step: the step as PDDL writes it.
        outcome: what became of it.
        reason: why, if it was not as planned.
    """

    time: float
    step: str
    outcome: StepOutcome
    reason: str = ""


class ExecutionLog:
    """Every plan and what became of the steps, kept and passed on.

    Args:
        on_plan: hears of every plan, and of every time that there is none.
        on_step: hears when a step starts and ends.
    """

    def __init__(
        self, on_plan: Callable[[PlanRecord], None] | None, on_step: Callable[[StepRecord], None] | None
    ) -> None:
        self._on_plan, self._on_step = on_plan, on_step
        self.plans: list[PlanRecord] = []
        self.steps: list[StepRecord] = []

    def add_plan(self, record: PlanRecord) -> None:
        """A plan was wanted."""
        self.plans.append(record)
        if self._on_plan is not None:
            self._on_plan(record)

    def add_step(self, record: StepRecord) -> None:
        """A step has started or ended."""
        self.steps.append(record)
        if self._on_step is not None:
            self._on_step(record)
