"""What run-time knowledge is made of: facts, from which the rules derive everything else.

A write is the facts that it changes, in order. A whole state is a list of facts too. Doing facts again
(:func:`apply`) on the same model gives the same state: that is how a journal restores a knowledge base.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from rosa_core.inference.status import Result
from rosa_core.kb.events import Measurement, ReconfigurationPlan, RequiredAction
from rosa_core.kb.reconfiguration import declared_order
from rosa_core.model.changes import NO_ELEMENTS, Elements
from rosa_core.model.elements import ElementKind

if TYPE_CHECKING:
    from rosa_core.kb.state import RuntimeState
    from rosa_core.kb.transaction import Transaction


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
class PlanMade:
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
class PlansMade:
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
    | PlanMade
    | PlanEnded
    | FailedPlan
    | PlansMade
    | ModelChange
)


def facts_of(state: RuntimeState) -> Iterator[Fact]:
    """The facts that make up a state, given its model."""
    reasoner = state.reasoner
    for name, measure in reasoner.measures.items():
        if measure.value is not None and measure.time is not None:
            yield Measurement(name, measure.value, measure.time)
    failed = (component for component in reasoner.components.values() if component.failed_since is not None)
    yield from (ComponentFailure(component.name, component.failed_since) for component in failed)
    for component in declared_order(reasoner.active_components):
        yield ComponentActive(component.name, True)
    yield from state.required.values()
    for design in declared_order(reasoner.selected_designs):
        yield Selection(design.kind, design.name, True)
    for configuration in declared_order(reasoner.selected_configurations):
        yield Selection(configuration.kind, configuration.name, True)
        if configuration.applied:
            yield ConfigurationApplied(configuration.name, True)
    if state.pending_plan is not None:
        yield PlanMade(state.pending_plan)
    if state.failed_plan is not None:
        yield FailedPlan(state.failed_plan)
    yield PlansMade(state.plans_made)


def apply(state: RuntimeState, tx: Transaction, fact: Fact) -> None:
    """Do a fact again, by the step of the write that it came from.

    Raises:
        LookupError: if it names something that the model does not have.
        KnowledgeModelError: if it changes the model in a way that does not hold together.
    """
    reasoner = state.reasoner
    match fact:
        case Measurement(measure, value, time):
            state.measure(tx, reasoner.measures[measure], value, time)
        case RequiredAction(action):
            state.set_required(tx, reasoner.actions[action], fact)
        case ComponentFailure(component, since):
            state.set_failure(tx, reasoner.components[component], since)
        case ComponentActive(component, active):
            state.set_active(tx, reasoner.components[component], active)
        case Selection(ElementKind.FUNCTION_DESIGN, name, selected):
            state.select_design(tx, reasoner.designs[name], selected)
        case Selection(_, name, selected):
            state.select_configuration(tx, reasoner.configurations[name], selected)
        case ConfigurationApplied(configuration, applied):
            state.set_applied(tx, reasoner.configurations[configuration], applied)
        case _:
            _apply_to_plans_or_model(state, tx, fact)


def _apply_to_plans_or_model(
    state: RuntimeState, tx: Transaction, fact: PlanMade | PlanEnded | FailedPlan | PlansMade | ModelChange
) -> None:
    match fact:
        case PlanMade(plan):
            state.set_pending_plan(tx, plan)
        case PlanEnded():
            state.set_pending_plan(tx, None)
        case FailedPlan(plan):
            state.note_failed_plan(tx, plan)
        case PlansMade(count):
            state.plans_made = count
        case ModelChange(added, removed):
            from rosa_core.kb.growth import change_model

            change_model(state, tx, added, removed)
