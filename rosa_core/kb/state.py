"""What the knowledge base holds at run time, and the steps that a write is made of.

Each step changes the state, and records in the transaction how to take that back and what to announce. Steps validate
nothing and announce nothing: that is for :class:`~rosa_core.kb.knowledge_base.KnowledgeBase`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import fields, replace

from rosa_core.clock import Clock
from rosa_core.inference.network import ActionNode, ComponentNode, ConfigurationNode, DesignNode, MeasureNode
from rosa_core.inference.reasoner import Reasoner
from rosa_core.kb import reconfiguration
from rosa_core.kb.transaction import Savepoint, Transaction, toggle
from rosa_core.model.facts import (
    ComponentActive,
    ComponentFailure,
    ConfigurationApplied,
    Fact,
    FailedPlan,
    PendingPlan,
    PlanCount,
    PlanEnded,
    Selection,
)
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.records import Measurement, ReconfigurationPlan, RequiredAction
from rosa_core.model.status import Result
from rosa_core.model.utility import Utility


class RuntimeState:
    """The facts, the required actions, and the reconfiguration plan in progress.

    Args:
        model: the design-time knowledge.
        clock: for the times at which actions are requested and end.

    Attributes:
        known_model: the model as it is, unless it has changed since it was last asked for.
        required: the required actions by name, in order of request.
        pending_plan: the reconfiguration plan that has no result yet.
        failed_plan: whose work is not to be planned again for now.
        plans_made: the number of the latest plan, from 1.
    """

    def __init__(self, model: KnowledgeModel, clock: Clock) -> None:
        self.clock = clock
        self.reasoner = Reasoner(model)
        self.known_model: KnowledgeModel | None = model
        """The model as it is, unless it has changed since anybody asked for it."""
        self._annotations = model.annotations
        self.required: dict[str, RequiredAction] = {}
        self.pending_plan: ReconfigurationPlan | None = None
        self.failed_plan: ReconfigurationPlan | None = None
        self.plans_made = 0

    @property
    def model(self) -> KnowledgeModel:
        """The model as it is now; after a change it is put together when somebody asks for it."""
        if self.known_model is None:
            elements = self.reasoner.network.elements()
            sections = {field.name: getattr(elements, field.name) for field in fields(elements)}
            self.known_model = KnowledgeModel.of_checked({**sections, "annotations": self._annotations})
        return self.known_model

    def facts(self) -> Iterator[Fact]:
        """The facts that make up the state, given its model; in this order they give the same state."""
        reasoner = self.reasoner
        for name, measure in reasoner.measures.items():
            if measure.value is not None and measure.time is not None:
                yield Measurement(name, measure.value, measure.time)
        failed = (component for component in reasoner.components.values() if component.failed_since is not None)
        yield from (ComponentFailure(component.name, component.failed_since) for component in failed)
        for component in reconfiguration.declared_order(reasoner.active_components):
            yield ComponentActive(component.name, True)
        yield from self.required.values()
        for design in reconfiguration.declared_order(reasoner.selected_designs):
            yield Selection(design.kind, design.name, True)
        for configuration in reconfiguration.declared_order(reasoner.selected_configurations):
            yield Selection(configuration.kind, configuration.name, True)
            if configuration.applied:
                yield ConfigurationApplied(configuration.name, True)
        if self.pending_plan is not None:
            yield PendingPlan(self.pending_plan)
        if self.failed_plan is not None:
            yield FailedPlan(self.failed_plan)
        yield PlanCount(self.plans_made)

    def roll_back(self, tx: Transaction, to: Savepoint) -> None:
        """Take back what a transaction did since a savepoint; statuses follow from the facts again.

        Args:
            tx: the transaction in progress.
            to: a savepoint of this transaction.
        """
        tx.restore(to)
        self.reasoner.infer()
        if to.steps == 0:
            self.reasoner.changes.clear()

    def measure(self, tx: Transaction, node: MeasureNode, value: float, time: float) -> None:
        """A measurement; one that was taken before the latest is announced but does not count.

        Args:
            tx: in which it is written.
            node: of the measure.
            value: finite, in the measure's unit.
            time: when it was taken, in seconds.
        """
        measurement = Measurement(node.name, value, time)
        tx.measurements.append(measurement)
        tx.facts.append(measurement)
        old_value, old_time = node.value, node.time
        if old_time is None or time >= old_time:
            tx.undo.append(lambda: self.reasoner.set_measurement(node, old_value, old_time))
            self.reasoner.set_measurement(node, value, time)

    def set_failure(self, tx: Transaction, component: ComponentNode, since: float | None) -> None:
        """A failure reported or cleared; of a component that has failed already, another report changes nothing.

        Args:
            tx: in which it is written.
            component: the node.
            since: seconds, or None to clear it, which also allows the work of a failed plan to be planned again.
        """
        before = component.failed_since
        if (before is None) == (since is None):
            return
        if since is None:
            toggle(tx.recoveries, tx.failures, component.name)
            self.note_failed_plan(tx, None)
        else:
            toggle(tx.failures, tx.recoveries, component.name)
        tx.facts.append(ComponentFailure(component.name, since))
        tx.undo.append(lambda: self.reasoner.set_failed(component, before))
        self.reasoner.set_failed(component, since)

    def set_active(self, tx: Transaction, component: ComponentNode, active: bool) -> None:
        """A component runs, or no longer.

        Args:
            tx: in which it is written.
            component: the node.
            active: whether it runs.
        """
        if component.active == active:
            return
        now, before = (tx.activated, tx.deactivated) if active else (tx.deactivated, tx.activated)
        toggle(now, before, component.name)
        tx.facts.append(ComponentActive(component.name, active))
        tx.undo.append(lambda: self.reasoner.set_active(component, not active))
        self.reasoner.set_active(component, active)

    def require(
        self, tx: Transaction, action: ActionNode, preference: str | None = None, utility: Utility | None = None
    ) -> RequiredAction:
        """The action is to be performed, if it is not already.

        Args:
            tx: in which it is written.
            action: the node; its status is not looked at.
            preference: the name of a measure.
            utility: instead of a preference.

        Returns:
            the record of the action; if it was required before, with its preference and utility of then.
        """
        if action.name not in self.required:
            required = RequiredAction(action.name, self.clock.now(), preference, utility=utility)
            self.set_required(tx, action, required)
            tx.requested_actions[action.name] = required
        return self.required[action.name]

    def end_action(self, tx: Transaction, action: ActionNode, result: Result) -> RequiredAction | None:
        """The action ended, if it was required.

        Args:
            tx: in which it is written.
            action: the node.
            result: how it ended; abandoning what was requested in the same transaction leaves no trace.

        Returns:
            the record with its end; None if the action was not required.
        """
        required = self.required.get(action.name)
        if required is None:
            return None
        ended = replace(required, end_time=self.clock.now(), result=result)
        self.set_required(tx, action, ended)
        requested_just_now = tx.requested_actions.pop(action.name, None) is not None
        if requested_just_now and result is Result.ABANDONED:
            # It never was: neither announced nor journalled.
            tx.facts.remove(required)
            tx.facts.remove(ended)
        else:
            tx.ended_actions.append(ended)
        return ended

    def select_design(self, tx: Transaction, design: DesignNode, selected: bool) -> None:
        """A design is selected, or no longer.

        Args:
            tx: in which it is written.
            design: the node.
            selected: whether it is to solve its function.
        """
        if design.selected != selected:
            tx.select(design, selected)
            tx.facts.append(Selection(design.kind, design.name, selected))
            tx.undo.append(lambda: self.reasoner.set_design_selected(design, not selected))
            self.reasoner.set_design_selected(design, selected)

    def select_configuration(self, tx: Transaction, node: ConfigurationNode, selected: bool) -> None:
        """A configuration is selected, or no longer; either way its component does not run with it yet.

        Args:
            tx: in which it is written.
            node: of the configuration.
            selected: whether its component is to run with it.
        """
        if node.selected != selected:
            tx.select(node, selected)
            tx.facts.append(Selection(node.kind, node.name, selected))
            tx.undo.append(lambda: self.reasoner.set_configuration_selected(node, not selected))
            self.reasoner.set_configuration_selected(node, selected)
            self.set_applied(tx, node, False)

    def select(
        self, tx: Transaction, designs: list[DesignNode], configurations: list[ConfigurationNode]
    ) -> ReconfigurationPlan | None:
        """Select these instead of the others, and plan how to get there.

        Args:
            tx: in which it is written.
            designs: at most one of each function; functions of none keep theirs.
            configurations: at most one of each component; components of none keep theirs.

        Returns:
            the pending plan; None if there is nothing to reconfigure.
        """
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
        """The pending plan, if any, ended; ``applied`` are the configurations that their components run with now.

        Args:
            tx: in which it is written.
            result: a plan made in the same transaction that is abandoned leaves no trace.
            applied: those of its configurations that components run with now.
        """
        plan = self.pending_plan
        if plan is None:
            return
        self.set_pending_plan(tx, None)
        made_just_now = plan in tx.created_plans
        if made_just_now:
            tx.created_plans.remove(plan)
        if made_just_now and result is Result.ABANDONED:
            # It never was: neither announced nor journalled, and the next plan gets its number.
            tx.facts.remove(PendingPlan(plan))
            self.plans_made = plan.id - 1
        else:
            tx.ended_plans.append((plan, result))
            tx.facts.append(PlanEnded(plan, result))
        for configuration in applied:
            self.set_applied(tx, configuration, configuration.selected)
        self.note_failed_plan(tx, plan if result is Result.FAILED else None)

    def _plan(self, tx: Transaction) -> ReconfigurationPlan | None:
        plan = reconfiguration.make_plan(self.reasoner, self.plans_made + 1, self.clock.now())
        pending, failed = self.pending_plan, self.failed_plan
        if plan is not None and pending is not None and reconfiguration.same_work(plan, pending):
            return pending
        if pending is not None:
            self.end_plan(tx, Result.ABANDONED)
        if plan is not None and failed is not None and reconfiguration.is_part_of(plan, failed):
            return None
        self.note_failed_plan(tx, None)
        if plan is not None:
            self.set_pending_plan(tx, plan)
            tx.created_plans.append(plan)
        return plan

    def set_required(self, tx: Transaction, action: ActionNode, how: RequiredAction) -> None:
        """The action is required as said, or, if ``how`` has a result, no longer.

        Args:
            tx: in which it is written.
            action: the node.
            how: the record to keep; with a result, it is recorded and the action is required no more.
        """
        before, was_required = self.required, action.required

        def undo() -> None:
            self.required = before
            self.reasoner.set_required(action, was_required)

        tx.facts.append(how)
        tx.undo.append(undo)
        self.required = {name: other for name, other in before.items() if name != action.name}
        if how.result is None:
            self.required[action.name] = how
        self.reasoner.set_required(action, how.result is None)

    def set_applied(self, tx: Transaction, configuration: ConfigurationNode, applied: bool) -> None:
        """The component runs with the configuration since it was selected, or does not.

        Args:
            tx: in which it is written.
            configuration: the node.
            applied: whether its component has run with it since it was selected.
        """
        before = configuration.applied
        if before != applied:
            tx.facts.append(ConfigurationApplied(configuration.name, applied))
            tx.undo.append(lambda: setattr(configuration, "applied", before))
            configuration.applied = applied

    def set_pending_plan(self, tx: Transaction, plan: ReconfigurationPlan | None) -> None:
        """The plan is to be carried out, or none is any more.

        Args:
            tx: in which it is written.
            plan: its number becomes that of the latest plan made.
        """
        before, made = self.pending_plan, self.plans_made

        def undo() -> None:
            self.pending_plan, self.plans_made = before, made

        tx.undo.append(undo)
        self.pending_plan = plan
        if plan is not None:
            tx.facts.append(PendingPlan(plan))
            self.plans_made = plan.id

    def note_failed_plan(self, tx: Transaction, plan: ReconfigurationPlan | None) -> None:
        """The work of this plan is not to be planned again for now; None lifts that.

        Args:
            tx: in which it is written.
            plan: the plan that failed.
        """
        before = self.failed_plan
        if before is not plan:
            tx.facts.append(FailedPlan(plan))
            tx.undo.append(lambda: setattr(self, "failed_plan", before))
            self.failed_plan = plan
