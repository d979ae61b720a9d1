"""Knowledge that grows while the robot runs: the model changes, what is happening now stays.

What comes is checked against what is there, and what goes against what names it; then the inference network is changed
in place. Both cost the size of the change, and of what is tied to it, not of the model.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from rosa_core.errors import KnowledgeChangeRefusedError, KnowledgeModelError, Problem, nearest
from rosa_core.inference.network import Node, Part
from rosa_core.inference.reasoner import Reasoner
from rosa_core.inference.wiring import Network
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.transaction import NodeKey, Transaction, toggle
from rosa_core.model.changes import KIND_OF, Element, Elements, describe, ref, references
from rosa_core.model.elements import Constraint, ElementKind, ElementRef
from rosa_core.model.facts import ModelChange
from rosa_core.model.knowledge_model import FlawedModelError
from rosa_core.model.records import ReconfigurationPlan
from rosa_core.model.status import Result
from rosa_core.model.validation import find_flaws


def add_elements(state: RuntimeState, tx: Transaction, elements: Iterable[Element]) -> None:
    """Add elements and relations.

    Args:
        state: what the knowledge base holds.
        tx: the write that this is a part of.
        elements: what is new; names may point to other elements of the same call.

    Raises:
        KnowledgeChangeRefusedError: with every flaw that the model would have.
    """
    try:
        added = Elements.of(elements)
        _check_added(state.reasoner.network, added)
    except KnowledgeModelError as error:
        raise KnowledgeChangeRefusedError(error.problems) from None
    if any(added):
        _add(state, tx, added)


def remove_elements(state: RuntimeState, tx: Transaction, elements: Iterable[Element | ElementRef]) -> None:
    """Remove elements and relations, and end what is chosen of them.

    Args:
        state: what the knowledge base holds.
        tx: the write that this is a part of.
        elements: what goes; those that have a name may be given by reference.

    Raises:
        KnowledgeChangeRefusedError: for unknown elements, those that others refer to, and those in use.
    """
    try:
        removed = _find(state.reasoner.network, elements)
    except KnowledgeModelError as error:
        raise KnowledgeChangeRefusedError(error.problems) from None
    if problems := list(_in_use(state, removed.elements)):
        raise KnowledgeChangeRefusedError(problems)
    if removed.parts:
        _give_up(state, tx, removed.elements)
        _remove(state, tx, removed)


def change_model(state: RuntimeState, tx: Transaction, added: Elements, removed: Elements) -> None:
    """Do a change again that was accepted before.

    Args:
        state: what the knowledge base holds.
        tx: the write that this is a part of.
        added: what the model gained.
        removed: what it lost.

    Raises:
        KnowledgeModelError: if it does not fit the model.
    """
    if any(removed):
        _remove(state, tx, _find(state.reasoner.network, removed))
    if any(added):
        _check_added(state.reasoner.network, added)
        _add(state, tx, added)


# -- what fits --


@dataclass(frozen=True, slots=True)
class _Found:
    """Elements of the model, and their parts in the network."""

    elements: Elements
    parts: tuple[Part, ...]


@dataclass(frozen=True, slots=True)
class _KnownElements:
    """What is there already, as the check of what is added asks for it."""

    network: Network

    def names(self, kind: ElementKind) -> dict[str, object]:
        return self.network.named(kind)  # type: ignore[return-value]

    def requires(self, action: str, function: str) -> bool:
        node = self.network.actions.get(action)
        return node is not None and any(member.name == function for member in node.members)

    def has_constraint(self, constraint: Constraint) -> bool:
        return self.network.find(constraint) is not None

    def has_estimation(self, causer: ElementRef, measure: str) -> bool:
        node = self.network.find(causer)
        links = self.network.estimations_of.get(node, ()) if isinstance(node, Node) else ()
        return any(link.measure.name == measure for link in links)


def _check_added(network: Network, added: Elements) -> None:
    if flaws := find_flaws(added, _KnownElements(network)):
        raise FlawedModelError(flaws)


def _find(network: Network, wanted: Iterable[Element | ElementRef]) -> _Found:
    """The elements that are meant, which nothing that stays refers to."""
    found: dict[Part, None] = {}
    problems: list[Problem] = []
    for item in wanted:
        part = network.find(item)
        if part is not None:
            found[part] = None
        elif isinstance(item, ElementRef) or type(item) in KIND_OF:
            key = item if isinstance(item, ElementRef) else ref(item)  # type: ignore[arg-type]
            known = network.named(key.kind) if key.kind in KIND_OF.values() else ()
            problems.append(Problem(f"there is no {key}", hint=nearest(key.name, known)))
        else:
            problems.append(Problem(f"the model has no {describe(item)}", hint="give it exactly as the model has it"))
    problems = problems or list(_still_referred_to(network, found))
    if problems:
        raise KnowledgeModelError(problems)
    return _Found(Elements.of(part.element for part in found), tuple(found))


def _still_referred_to(network: Network, removed: dict[Part, None]) -> Iterator[Problem]:
    left = {other for part in removed for other in network.referring(part) if other not in removed}
    if not left:
        return
    missing = {ref(part.element) for part in removed if type(part.element) in KIND_OF}  # type: ignore[arg-type]
    referring: dict[ElementRef, list[str]] = {}
    for element in Elements.of(part.element for part in sorted(left, key=lambda part: part.order)):
        for target in references(element):
            if target in missing:
                referring.setdefault(target, []).append(describe(element))
    for target, by in referring.items():
        yield Problem(
            f"{target} is still referred to by {', '.join(by)}", hint="remove that too, in the same call or before"
        )


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


# -- the change --


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


def _add(state: RuntimeState, tx: Transaction, added: Elements) -> None:
    reasoner = state.reasoner
    _begin(tx, reasoner)
    model = state.known_model
    parts = reasoner.add(added)

    def undo() -> None:
        reasoner.remove(parts)
        state.known_model = model

    tx.undo.append(undo)
    tx.facts.append(ModelChange(added=added))
    for element in added:
        toggle(tx.added, tx.removed, element)
    for node in parts:
        if isinstance(node, Node) and (before := tx.statuses_before.get(_key(node))) is not None:
            reasoner.changes[node] = before
    state.known_model = None


def _remove(state: RuntimeState, tx: Transaction, removed: _Found) -> None:
    reasoner = state.reasoner
    _begin(tx, reasoner)
    model = state.known_model
    reasoner.infer()
    nodes: list[Node] = [part for part in removed.parts if isinstance(part, Node)]
    changed = {node: reasoner.changes[node] for node in nodes if node in reasoner.changes}
    for node in nodes:
        if node.order <= tx.last_order_before:  # else nobody has known it before this write
            tx.statuses_before.setdefault(_key(node), changed.get(node, node.status))
    reasoner.remove(removed.parts)

    def undo() -> None:
        reasoner.restore(removed.parts)
        reasoner.changes.update(changed)
        state.known_model = model

    tx.undo.append(undo)
    tx.facts.append(ModelChange(removed=removed.elements))
    for element in removed.elements:
        toggle(tx.removed, tx.added, element)
    state.known_model = None


def _begin(tx: Transaction, reasoner: Reasoner) -> None:
    """Remember which nodes are older than the write."""
    if tx.last_order_before < 0:
        tx.last_order_before = reasoner.network.next_order


def _key(node: Node) -> NodeKey:
    return (node.kind, getattr(node, "constraint", node.name))
