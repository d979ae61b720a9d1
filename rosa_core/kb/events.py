"""What the knowledge base announces after a write (``~/events`` in the ROSA paper, table 5)."""

from __future__ import annotations

from dataclasses import dataclass

from rosa_core.model.changes import Element
from rosa_core.model.records import Measurement, ReconfigurationPlan, RequiredAction, StatusChange
from rosa_core.model.status import Result


@dataclass(frozen=True, slots=True)
class Event:
    """Something that was written; events of the same write share its revision (counted from 1) and time (seconds)."""

    revision: int
    time: float


@dataclass(frozen=True, slots=True)
class MonitoringData(Event):
    """Measurements were added, component failures reported or cleared."""

    measurements: tuple[Measurement, ...] = ()
    failures: tuple[str, ...] = ()
    recoveries: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ActionUpdate(Event):
    """The required actions changed: those now required that were not, and those that ended."""

    requested: tuple[RequiredAction, ...] = ()
    ended: tuple[RequiredAction, ...] = ()


@dataclass(frozen=True, slots=True)
class ConfigurationSelected(Event):
    """Designs and configurations that are now selected and were not, and the other way round."""

    function_designs: tuple[str, ...] = ()
    component_configurations: tuple[str, ...] = ()
    unselected_function_designs: tuple[str, ...] = ()
    unselected_component_configurations: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ReconfigurationPlanCreated(Event):
    """There is a new plan to execute."""

    plan: ReconfigurationPlan


@dataclass(frozen=True, slots=True)
class ReconfigurationPlanEnded(Event):
    """A plan was completed, failed, or was abandoned."""

    plan: ReconfigurationPlan
    result: Result


@dataclass(frozen=True, slots=True)
class ComponentActivity(Event):
    """Components started or stopped running."""

    activated: tuple[str, ...] = ()
    deactivated: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class StatusesChanged(Event):
    """Statuses that the write changed, from constraints up to actions."""

    changes: tuple[StatusChange, ...] = ()


@dataclass(frozen=True, slots=True)
class KnowledgeChanged(Event):
    """Elements and relations were added to the model, or removed from it.

    Elements that are new have their statuses from the beginning; only later changes of them are announced.
    """

    added: tuple[Element, ...] = ()
    removed: tuple[Element, ...] = ()
