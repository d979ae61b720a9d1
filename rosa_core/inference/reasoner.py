"""The incremental reasoner: a fact changes, and only what depends on it is evaluated again.

The facts that statuses follow from are: latest measurements, reported failures, active components, required actions,
selected designs and configurations. Each has a setter here that marks what it touches; :meth:`Reasoner.infer` then
evaluates marked nodes level by level, and stops wherever a status turns out as before. The cost of a change is the
size of what changes, not of the knowledge base.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields

from rosa_core.inference.network import (
    LEVELS,
    ActionNode,
    ComponentNode,
    ConfigurationNode,
    ConstraintNode,
    DesignNode,
    EstimationLink,
    FunctionNode,
    MeasureNode,
    Node,
    Part,
    RequirementLink,
    uncount,
)
from rosa_core.inference.rules import is_adaptable
from rosa_core.inference.wiring import Network
from rosa_core.model.changes import Elements
from rosa_core.model.elements import ElementKind
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.status import Status


class Reasoner:
    """Statuses of all elements of a model, kept in step with the facts (ROSA paper, section 5.2).

    The sets of selected, active and adaptable nodes are kept so that asking for them does not search the model.

    Args:
        model: whose elements are inferred.

    Attributes:
        changes: each node whose status has changed since this was last emptied, with the status it had then.
    """

    def __init__(self, model: KnowledgeModel) -> None:
        self.network = network = Network()
        self.measures = network.measures
        self.actions = network.actions
        self.functions = network.functions
        self.components = network.components
        self.designs = network.designs
        self.configurations = network.configurations
        self.constraints = network.constraints
        self.constraints_on = network.constraints_on
        self.estimations_of = network.estimations_of
        self.changes: dict[Node, Status] = {}
        self.required_actions: set[ActionNode] = set()
        self.selected_designs: set[DesignNode] = set()
        self.selected_configurations: set[ConfigurationNode] = set()
        self.active_components: set[ComponentNode] = set()
        self.adaptable_functions: set[FunctionNode] = set()
        self.adaptable_components: set[ComponentNode] = set()
        self._dirty: list[list[Node]] = [[] for _ in range(LEVELS)]
        self.add(Elements(**{field.name: getattr(model, field.name) for field in fields(Elements)}))

    # -- the network --

    def add(self, elements: Elements) -> list[Part]:
        """Elements come, with their statuses from the beginning: those are no changes.

        Args:
            elements: what is new; it must hold together with what is there.

        Returns:
            their parts in the network.
        """
        self.infer()
        parts = self.network.make(elements)
        nodes = [part for part in parts if isinstance(part, Node)]
        self._mark_all(nodes)
        for node in nodes:
            for dependent, _ in node.dependents:
                if not dependent.dirty:
                    self._mark(dependent)
        for part in parts:
            if isinstance(part, RequirementLink):
                self._change_requirement(part, 1)
        self.infer()
        for node in nodes:
            self.changes.pop(node, None)
        return parts

    def remove(self, parts: Iterable[Part]) -> None:
        """Parts go; nothing that stays may name them, and they must not be selected, required or active."""
        for part in sorted(parts, key=_removal_order):
            if isinstance(part, RequirementLink):
                self._change_requirement(part, -1)
                self.network.untie(part)
            elif isinstance(part, Node):
                self._mark_all([dependent for dependent, _ in part.dependents])
                self.network.untie(part)
                self._discard(part)
            else:
                self.network.untie(part)

    def restore(self, parts: Iterable[Part]) -> None:
        """Parts that were removed are there again, as if they had never gone."""
        for part in sorted(parts, key=_removal_order, reverse=True):
            self.network.tie(part)
            if isinstance(part, Node):
                self._track(part, part.status)
                self._mark_all([part, *(dependent for dependent, _ in part.dependents)])
            elif isinstance(part, RequirementLink):
                self._change_requirement(part, 1)

    def _change_requirement(self, link: RequirementLink, change: int) -> None:
        self._mark(link.action)
        if link.action.required:
            for function in link.functions:
                self._require(function, change)

    def _discard(self, node: Node) -> None:
        self.changes.pop(node, None)
        if node.dirty:
            node.dirty = False
            self._dirty[node.level].remove(node)
        if isinstance(node, FunctionNode):
            self.adaptable_functions.discard(node)
        elif isinstance(node, ComponentNode):
            self.adaptable_components.discard(node)

    # -- the facts --

    def set_measurement(self, measure: MeasureNode, value: float | None, time: float | None) -> None:
        """The latest measurement, or None for none; only constraints whose limit it passes are inferred again.

        Args:
            measure: the node.
            value: in the measure's unit.
            time: when it was taken, in seconds.
        """
        old = measure.value
        measure.value = value
        measure.time = time
        if old != value:
            self._mark_all(measure.between(old, value))

    def set_failed(self, component: ComponentNode, since: float | None) -> None:
        """A failure was reported at a time (seconds), or cleared (None).

        Args:
            component: the node.
            since: seconds, or None.
        """
        if component.failed_since != since:
            component.failed_since = since
            self._mark(component)

    def set_active(self, component: ComponentNode, active: bool) -> None:
        """The component runs, or does not.

        Args:
            component: the node.
            active: whether it runs.
        """
        if component.active != active:
            component.active = active
            (self.active_components.add if active else self.active_components.discard)(component)
            self._mark(component)

    def set_required(self, action: ActionNode, required: bool) -> None:
        """The action is to be performed, or no longer; its functions are required with it.

        Args:
            action: the node.
            required: whether it is to be performed.
        """
        if action.required != required:
            action.required = required
            (self.required_actions.add if required else self.required_actions.discard)(action)
            self._mark(action)
            for function in action.members:
                self._require(function, 1 if required else -1)

    def set_design_selected(self, design: DesignNode, selected: bool) -> None:
        """The design is the one to solve its function, or no longer; its components are required with it.

        Args:
            design: the node; another one of its function that is selected stays so until it is unselected.
            selected: whether it is to solve its function.
        """
        if design.selected != selected:
            design.selected = selected
            if selected:
                design.join(design.function, design.function.selected_designs)
                self.selected_designs.add(design)
            else:
                design.leave(design.function, design.function.selected_designs)
                self.selected_designs.discard(design)
            self._mark(design)
            self._mark(design.function)
            for component in design.members:
                self._require(component, 1 if selected else -1)

    def set_configuration_selected(self, configuration: ConfigurationNode, selected: bool) -> None:
        """The configuration is the one that its component is to run with, or no longer.

        Args:
            configuration: the node; another one of its component that is selected stays so until it is unselected.
            selected: whether its component is to run with it.
        """
        if configuration.selected != selected:
            configuration.selected = selected
            component = configuration.component
            if selected:
                configuration.join(component, component.selected_configurations)
                self.selected_configurations.add(configuration)
            else:
                configuration.leave(component, component.selected_configurations)
                self.selected_configurations.discard(configuration)
            self._mark(component)

    # -- inference --

    def infer(self) -> None:
        """Evaluate what is marked, and what depends on what changes by it."""
        changes = self.changes
        for level in self._dirty:
            if not level:
                continue
            for node in level:
                node.dirty = False
                new = node.evaluate()
                old = node.status
                if new is old:
                    continue
                node.status = new
                changes.setdefault(node, old)
                if node.is_adapted:
                    self._track(node, new)
                for dependent, group in node.dependents:
                    uncount(group, old)
                    group[new] = group.get(new, 0) + 1
                    if not dependent.dirty:
                        dependent.dirty = True
                        self._dirty[dependent.level].append(dependent)
            level.clear()

    def infer_everything(self) -> None:
        """Evaluate every node again; with facts set only through the setters this changes nothing."""
        self._mark_all(self.nodes())
        self.infer()

    def nodes(self) -> Iterator[Node]:
        """All nodes, from constraints up to actions, each kind in order of declaration."""
        yield from self.constraints
        yield from self.configurations.values()
        yield from self.components.values()
        yield from self.designs.values()
        yield from self.functions.values()
        yield from self.actions.values()

    def of_kind(self, kind: ElementKind) -> Mapping[str, Node]:
        """The nodes of one kind of named element, in order of declaration."""
        groups: dict[ElementKind, Mapping[str, Node]] = {
            ElementKind.ACTION: self.actions,
            ElementKind.FUNCTION: self.functions,
            ElementKind.COMPONENT: self.components,
            ElementKind.FUNCTION_DESIGN: self.designs,
            ElementKind.COMPONENT_CONFIGURATION: self.configurations,
        }
        return groups[kind]

    # -- inside --

    def _track(self, node: Node, status: Status) -> None:
        """Keep the sets of adaptable functions and components."""
        if isinstance(node, FunctionNode):
            adaptable = is_adaptable(status, node.element.always_improve)
            (self.adaptable_functions.add if adaptable else self.adaptable_functions.discard)(node)
        elif isinstance(node, ComponentNode):
            adaptable = is_adaptable(status, node.element.always_improve)
            (self.adaptable_components.add if adaptable else self.adaptable_components.discard)(node)

    def _require(self, node: FunctionNode | ComponentNode, change: int) -> None:
        before = node.required_by > 0
        node.required_by += change
        if before != (node.required_by > 0):
            self._mark(node)

    def _mark(self, node: Node) -> None:
        if not node.dirty:
            node.dirty = True
            self._dirty[node.level].append(node)

    def _mark_all(self, nodes: Iterable[Node]) -> None:
        for node in nodes:
            self._mark(node)


def _removal_order(part: Part) -> tuple[int, int]:
    """What names others goes before these: relations, designs and configurations, then all else; the latest first."""
    if isinstance(part, RequirementLink | EstimationLink | ConstraintNode):
        return (0, -part.order)
    return (1 if isinstance(part, DesignNode | ConfigurationNode) else 2, -part.order)
