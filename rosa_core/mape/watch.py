"""Monitor the architecture itself: what the knowledge base says of components is what they do."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Iterable
from enum import Enum

from rosa_core.kb.events import Event, ReconfigurationPlanEnded
from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.mape.limits import NO_LIMITS, Limits, LimitsByComponent
from rosa_core.mape.managed_system import ComponentState, Observable
from rosa_core.model.elements import ElementKind
from rosa_core.model.records import ReconfigurationPlan
from rosa_core.model.status import Status

logger = logging.getLogger(__name__)

_USUAL = Limits()


class Finding(Enum):
    """What the knowledge base does not know yet of a component."""

    ENDED = "ended"
    STARTED = "started"


def compare(state: ComponentState, *, active: bool, starting: bool, stopping: bool) -> Finding | None:
    """What is to be written, given what a component does.

    Args:
        state: what it does.
        active: whether the knowledge base says that it runs.
        starting: whether the pending plan is to activate it; then its executor writes that it has started.
        stopping: likewise for deactivating it.

    >>> compare(ComponentState.INACTIVE, active=True, starting=False, stopping=False)
    <Finding.ENDED: 'ended'>
    """
    if state is ComponentState.UNKNOWN:
        return None
    if state is ComponentState.ACTIVE:
        return None if active or starting else Finding.STARTED
    return Finding.ENDED if active and not stopping else None


class Watch:
    """Writes to the knowledge base which components have ended or started, and which have failed by it.

    A component that ends unbidden more often than its limits allow has failed, and another design takes its place;
    else it is inactive, and if it is needed, it is configured and activated again. One that failed because it ended or
    did not do what a plan asked may be tried again when it starts, when it comes after it had been absent, or after its
    limits' ``recovery``. Failures that others report are for others to clear.

    Nothing else is known of a component whose state is ``UNKNOWN``: it stays as the knowledge base has it.

    Args:
        kb: the knowledge base, whose clock counts.
        system: what is watched: the nodes of its model.
        limits: of components by name.
        period: how often all are looked at in :meth:`run`, in s.
    """

    EVENTS = (ReconfigurationPlanEnded,)
    """The types of event that :meth:`on_event` is to hear."""

    def __init__(
        self,
        kb: KnowledgeBase,
        system: Observable,
        *,
        limits: LimitsByComponent = NO_LIMITS,
        period: float = 1.0,
    ) -> None:
        self._kb = kb
        self._system = system
        self._limits = limits
        self._period = period
        self._ends: dict[str, deque[float]] = {}
        self._failed: dict[str, float] = {}
        self._last: dict[str, ComponentState] = {}
        self._noticed: deque[str] = deque()
        self._wake = threading.Event()
        self._stopped = False

    def adopt(self) -> None:
        """Write how all components are at the beginning; that those have ended which ran before is nobody's failure.

        Those that had failed before may be tried again after their limits' ``recovery``, from now on.
        """
        statuses = self._kb.statuses(ElementKind.COMPONENT)
        for component in self._components():
            if statuses[component] is Status.FAILURE and self._limits.get(component, _USUAL).recovery is not None:
                self._failed[component] = self._kb.clock.now()
        self._check(self._components(), blame=False)

    def check(self, component: str) -> None:
        """Look at one component now, and write what the knowledge base does not know of it.

        Raises:
            UnknownElementError: if there is no such component.
        """
        self._check([component], blame=True)

    def check_all(self) -> None:
        """Look at all; what the knowledge base does not know of them is one write."""
        self._check(self._components(), blame=True)

    def on_event(self, event: Event) -> None:
        """Look at what a plan has changed: it may have ended between its activation and the end of the plan.

        Args:
            event: what was written; subscribe this method to :data:`EVENTS`.
        """
        if isinstance(event, ReconfigurationPlanEnded):
            self._check(self._changed_by(event.plan), blame=True)

    def note_failure(self, component: str) -> None:
        """A component did not do what a plan asked: when there is hope again, it may be tried again.

        Args:
            component: its name; that it has failed others write.
        """
        self._failed[component] = self._kb.clock.now()

    # -- in a thread of its own --

    def notice(self, component: str) -> None:
        """Let :meth:`run` look at a component at once. Any thread may call this."""
        self._noticed.append(component)
        self._wake.set()

    def run(self) -> None:
        """Look at what is noticed at once, and at all once in a period, until :meth:`stop`."""
        due = self._kb.clock.now() + self._period
        while not self._stopped:
            self._wake.clear()
            if self._noticed:
                self._survive(self._check_noticed)
            if self._kb.clock.now() >= due:
                self._survive(self.check_all)
                due = self._kb.clock.now() + self._period
            if not self._noticed and not self._stopped:
                self._kb.clock.wait(self._wake, max(due - self._kb.clock.now(), 0.0))

    def stop(self) -> None:
        """Let :meth:`run` return. Any thread may call this."""
        self._stopped = True
        self._wake.set()

    # -- inside --

    def _components(self) -> list[str]:
        return [component.name for component in self._kb.model.components if component.type.is_node]

    def _check_noticed(self) -> None:
        noticed: dict[str, None] = {}
        while self._noticed:
            noticed[self._noticed.popleft()] = None
        self._check(noticed, blame=True)

    def _check(self, components: Iterable[str], *, blame: bool) -> None:
        """Look at several; nobody writes between looking and writing, and what is found is one write."""
        with self._kb.transaction():
            for component in components:
                self._check_one(component, blame=blame)

    def _check_one(self, component: str, *, blame: bool) -> None:
        kb = self._kb
        state = self._system.state(component)
        pending = kb.pending_reconfiguration_plan()
        finding = compare(
            state,
            active=kb.is_component_active(component),
            starting=pending is not None and component in pending.activate,
            stopping=pending is not None and component in pending.deactivate,
        )
        if finding is Finding.ENDED:
            self._end(component, blame=blame)
        elif finding is Finding.STARTED:
            kb.set_component_active(component, True)
        self._recover(component, state)
        if state is not ComponentState.UNKNOWN:
            self._last[component] = state

    def _end(self, component: str, *, blame: bool) -> None:
        self._kb.set_component_restarted(component)
        if blame and self._ended_too_often(component):
            logger.warning("'%s' has ended unbidden and counts as failed", component)
            self._failed[component] = self._kb.clock.now()
            self._kb.set_component_failure(component)
        elif blame:
            logger.warning("'%s' has ended unbidden", component)

    def _ended_too_often(self, component: str) -> bool:
        limits, now = self._limits.get(component, _USUAL), self._kb.clock.now()
        ends = self._ends.setdefault(component, deque())
        ends.append(now)
        while ends[0] < now - limits.restarts_within:
            ends.popleft()
        if len(ends) <= limits.restarts:
            return False
        ends.clear()
        return True

    def _recover(self, component: str, state: ComponentState) -> None:
        """Clear a failure that its end, or its not doing what was asked, has caused, when there is hope again."""
        since = self._failed.get(component)
        if since is None or state in (ComponentState.UNKNOWN, ComponentState.ABSENT):
            return
        recovery = self._limits.get(component, _USUAL).recovery
        last = self._last.get(component)
        has_come = last is ComponentState.ABSENT
        has_started = state is ComponentState.ACTIVE and last is not ComponentState.ACTIVE
        waited = recovery is not None and self._kb.clock.now() >= since + recovery
        if has_started or has_come or waited:
            del self._failed[component]
            self._kb.clear_component_failure(component)

    def _changed_by(self, plan: ReconfigurationPlan) -> list[str]:
        known = {component.name for component in self._kb.model.components if component.type.is_node}
        names = dict.fromkeys((*plan.deactivate, *plan.activate))
        return [name for name in names if name in known]

    def _survive(self, look: Callable[[], None]) -> None:
        try:
            look()
        except Exception:
            logger.exception("looking at a component failed")
