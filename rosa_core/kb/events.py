"""What the knowledge base announces after a write (``~/events`` in the ROSA paper, table 5)."""

from __future__ import annotations

from dataclasses import dataclass

from rosa_core.model.changes import Element
from rosa_core.model.records import Measurement, ReconfigurationPlan, RequiredAction, StatusChange
from rosa_core.model.status import Result


@dataclass(frozen=True, slots=True)
class Event:
    """Something that was written; events of the same write share its revision and time.

    Args:
        revision: counts the writes that changed something, from 1.
        time: when it was written, in seconds.
    """

    revision: int
    time: float


@dataclass(frozen=True, slots=True)
class MonitoringData(Event):
    """Measurements were added, component failures reported or cleared.

    Args:
        measurements: in the order in which they were added.
        failures: the components that failed.
        recoveries: the components that work again.
    """

    measurements: tuple[Measurement, ...] = ()
    failures: tuple[str, ...] = ()
    recoveries: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ActionUpdate(Event):
    """The required actions changed.

    Args:
        requested: those now required that were not.
        ended: those that ended, with their results.
    """

    requested: tuple[RequiredAction, ...] = ()
    ended: tuple[RequiredAction, ...] = ()


@dataclass(frozen=True, slots=True)
class ConfigurationSelected(Event):
    """The selection changed.

    Args:
        function_designs: names of those now selected that were not.
        component_configurations: likewise.
        unselected_function_designs: names of those no longer selected.
        unselected_component_configurations: likewise.
    """

    function_designs: tuple[str, ...] = ()
    component_configurations: tuple[str, ...] = ()
    unselected_function_designs: tuple[str, ...] = ()
    unselected_component_configurations: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ReconfigurationPlanCreated(Event):
    """There is a new plan to execute.

    Args:
        plan: the plan.
    """

    plan: ReconfigurationPlan


@dataclass(frozen=True, slots=True)
class ReconfigurationPlanEnded(Event):
    """A plan has ended.

    Args:
        plan: the plan.
        result: whether it was completed, failed, or was abandoned.
    """

    plan: ReconfigurationPlan
    result: Result


@dataclass(frozen=True, slots=True)
class ComponentActivity(Event):
    """Components started or stopped running.

    Args:
        activated: their names.
        deactivated: their names.
    """

    activated: tuple[str, ...] = ()
    deactivated: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class StatusesChanged(Event):
    """Statuses that the write changed.

    Args:
        changes: from constraints up to actions, each kind in order of declaration.
    """

    changes: tuple[StatusChange, ...] = ()


@dataclass(frozen=True, slots=True)
class KnowledgeChanged(Event):
    """Elements and relations were added to the model, or removed from it.

    Elements that are new have their statuses from the beginning; only later changes of them are announced.

    Args:
        added: elements and relations, in order.
        removed: elements and relations, in order.
    """

    added: tuple[Element, ...] = ()
    removed: tuple[Element, ...] = ()
