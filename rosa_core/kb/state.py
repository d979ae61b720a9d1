"""What the knowledge base holds at run time, and the steps that a write is made of.

Each step changes the state, tells the transaction how to take that back, and what to announce. Steps validate nothing
and announce nothing: that is for :class:`~rosa_core.kb.knowledge_base.KnowledgeBase`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from rosa_core.clock import Clock
from rosa_core.kb import reconfiguration
from rosa_core.kb.events import Measurement, ReconfigurationPlan, RequiredAction
from rosa_core.kb.network import ActionNode, ComponentNode, ConfigurationNode, DesignNode, MeasureNode
from rosa_core.kb.reasoner import Reasoner
from rosa_core.kb.status import Result
from rosa_core.kb.transaction import Transaction, toggle
from rosa_core.kb.utility import Utility
from rosa_core.model.knowledge_model import KnowledgeModel


class RuntimeState:
    """The facts, the required actions, and the reconfiguration plan in progress."""

    def __init__(self, model: KnowledgeModel, clock: Clock) -> None:
        self.clock = clock
        self.reasoner = Reasoner(model)
        self.required: dict[str, RequiredAction] = {}
        self.pending_plan: ReconfigurationPlan | None = None
        self.failed_plan: ReconfigurationPlan | None = None
        self.plans_made = 0

    def measure(self, tx: Transaction, node: MeasureNode, value: float, time: float) -> None:
        """A measurement; one that was taken before the latest is remembered but does not count."""
        tx.measurements.append(Measurement(node.name, value, time))
        old_value, old_time = node.value, node.time
        if old_time is None or time >= old_time:
            tx.undo.append(lambda: self.reasoner.set_measurement(node, old_value, old_time))
            self.reasoner.set_measurement(node, value, time)

    def set_failure(self, tx: Transaction, component: ComponentNode, since: float | None) -> None:
        """A failure reported (seconds) or cleared (None)."""
        before = component.failed_since
        if (before is None) == (since is None):
            return
        if since is None:
            toggle(tx.recoveries, tx.failures, component.name)
            self._note_failed_plan(tx, None)
        else:
            toggle(tx.failures, tx.recoveries, component.name)
        tx.undo.append(lambda: self.reasoner.set_failed(component, before))
        self.reasoner.set_failed(component, since)

    def set_active(self, tx: Transaction, component: ComponentNode, active: bool) -> None:
        """A component runs, or no longer."""
        if component.active == active:
            return
        now, before = (tx.activated, tx.deactivated) if active else (tx.deactivated, tx.activated)
        toggle(now, before, component.name)
        tx.undo.append(lambda: self.reasoner.set_active(component, not active))
        self.reasoner.set_active(component, active)

    def require(
        self, tx: Transaction, action: ActionNode, preference: str | None = None, utility: Utility | None = None
    ) -> RequiredAction:
        """The action is to be performed, if it is not already."""
        if action.name not in self.required:
            required = RequiredAction(action.name, self.clock.now(), preference, utility=utility)
            self._set_required(tx, action, {**self.required, action.name: required})
            tx.requested_actions[action.name] = required
        return self.required[action.name]

    def end_action(self, tx: Transaction, action: ActionNode, result: Result) -> RequiredAction | None:
        """The action ended, if it was required."""
        left = dict(self.required)
        required = left.pop(action.name, None)
        if required is None:
            return None
        self._set_required(tx, action, left)
        ended = replace(required, end_time=self.clock.now(), result=result)
        tx.requested_actions.pop(action.name, None)
        tx.ended_actions.append(ended)
        return ended

    def select_design(self, tx: Transaction, design: DesignNode, selected: bool) -> None:
        """A design is selected, or no longer."""
        if design.selected != selected:
            tx.select(design, selected)
            tx.undo.append(lambda: self.reasoner.set_design_selected(design, not selected))
            self.reasoner.set_design_selected(design, selected)

    def select_configuration(self, tx: Transaction, node: ConfigurationNode, selected: bool) -> None:
        """A configuration is selected, or no longer; either way its component does not run with it yet."""
        if node.selected != selected:
            tx.select(node, selected)
            tx.undo.append(lambda: self.reasoner.set_configuration_selected(node, not selected))
            self.reasoner.set_configuration_selected(node, selected)
            self._set_applied(tx, node, False)

    def select(
        self, tx: Transaction, designs: list[DesignNode], configurations: list[ConfigurationNode]
    ) -> ReconfigurationPlan | None:
        """Select these instead of the others, and plan how to get there."""
        for design in reconfiguration.displaced_designs(self.reasoner, designs):
            self.select_design(tx, design, False)
        for design in designs:
            self.select_design(tx, design, True)
        for configuration in reconfiguration.displaced_configurations(self.reasoner, configurations):
            self.select_configuration(tx, configuration, False)
        for configuration in configurations:
            self.select_configuration(tx, configuration, True)
        return self._plan(tx)

    def end_plan(self, tx: Transaction, result: Result, applied: Iterable[ConfigurationNode] = ()) -> None:
        """The pending plan, if any, ended; ``applied`` are the configurations that their components run with now."""
        plan = self.pending_plan
        if plan is None:
            return
        self._set_pending(tx, None)
        for configuration in applied:
            self._set_applied(tx, configuration, configuration.selected)
        self._note_failed_plan(tx, plan if result is Result.FAILED else None)
        if plan in tx.created_plans:
            tx.created_plans.remove(plan)
        tx.ended_plans.append((plan, result))

    def _plan(self, tx: Transaction) -> ReconfigurationPlan | None:
        plan = reconfiguration.make_plan(self.reasoner, self.plans_made + 1, self.clock.now())
        pending, failed = self.pending_plan, self.failed_plan
        if plan is not None and pending is not None and reconfiguration.same_work(plan, pending):
            return pending
        if pending is not None:
            self.end_plan(tx, Result.ABANDONED)
        if plan is not None and failed is not None and reconfiguration.same_work(plan, failed):
            return None
        self._note_failed_plan(tx, None)
        if plan is not None:
            self._set_pending(tx, plan)
            self.plans_made = plan.id
            tx.created_plans.append(plan)
        return plan

    def _set_required(self, tx: Transaction, action: ActionNode, required: dict[str, RequiredAction]) -> None:
        before, was_required = self.required, action.required

        def undo() -> None:
            self.required = before
            self.reasoner.set_required(action, was_required)

        tx.undo.append(undo)
        self.required = required
        self.reasoner.set_required(action, action.name in required)

    def _set_applied(self, tx: Transaction, configuration: ConfigurationNode, applied: bool) -> None:
        before = configuration.applied
        tx.undo.append(lambda: setattr(configuration, "applied", before))
        configuration.applied = applied

    def _set_pending(self, tx: Transaction, plan: ReconfigurationPlan | None) -> None:
        before = self.pending_plan
        tx.undo.append(lambda: setattr(self, "pending_plan", before))
        self.pending_plan = plan

    def _note_failed_plan(self, tx: Transaction, plan: ReconfigurationPlan | None) -> None:
        before = self.failed_plan
        if before is not plan:
            tx.undo.append(lambda: setattr(self, "failed_plan", before))
            self.failed_plan = plan
