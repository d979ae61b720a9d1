"""Execute: carry a reconfiguration plan out on the managed system (ROSA paper, section 6.2.4)."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from rosa_core.kb.events import Event, ReconfigurationPlanCreated, ReconfigurationPlanEnded
from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.mape.component_change import ComponentChange
from rosa_core.mape.limits import NO_LIMITS, Limits, LimitsByComponent
from rosa_core.mape.managed_system import Announcing, Answer, ComponentState, ManagedSystem, Observable
from rosa_core.model.records import ReconfigurationPlan
from rosa_core.model.status import Result

logger = logging.getLogger(__name__)

LOOK_EVERY = 0.05
"""How often the state of a component that is being changed is asked, in s, if its system does not announce changes."""


@dataclass(frozen=True, slots=True)
class _Step:
    """A component, what is done to it (None: nothing to do), and whether it is active afterwards (None: as before)."""

    component: str
    change: ComponentChange | None
    active: bool | None


@dataclass(slots=True)
class _Progress:
    """What of a plan has been done: which components are active now or no longer, and which have failed.

    Of the former, ``written`` are those that are in the knowledge base already, ``activity`` those that are not.
    """

    activity: dict[str, bool] = field(default_factory=dict)
    written: dict[str, bool] = field(default_factory=dict)
    failed: dict[str, None] = field(default_factory=dict)

    def record(self, step: _Step) -> None:
        if step.change is not None and not step.change.succeeded:
            self.failed[step.component] = None
        elif step.active is not None:
            self.activity[step.component] = step.active


class Executor:
    """Deactivates, then sets parameters, then activates, so that a component starts with the right parameters.

    Each call is tried several times. A component for which a call keeps failing is reported as failed, so that planning
    finds a design without it; the rest of the plan is still carried out, and the plan's result is ``failed``. A plan
    that is abandoned meanwhile is not carried on with. Components that are not nodes have nothing to start or stop:
    they only become active in the knowledge base.

    Of a system whose calls take their time (see :class:`~rosa_core.mape.ManagedSystem`), components are changed at the
    same time, each in its order, once everything that is to stop has stopped; two that take 3 s each take 3 s together.
    A component that does not start within its limits is told to stop, so that it does not come up later unbidden.

    Args:
        kb: the knowledge base; plans come from its events, outcomes go to it, and limits count by its clock.
        managed_system: the robot's architecture.
        attempts: how often a call is tried, at least 1, for components without limits of their own.
        limits: how much time and how many attempts components get, by name.
        on_failure: called with a component that did not start, or did not take its parameters, before that is written.

    Raises:
        ValueError: if ``attempts`` is less than 1.
    """

    EVENTS = (ReconfigurationPlanCreated,)
    """The types of event that :meth:`on_event` is to hear."""
    WAKING = (ReconfigurationPlanEnded,)
    """The types of event that :meth:`wake` is to hear: a plan that is abandoned is not waited for."""

    def __init__(
        self,
        kb: KnowledgeBase,
        managed_system: ManagedSystem,
        *,
        attempts: int = 3,
        limits: LimitsByComponent = NO_LIMITS,
        on_failure: Callable[[str], None] = lambda _: None,
    ) -> None:
        self._on_failure = on_failure
        self._kb = kb
        self._system = managed_system
        self._usual = Limits(attempts=attempts)
        self._limits = limits
        self._observed = managed_system if isinstance(managed_system, Observable) else None
        self._announces = isinstance(managed_system, Announcing)
        self._wake = threading.Event()
        self._executing = threading.RLock()

    def wake(self, _cause: object = None) -> None:
        """Look at once how far components have got: one may have changed. Any thread may call this."""
        self._wake.set()

    def on_event(self, event: Event) -> None:
        """Carry out the plan that was made, unless it has been abandoned since.

        Args:
            event: what was written; subscribe this method to :data:`EVENTS`.
        """
        if isinstance(event, ReconfigurationPlanCreated) and self._is_pending(event.plan):
            self.execute(event.plan)

    def execute(self, plan: ReconfigurationPlan) -> Result:
        """Carry the plan out and write its outcome to the knowledge base.

        Args:
            plan: the pending plan; any other is not carried out.

        Returns:
            ``completed``; ``failed`` if a call kept failing; ``abandoned`` if the plan is pending no longer, in which
            case the plan that took its place is made anew from how the robot runs now.
        """
        with self._executing:  # one plan at a time, whoever asks for it
            return self._execute(plan)

    def _execute(self, plan: ReconfigurationPlan) -> Result:
        progress = self._carry_out(plan)
        result = Result.FAILED if progress.failed else Result.COMPLETED
        with self._kb.transaction():
            early = [component for component, active in progress.written.items() if active]
            self._write_activity(progress)
            if not self._kb.set_reconfiguration_result(plan, result):
                result = Result.ABANDONED
                # The plan that took its place was made before it was known what this one had done already.
                self._kb.replan()
            for component in early:
                # It has ended again while others were waited for: it does not run with what the plan gave it.
                if not self._kb.is_component_active(component):
                    self._kb.set_component_restarted(component)
            for component in progress.failed:
                self._kb.set_component_failure(component)
        return result

    def _write_activity(self, progress: _Progress) -> None:
        with self._kb.transaction():
            for component, active in progress.activity.items():
                self._kb.set_component_active(component, active)
        progress.written |= progress.activity
        progress.activity.clear()

    def _is_pending(self, plan: ReconfigurationPlan) -> bool:
        return self._kb.pending_reconfiguration_plan() == plan

    def _carry_out(self, plan: ReconfigurationPlan) -> _Progress:
        """Do what is to be done, waiting where nothing can be done but that; ends early if the plan is abandoned."""
        progress = _Progress()
        steps = list(self._steps(plan))
        while steps and self._is_pending(plan):
            self._wake.clear()
            left = self._advance(plan, steps, progress)
            if left and len(left) == len(steps):
                if progress.activity:
                    self._write_activity(progress)
                    continue  # what follows from that may have put an end to the plan
                self._wait(left)
            steps = left
        return progress

    def _advance(self, plan: ReconfigurationPlan, steps: list[_Step], progress: _Progress) -> list[_Step]:
        """Go on with every step whose turn it is; returns those that are not over."""
        left: list[_Step] = []
        busy: set[str] = set()
        something_stops = False
        for index, step in enumerate(steps):
            if step.component in progress.failed:
                continue
            waits = step.component in busy or (something_stops and step.active is not False)
            if not waits and not self._is_pending(plan):
                return left + steps[index:]
            if not waits and (step.change is None or step.change.advance()):
                progress.record(step)
                if step.component in progress.failed and step.active is not False:
                    self._stop_what_did_not_start(step)
                    self._on_failure(step.component)
                continue
            left.append(step)
            busy.add(step.component)
            something_stops = something_stops or step.active is False
        return left

    def _wait(self, steps: list[_Step]) -> None:
        """Until something may have changed, or an attempt is over."""
        deadlines = [s.change.deadline for s in steps if s.change is not None and s.change.deadline is not None]
        left = min(deadlines) - self._kb.clock.now()
        self._kb.clock.wait(self._wake, max(left if self._announces else min(left, LOOK_EVERY), 0.0))

    def _stop_what_did_not_start(self, step: _Step) -> None:
        if self._observed is None or not step.active:
            return
        if self._observed.state(step.component) in (ComponentState.ACTIVE, ComponentState.UNKNOWN):
            try:
                self._system.deactivate(step.component)
            except Exception as error:
                logger.warning("'%s' did not start, and cannot be stopped: %s", step.component, error)

    def _steps(self, plan: ReconfigurationPlan) -> Iterator[_Step]:
        """What is to be done, in order."""
        system = self._system
        for component in plan.deactivate:
            limit = self._limits_of(component).deactivation
            yield _Step(component, self._switch(component, system.deactivate, limit, active=False), False)
        for configuration in plan.parameter_adaptations:
            component = self._kb.configured_component(configuration)
            parameters = self._kb.component_parameters(configuration)
            limit = self._limits_of(component).parameters
            call = (lambda c=component, p=parameters: system.set_parameters(c, p)) if parameters else None
            yield _Step(component, None if call is None else self._change(component, call, limit), None)
        for component in plan.activate:
            limit = self._limits_of(component).activation
            yield _Step(component, self._switch(component, system.activate, limit, active=True), True)

    def _switch(
        self, component: str, call: Callable[[str], Answer], limit: float, *, active: bool
    ) -> ComponentChange | None:
        if not self._kb.component_type(component).is_node:
            return None
        return self._change(component, lambda: call(component), limit, wanted=active)

    def _change(
        self, component: str, call: Callable[[], Answer], limit: float, wanted: bool | None = None
    ) -> ComponentChange:
        observed = self._observed
        return ComponentChange(
            component,
            call,
            clock=self._kb.clock,
            limit=limit,
            attempts=self._limits_of(component).attempts,
            wanted=wanted,
            state=None if observed is None else lambda: observed.state(component),
            wake=self.wake,
        )

    def _limits_of(self, component: str) -> Limits:
        return self._limits.get(component, self._usual)
