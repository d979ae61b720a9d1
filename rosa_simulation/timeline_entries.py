"""Entries of a run's timeline: a cause and what followed from it at once, in words and as facts."""

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

_REPORTED_KINDS = (ElementKind.ACTION, ElementKind.FUNCTION_DESIGN)


@dataclass(slots=True)
class TimelineEntry:
    """A cause at a time (s), and what follows from it at once.

    Attributes:
        time: when, in s of the clock.
        cause: in words; empty if nothing in particular was the cause.
        reported: whether the entry gets into the run's events.
        effects: what followed, in words and in order.
        facts: all of it for programs.
    """

    time: float
    cause: str = ""
    reported: bool = False
    effects: dict[str, None] = field(default_factory=dict)
    facts: list[Mapping[str, Any]] = field(default_factory=list)

    def effect(self, effect: str) -> None:
        """Add an effect in words, once, and let the entry be reported."""
        self.effects.setdefault(effect)
        self.reported = True

    def fact(self, fact: str, **details: Any) -> None:
        """Add a fact for programs."""
        self.facts.append({"fact": fact, **details})

    @property
    def text(self) -> str:
        """The entry in words."""
        return ": ".join(filter(None, (self.cause, ", ".join(self.effects))))


def add_kb_event(entry: TimelineEntry, event: Event) -> None:
    """Add what an event of the knowledge base says; some add nothing in words.

    Args:
        entry: changed in place.
        event: of the knowledge base.
    """
    if isinstance(event, StatusesChanged):
        _add_statuses(entry, event)
    elif isinstance(event, ConfigurationSelected):
        _add_selection(entry, event)
    elif isinstance(event, ActionUpdate):
        _add_actions(entry, event)
    elif isinstance(event, ReconfigurationPlanEnded):
        _add_plan(entry, event)


def _add_statuses(entry: TimelineEntry, event: StatusesChanged) -> None:
    for change in event.changes:
        if change.kind in _REPORTED_KINDS and Status.UNFEASIBLE in (change.new, change.old):
            feasible = change.new is not Status.UNFEASIBLE
            entry.effect(f"{change.name} {'feasible' if feasible else 'unfeasible'}")
    entry.fact("statuses", changes=[[c.kind.value, c.name, c.old.value, c.new.value] for c in event.changes])


def _add_selection(entry: TimelineEntry, event: ConfigurationSelected) -> None:
    for name in event.function_designs:
        entry.effect(f"{name} selected")
    designs, configurations = list(event.function_designs), list(event.component_configurations)
    entry.fact("selected", function_designs=designs, component_configurations=configurations)


def _add_actions(entry: TimelineEntry, event: ActionUpdate) -> None:
    ended = [[action.action, str(action.result)] for action in event.ended]
    requested = [action.action for action in event.requested]
    for name, result in ended:
        entry.effect(f"{name} {result}")
    for name in requested:
        entry.effect(f"{name} requested")
    entry.fact("actions", requested=requested, ended=ended)


def _add_plan(entry: TimelineEntry, event: ReconfigurationPlanEnded) -> None:
    plan = event.plan
    if event.result is not Result.COMPLETED:
        entry.effect(f"reconfiguration {event.result}")
    entry.fact(
        "reconfiguration plan",
        id=plan.id,
        activate=list(plan.activate),
        deactivate=list(plan.deactivate),
        parameter_adaptations=list(plan.parameter_adaptations),
        result=event.result.value,
    )
