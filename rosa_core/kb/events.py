"""What the knowledge base announces after a write (``~/events`` in the ROSA paper, table 5), and who hears it."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from rosa_core.kb.status import Result, Status
from rosa_core.kb.utility import Utility
from rosa_core.model.elements import ElementKind

logger = logging.getLogger(__name__)


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


@dataclass(frozen=True, slots=True)
class StatusChange:
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


Subscriber = Callable[[Event], None]
ErrorHandler = Callable[[BaseException, Subscriber, Event], None]


def log_subscriber_error(error: BaseException, subscriber: Subscriber, event: Event) -> None:
    """The default for what to do when a subscriber raises: say so in the log and go on."""
    logger.error("subscriber %r raised on %s", subscriber, type(event).__name__, exc_info=error)


class EventDispatcher:
    """Delivers events in the order of their writes, each to all subscribers before the next (run to completion).

    A subscriber may write: the events of that write wait until the present one is delivered to everybody.
    A subscriber that raises is reported and does not keep the others from hearing.
    """

    def __init__(self, on_error: ErrorHandler = log_subscriber_error) -> None:
        self._on_error = on_error
        self._queue: deque[Event] = deque()
        self._delivering = threading.Lock()
        self._lock = threading.Lock()
        self._subscribers: Mapping[type[Event], tuple[Subscriber, ...]] = MappingProxyType({})
        self._registered: list[tuple[Subscriber, tuple[type[Event], ...] | None]] = []

    def subscribe(self, subscriber: Subscriber, event_types: Iterable[type[Event]] | None = None) -> Callable[[], None]:
        """Hear events of the given types, by default of all; the function returned ends that."""
        entry = (subscriber, None if event_types is None else tuple(event_types))
        with self._lock:
            self._registered.append(entry)
            self._subscribers = MappingProxyType({})

        def unsubscribe() -> None:
            with self._lock:
                self._registered = [known for known in self._registered if known is not entry]
                self._subscribers = MappingProxyType({})

        return unsubscribe

    def announce(self, events: Iterable[Event]) -> None:
        """Queue events; call while writes are still locked out, so that their order is that of the writes."""
        self._queue.extend(events)

    def deliver(self) -> None:
        """Deliver what is queued, unless that is already going on, here or in another thread."""
        while self._queue and self._delivering.acquire(blocking=False):
            try:
                while self._queue:
                    self._deliver(self._queue.popleft())
            finally:
                self._delivering.release()

    def _deliver(self, event: Event) -> None:
        for subscriber in self._listeners(type(event)):
            try:
                subscriber(event)
            except Exception as error:
                self._on_error(error, subscriber, event)

    def _listeners(self, event_type: type[Event]) -> tuple[Subscriber, ...]:
        listeners = self._subscribers.get(event_type)
        if listeners is None:
            with self._lock:
                listeners = tuple(s for s, types in self._registered if types is None or event_type in types)
                self._subscribers = MappingProxyType({**self._subscribers, event_type: listeners})
        return listeners
