"""Execute: carry a reconfiguration plan out on the managed system (ROSA paper, section 6.2.4)."""

from __future__ import annotations

import logging
from collections.abc import Callable

from rosa_core.kb.events import Event, ReconfigurationPlanCreated
from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.mape.managed_system import ManagedSystem
from rosa_core.model.records import ReconfigurationPlan
from rosa_core.model.status import Result

logger = logging.getLogger(__name__)


class Executor:
    """Deactivates, then sets parameters, then activates, so that a component starts with the right parameters.

    Each call is tried up to ``attempts`` times. A component for which a call keeps failing is reported as failed, so
    that planning finds a design without it; the rest of the plan is still carried out, and the plan's result is
    ``failed``. A plan that is abandoned meanwhile is not carried on with. Components that are not nodes have nothing
    to start or stop: they only become active in the knowledge base.

    Args:
        kb: the knowledge base; plans come from its events, and outcomes go to it.
        managed_system: the robot's architecture.
        attempts: how often a call is tried, at least 1.

    Raises:
        ValueError: if ``attempts`` is less than 1.
    """

    EVENTS = (ReconfigurationPlanCreated,)
    """The types of event that :meth:`on_event` is to hear."""

    def __init__(self, kb: KnowledgeBase, managed_system: ManagedSystem, *, attempts: int = 3) -> None:
        if attempts < 1:
            raise ValueError(f"attempts must be at least 1, not {attempts}")
        self._kb = kb
        self._system = managed_system
        self._attempts = attempts

    def on_event(self, event: Event) -> None:
        """Carry out the plan that was made, unless it has been abandoned since.

        Args:
            event: what was written; subscribe this method to :data:`EVENTS`.
        """
        if isinstance(event, ReconfigurationPlanCreated) and event.plan == self._kb.pending_reconfiguration_plan():
            self.execute(event.plan)

    def execute(self, plan: ReconfigurationPlan) -> Result:
        """Carry the plan out and write its outcome to the knowledge base.

        Args:
            plan: the pending plan; any other is not carried out.

        Returns:
            ``completed``; ``failed`` if a call kept failing; ``abandoned`` if the plan is pending no longer, in which
            case the plan that took its place is made anew from how the robot runs now.
        """
        activity: dict[str, bool] = {}
        failed: dict[str, None] = {}
        for component, call, active in self._steps(plan):
            if self._kb.pending_reconfiguration_plan() != plan:
                break
            if component in failed:
                continue
            if not self._try(component, call):
                failed[component] = None
            elif active is not None:
                activity[component] = active
        result = Result.FAILED if failed else Result.COMPLETED
        with self._kb.transaction():
            for component, active in activity.items():
                self._kb.set_component_active(component, active)
            if not self._kb.set_reconfiguration_result(plan, result):
                result = Result.ABANDONED
                # The plan that took its place was made before it was known what this one had done already.
                self._kb.replan()
            for component in failed:
                self._kb.set_component_failure(component)
        return result

    def _steps(self, plan: ReconfigurationPlan) -> list[tuple[str, Callable[[], bool | None] | None, bool | None]]:
        """Component, call (None: nothing to do), and whether it is active afterwards (None: as before), in order."""
        system = self._system
        steps: list[tuple[str, Callable[[], bool | None] | None, bool | None]] = []
        for component in plan.deactivate:
            steps.append((component, self._if_node(component, system.deactivate), False))
        for configuration in plan.parameter_adaptations:
            component = self._kb.configured_component(configuration)
            parameters = self._kb.component_parameters(configuration)
            call = (lambda c=component, p=parameters: system.set_parameters(c, p)) if parameters else None
            steps.append((component, call, None))
        for component in plan.activate:
            steps.append((component, self._if_node(component, system.activate), True))
        return steps

    def _if_node(self, component: str, call: Callable[[str], bool | None]) -> Callable[[], bool | None] | None:
        return (lambda: call(component)) if self._kb.component_type(component).is_node else None

    def _try(self, component: str, call: Callable[[], bool | None] | None) -> bool:
        for attempt in range(self._attempts if call else 0):
            try:
                if call is not None and call() is not False:
                    return True
                reason = "it was refused"
            except Exception as error:
                reason = f"{type(error).__name__}: {error}"
            logger.warning("reconfiguring '%s' failed (attempt %d): %s", component, attempt + 1, reason)
        return call is None
