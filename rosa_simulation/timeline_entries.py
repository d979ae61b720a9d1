"""How a run is told: a moment is a cause and what followed from it at once, in words and as facts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from rosa_core import Status
from rosa_core.kb import (
    ActionUpdate,
    ConfigurationSelected,
    Event,
    ReconfigurationPlanEnded,
    Result,
    StatusesChanged,
)
from rosa_core.model import ElementKind

_TOLD_KINDS = (ElementKind.ACTION, ElementKind.FUNCTION_DESIGN)


@dataclass(slots=True)
class TimelineEntry:
    """A cause at a time (s), and what follows from it at once; it is told only if something does."""

    time: float
    cause: str = ""
    worth_telling: bool = False
    effects: dict[str, None] = field(default_factory=dict)
    facts: list[Mapping[str, Any]] = field(default_factory=list)

    def effect(self, effect: str) -> None:
        """Something followed that is worth telling; told once, however often it is said."""
        self.effects.setdefault(effect)
        self.worth_telling = True

    def fact(self, fact: str, **details: Any) -> None:
        """The same for programs."""
        self.facts.append({"fact": fact, **details})

    @property
    def text(self) -> str:
        """The moment in words."""
        return ": ".join(filter(None, (self.cause, ", ".join(self.effects))))


def tell_kb_event(moment: TimelineEntry, event: Event) -> None:
    """Add what an event of the knowledge base says; some say nothing worth telling."""
    if isinstance(event, StatusesChanged):
        _tell_statuses(moment, event)
    elif isinstance(event, ConfigurationSelected):
        _tell_selection(moment, event)
    elif isinstance(event, ActionUpdate):
        _tell_actions(moment, event)
    elif isinstance(event, ReconfigurationPlanEnded):
        _tell_plan(moment, event)


def _tell_statuses(moment: TimelineEntry, event: StatusesChanged) -> None:
    for change in event.changes:
        if change.kind in _TOLD_KINDS and Status.UNFEASIBLE in (change.new, change.old):
            feasible = change.new is not Status.UNFEASIBLE
            moment.effect(f"{change.name} {'feasible' if feasible else 'unfeasible'}")
    moment.fact("statuses", changes=[[c.kind.value, c.name, c.old.value, c.new.value] for c in event.changes])


def _tell_selection(moment: TimelineEntry, event: ConfigurationSelected) -> None:
    for name in event.function_designs:
        moment.effect(f"{name} selected")
    designs, configurations = list(event.function_designs), list(event.component_configurations)
    moment.fact("selected", function_designs=designs, component_configurations=configurations)


def _tell_actions(moment: TimelineEntry, event: ActionUpdate) -> None:
    ended = [[action.action, str(action.result)] for action in event.ended]
    requested = [action.action for action in event.requested]
    for name, result in ended:
        moment.effect(f"{name} {result}")
    for name in requested:
        moment.effect(f"{name} requested")
    moment.fact("actions", requested=requested, ended=ended)


def _tell_plan(moment: TimelineEntry, event: ReconfigurationPlanEnded) -> None:
    plan = event.plan
    if event.result is not Result.COMPLETED:
        moment.effect(f"reconfiguration {event.result}")
    moment.fact(
        "reconfiguration plan",
        id=plan.id,
        activate=list(plan.activate),
        deactivate=list(plan.deactivate),
        parameter_adaptations=list(plan.parameter_adaptations),
        result=event.result.value,
    )
