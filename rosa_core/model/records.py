"""What a knowledge base holds of what happens at run time (ROSA paper, section 5.1, table 4): plain data, with times.

Times are seconds, from the knowledge base's clock.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from rosa_core.model.elements import ElementKind
from rosa_core.model.status import Result, Status
from rosa_core.model.utility import Utility


@dataclass(frozen=True, slots=True)
class Measurement:
    """A measured value of a measure.

    Args:
        measure: its name.
        value: in the measure's unit.
        time: when it was taken, in seconds.
    """

    measure: str
    value: float
    time: float


@dataclass(frozen=True, slots=True)
class RequiredAction:
    """An action that is, or was, to be performed; without a result it still is (ROSA paper, table 4).

    Args:
        action: its name.
        start_time: since when, in seconds.
        preference: the measure of which its configuration is to have as much as possible.
        end_time: until when, in seconds.
        result: how it ended.
        utility: weights and limits on estimated measures; only without a preference.
    """

    action: str
    start_time: float
    preference: str | None = None
    end_time: float | None = None
    result: Result | None = None
    utility: Utility | None = None

    @property
    def decided_by(self) -> Utility | None:
        """What decides between the action's configurations; None: priorities do."""
        return self.utility if self.preference is None else Utility.preferring(self.preference)


@dataclass(frozen=True, slots=True)
class ReconfigurationPlan:
    """How to bring the robot's architecture to the selected configuration (ROSA paper, table 4).

    Args:
        id: counts the plans of a knowledge base from 1.
        start_time: when it was made, in seconds.
        activate: the components to start.
        deactivate: the components to stop.
        parameter_adaptations: the component configurations whose parameters are to be set.
    """

    id: int
    start_time: float
    activate: tuple[str, ...] = ()
    deactivate: tuple[str, ...] = ()
    parameter_adaptations: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class EndedPlan:
    """A reconfiguration plan that has ended.

    Args:
        plan: as it was made.
        end_time: when it ended, in seconds.
        result: how it ended.
    """

    plan: ReconfigurationPlan
    end_time: float
    result: Result


class StatusChange(NamedTuple):
    """One element's status before and after a write.

    Args:
        kind: of the element.
        name: of the element; for a constraint the constraint in words.
        old: before.
        new: after.
    """

    kind: ElementKind
    name: str
    old: Status
    new: Status


TOPICS: tuple[str, ...] = ("measurements", "statuses", "required_actions", "reconfiguration_plans")
"""What a history is kept of."""


class TimedStatusChange(NamedTuple):
    """A status change and when it happened (seconds)."""

    change: StatusChange
    time: float


HistoryEntry = Measurement | TimedStatusChange | RequiredAction | EndedPlan


def concerns(entry: HistoryEntry, name: str | None) -> bool:
    """Whether an entry is about the measure, element or action of that name; None is all of them.

    Args:
        entry: of the history.
        name: of a measure, element or action, of whatever kind.
    """
    return name is None or name in _names(entry)


def _names(entry: HistoryEntry) -> tuple[str, ...]:
    if isinstance(entry, Measurement):
        return (entry.measure,)
    if isinstance(entry, TimedStatusChange):
        return (entry.change.name,)
    if isinstance(entry, RequiredAction):
        return (entry.action,)
    plan = entry.plan
    return (*plan.activate, *plan.deactivate, *plan.parameter_adaptations)
