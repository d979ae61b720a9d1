"""The configuration life cycle as facts: what disturbs a configuration, and what was done about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from rosa_streams.environment import Change, Unit
from rosa_streams.planning import Plan


class PerturbationKind(StrEnum):
    """What ends a stable interval (section IV-C of the paper)."""

    UNIT_LOST = "unit lost"
    SUBSCRIPTION_LOST = "subscription lost"
    TARGETS_CHANGED = "targets changed"
    TRANSFORMATIONS_CHANGED = "transformations changed"
    HORIZON = "horizon reached"
    REFINEMENT = "time to refine a hasty plan"
    REQUESTED = "review requested"


@dataclass(frozen=True, slots=True)
class Perturbation:
    """One disturbance: of what kind, about what, why, and when."""

    kind: PerturbationKind
    about: str
    time: float
    reason: str = ""

    def __str__(self) -> str:
        return " ".join(filter(None, (f"{self.kind}:", self.about, f"({self.reason})" if self.reason else "")))


@dataclass(frozen=True, slots=True)
class JournalEntry:
    """One review: what called for it, and what came of it.

    Attributes:
        cycle: counts reviews from 1.
        time: in seconds.
        perturbations: that called for the review.
        search: how the plan was searched for.
        plan: what was found, its change set included.
        change: what was applied, with targets and transformations that were added and removed.
        unsatisfied: for each target without a stream, why.
    """

    cycle: int
    time: float
    perturbations: tuple[Perturbation, ...]
    search: str
    plan: Plan
    change: Change
    unsatisfied: Mapping[str, str] = field(default_factory=dict)

    def as_json(self) -> dict[str, Any]:
        """The entry in plain values."""
        return {
            "cycle": self.cycle,
            "time": self.time,
            "perturbations": [str(each) for each in self.perturbations],
            "search": self.search,
            "status": str(self.plan.status),
            "cost": self.plan.cost,
            "bound": self.plan.bound,
            "created": [_unit(unit) for unit in self.change.created()],
            "reconfigured": [_unit(unit) for unit in self.change.reconfigured()],
            "unloaded": [unit.cid for unit in self.change.unloaded()],
            "targets_added": sorted(target.qid for target in self.change.targets_added),
            "targets_removed": sorted(target.qid for target in self.change.targets_removed),
            "transformations_added": sorted(each.tid for each in self.change.transformations_added),
            "transformations_removed": sorted(each.tid for each in self.change.transformations_removed),
            "unsatisfied": dict(self.unsatisfied),
        }

    def __str__(self) -> str:
        parts = [f"{self.time:g} s, cycle {self.cycle}: {'; '.join(map(str, self.perturbations)) or 'start'}"]
        for word, units in (
            ("created", self.change.created()),
            ("reconfigured", self.change.reconfigured()),
            ("unloaded", self.change.unloaded()),
        ):
            if units:
                parts.append(f"{word} {', '.join(unit.cid for unit in units)}")
        if self.plan.cost is not None:
            parts.append(f"cost {self.plan.cost:g} ({self.plan.status})")
        parts += [f"without {qid}" for qid in self.unsatisfied]
        return "; ".join(parts)


def _unit(unit: Unit) -> dict[str, Any]:
    return {
        "unit": unit.cid,
        "transformation": unit.tid,
        "inputs": dict(unit.inputs),
        "outputs": {port: list(channels) for port, channels in unit.outputs},
    }
