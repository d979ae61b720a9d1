"""Knowledge that grows while the robot runs: the model changes, what is happening now stays.

The reasoner is built anew for the new model, and the run-time facts of everything that is still there are set in it.
That costs what loading the model costs, whatever the size of the change.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from rosa_core.errors import KnowledgeChangeRefusedError, KnowledgeModelError, Problem
from rosa_core.inference.network import Node
from rosa_core.inference.reasoner import Reasoner
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.transaction import NodeKey, Transaction, toggle
from rosa_core.model.changes import Element, Elements, find_elements, with_elements, without_elements
from rosa_core.model.elements import ElementRef
from rosa_core.model.facts import ModelChange
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.records import ReconfigurationPlan
from rosa_core.model.status import Result, Status


def add_elements(state: RuntimeState, tx: Transaction, elements: Iterable[Element]) -> None:
    """Add elements and relations.

    Raises:
        KnowledgeChangeRefusedError: with every flaw that the model would have.
    """
    with _refusing():
        added = Elements.of(elements)
        model = with_elements(state.model, added)
    if any(added):
        _change(state, tx, model, added, Elements())


def remove_elements(state: RuntimeState, tx: Transaction, elements: Iterable[Element | ElementRef]) -> None:
    """Remove elements and relations, and end what is chosen of them.

    Raises:
        KnowledgeChangeRefusedError: for unknown elements, those that others refer to, and those in use.
    """
    with _refusing():
        removed = find_elements(state.model, elements)
        model = without_elements(state.model, removed)
    if problems := list(_in_use(state, removed)):
        raise KnowledgeChangeRefusedError(problems)
    if any(removed):
        _give_up(state, tx, removed)
        _change(state, tx, model, Elements(), removed)


def change_model(state: RuntimeState, tx: Transaction, added: Elements, removed: Elements) -> None:
    """Do a change again that was accepted before.

    Raises:
        KnowledgeModelError: if it does not fit the model.
    """
    _change(state, tx, with_elements(without_elements(state.model, removed), added), added, removed)


@contextmanager
def _refusing() -> Iterator[None]:
    """A model that would not hold together is a write that is refused."""
    try:
        yield
    except KnowledgeModelError as error:
        raise KnowledgeChangeRefusedError(error.problems) from None


def _in_use(state: RuntimeState, removed: Elements) -> Iterator[Problem]:
    """What somebody else must end first: the task layer a required action, whoever runs it an active component."""
    gone = {measure.name for measure in removed.measures}
    for action in removed.actions:
        if action.name in state.required:
            yield Problem(f"action '{action.name}' is required now", hint="cancel or finish it first")
    for required in state.required.values():
        for measure in required.decided_by.measures if required.decided_by else ():
            if measure in gone:
                what = f"measure '{measure}' decides on the configuration of the required action '{required.action}'"
                yield Problem(what, hint="cancel or finish the action first")
    for component in removed.components:
        if state.reasoner.components[component.name].active:
            yield Problem(f"component '{component.name}' is active", hint="deactivate it first")


def _give_up(state: RuntimeState, tx: Transaction, removed: Elements) -> None:
    """End what was planned with the elements: selections, and the plans that name them."""
    reasoner = state.reasoner
    for design in removed.function_designs:
        state.select_design(tx, reasoner.designs[design.name], False)
    for configuration in removed.component_configurations:
        state.select_configuration(tx, reasoner.configurations[configuration.name], False)
    if state.pending_plan is not None and _names(state.pending_plan, removed):
        state.end_plan(tx, Result.ABANDONED)
    if state.failed_plan is not None and _names(state.failed_plan, removed):
        state.note_failed_plan(tx, None)


def _names(plan: ReconfigurationPlan, removed: Elements) -> bool:
    components = {component.name for component in removed.components}
    configurations = {configuration.name for configuration in removed.component_configurations}
    return not (
        components.isdisjoint((*plan.activate, *plan.deactivate))
        and configurations.isdisjoint(plan.parameter_adaptations)
    )


def _change(state: RuntimeState, tx: Transaction, model: KnowledgeModel, added: Elements, removed: Elements) -> None:
    old_model, old = state.model, state.reasoner
    old.infer()
    if tx.statuses_before_growth is None:
        tx.statuses_before_growth = {_key(node): old.changes.get(node, node.status) for node in old.nodes()}

    def undo() -> None:
        state.model, state.reasoner = old_model, old

    tx.undo.append(undo)
    tx.facts.append(ModelChange(added, removed))
    for element in removed:
        toggle(tx.removed, tx.added, element)
    for element in added:
        toggle(tx.added, tx.removed, element)
    state.model, state.reasoner = model, Reasoner(model)
    _carry_over(old, state.reasoner)
    state.reasoner.infer()
    state.reasoner.changes = dict(_changes_since(tx.statuses_before_growth, state.reasoner))


def _carry_over(old: Reasoner, new: Reasoner) -> None:
    """The facts of every element that both have."""
    for name, measure in old.measures.items():
        if measure.value is not None and name in new.measures:
            new.set_measurement(new.measures[name], measure.value, measure.time)
    for name, component in old.components.items():
        if name in new.components:
            new.set_failed(new.components[name], component.failed_since)
            new.set_active(new.components[name], component.active)
    for action in old.required_actions:
        new.set_required(new.actions[action.name], True)
    for design in old.selected_designs:
        new.set_design_selected(new.designs[design.name], True)
    for configuration in old.selected_configurations:
        node = new.configurations[configuration.name]
        new.set_configuration_selected(node, True)
        node.applied = configuration.applied


def _changes_since(before: dict[NodeKey, Status], reasoner: Reasoner) -> Iterator[tuple[Node, Status]]:
    for node in reasoner.nodes():
        status = before.get(_key(node))
        if status is not None and status is not node.status:
            yield node, status


def _key(node: Node) -> NodeKey:
    return (node.kind, getattr(node, "constraint", node.name))
