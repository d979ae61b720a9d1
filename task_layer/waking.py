"""Which events of the knowledge base concern a task layer that waits for something to happen."""

from __future__ import annotations

from rosa_core import Status
from rosa_core.kb import ActionUpdate, ComponentActivity, Event, ReconfigurationPlanEnded, StatusesChanged
from rosa_core.model import ElementKind

WAKING = (StatusesChanged, ActionUpdate, ComponentActivity, ReconfigurationPlanEnded)
"""A measurement that changes no status changes nothing that a task layer asks."""


def changes_feasibility(event: Event) -> bool:
    """Whether an action became feasible or unfeasible."""
    return isinstance(event, StatusesChanged) and any(
        change.kind is ElementKind.ACTION and (change.old is Status.UNFEASIBLE) != (change.new is Status.UNFEASIBLE)
        for change in event.changes
    )
