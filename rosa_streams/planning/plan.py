"""What planning gives: a change set with its cost, what is proven of it, and why there is none."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum

from rosa_streams.environment import Change, Unit


class PlanStatus(StrEnum):
    """What is proven of a plan."""

    OPTIMAL = "optimal"
    FEASIBLE = "feasible"
    NONE = "none"


@dataclass(frozen=True)
class Plan:
    """A change set that makes the environment valid.

    Attributes:
        status: proven optimal, valid but not proven optimal, or there is none.
        change: what to do; empty if there is no plan, or nothing to do.
        cost: labor and upkeep over the horizon; None if there is no plan.
        bound: no plan costs less (minus what quality is worth, where quality weighs); None if there is no plan.
        quality: the sum of the qualities of the streams that targets get.
        units: that run after the change, in order.
        why: the reason that there is none.
    """

    status: PlanStatus
    change: Change = field(default_factory=Change)
    cost: float | None = None
    bound: float | None = None
    quality: float = 0.0
    units: tuple[Unit, ...] = ()
    why: str | None = None

    @property
    def gap(self) -> float | None:
        """How far the cost may be over the optimum, relative to the cost; None without a plan or a bound."""
        if self.cost is None or self.bound is None:
            return None
        return 0.0 if self.cost <= self.bound else (self.cost - self.bound) / max(abs(self.cost), 1e-12)
