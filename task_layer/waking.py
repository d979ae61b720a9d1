"""Which events of the knowledge base concern a task layer that waits for something to happen."""

from __future__ import annotations

from collections.abc import Collection

from rosa_core import Status
from rosa_core.kb import (
    ActionUpdate,
    ComponentActivity,
    Event,
    MonitoringData,
    ReconfigurationPlanEnded,
    StatusesChanged,
)
from rosa_core.model import ElementKind

WAKING = (StatusesChanged, ActionUpdate, ComponentActivity, ReconfigurationPlanEnded)
"""A measurement that changes no status changes nothing that a task layer asks, unless it senses the measure."""


def is_reason_to_tick(event: Event, *, own: bool, measures: Collection[str] = ()) -> bool:
    """Whether a mission has to be looked at because of an event.

    Args:
        event: one of :data:`WAKING`, or the data of the monitors.
        own: whether it follows from the mission's own requests: these must not wake it again, unless they make an
            action feasible or unfeasible.
        measures: the measures that the mission senses.
    """
    if isinstance(event, MonitoringData):
        return any(measurement.measure in measures for measurement in event.measurements)
    return not own or changes_feasibility(event)


def changes_feasibility(event: Event) -> bool:
    """Whether an action became feasible or unfeasible."""
    return isinstance(event, StatusesChanged) and any(
        change.kind is ElementKind.ACTION and (change.old is Status.UNFEASIBLE) != (change.new is Status.UNFEASIBLE)
        for change in event.changes
    )
