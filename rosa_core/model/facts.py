"""What run-time knowledge is made of: facts, from which the rules derive everything else. Plain data.

A write is the facts that it changes, in order; a whole state is a list of facts too. The same facts in the same order
on the same model give the same state (:mod:`rosa_core.kb.restoring`): that is how a journal restores a knowledge base.
"""

from __future__ import annotations

from dataclasses import dataclass

from rosa_core.model.changes import NO_ELEMENTS, Elements
from rosa_core.model.elements import ElementKind
from rosa_core.model.records import Measurement, ReconfigurationPlan, RequiredAction
from rosa_core.model.status import Result


@dataclass(frozen=True, slots=True)
class ComponentFailure:
    """A component failed at a time (seconds), or (None) works again."""

    component: str
    since: float | None


@dataclass(frozen=True, slots=True)
class ComponentActive:
    """A component runs, or no longer."""

    component: str
    active: bool


@dataclass(frozen=True, slots=True)
class Selection:
    """A function design or component configuration is selected, or no longer."""

    kind: ElementKind
    name: str
    selected: bool


@dataclass(frozen=True, slots=True)
class ConfigurationApplied:
    """A component runs with the configuration since it was selected, or does not."""

    configuration: str
    applied: bool


@dataclass(frozen=True, slots=True)
class PendingPlan:
    """A reconfiguration plan is to be carried out."""

    plan: ReconfigurationPlan


@dataclass(frozen=True, slots=True)
class PlanEnded:
    """A reconfiguration plan ended."""

    plan: ReconfigurationPlan
    result: Result


@dataclass(frozen=True, slots=True)
class FailedPlan:
    """The plan whose work is not to be planned again for now, or None any more."""

    plan: ReconfigurationPlan | None


@dataclass(frozen=True, slots=True)
class PlanCount:
    """How many plans there have been."""

    count: int


@dataclass(frozen=True, slots=True)
class ModelChange:
    """Elements that the model gained and lost."""

    added: Elements = NO_ELEMENTS
    removed: Elements = NO_ELEMENTS


Fact = (
    Measurement
    | RequiredAction
    | ComponentFailure
    | ComponentActive
    | Selection
    | ConfigurationApplied
    | PendingPlan
    | PlanEnded
    | FailedPlan
    | PlanCount
    | ModelChange
)
