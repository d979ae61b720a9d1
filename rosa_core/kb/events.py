"""What the knowledge base announces after a write (``~/events`` in the ROSA paper, table 5)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from rosa_core.choice.utility import Utility
from rosa_core.inference.status import Result, Status
from rosa_core.model.changes import Element
from rosa_core.model.elements import ElementKind


@dataclass(frozen=True, slots=True)
class Measurement:
    """A measured value of a measure, and when it was taken (seconds)."""

    measure: str
    value: float
    time: float


@dataclass(frozen=True, slots=True)
class RequiredAction:
    """An action that is, or was, to be performed; without a result it still is.

    ``preference`` is a measure, ``utility`` weights and limits; at most one of them is given.
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

    ``activate`` and ``deactivate`` name components; ``parameter_adaptations`` names the component configurations
    whose parameters are to be set.
    """

    id: int
    start_time: float
    activate: tuple[str, ...] = ()
    deactivate: tuple[str, ...] = ()
    parameter_adaptations: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class EndedPlan:
    """A reconfiguration plan with how and when it ended."""

    plan: ReconfigurationPlan
    end_time: float
    result: Result


class StatusChange(NamedTuple):
    """One element's status before and after a write."""

    kind: ElementKind
    name: str
    old: Status
    new: Status


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
