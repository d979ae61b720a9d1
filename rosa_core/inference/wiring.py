"""How the nodes of the inference network are tied together, and how they come and go.

A part (a node, or the link of a relation) is *tied in* when others count it, and *untied* when they do no longer. Both
cost what is tied to the part, not the size of the network, and untying and tying in again gives the same network: every
list is in order of declaration, whatever the order in which it was filled.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from operator import attrgetter
from typing import Protocol, TypeVar

from rosa_core.inference.network import (
    ActionNode,
    ComponentNode,
    ConfigurationNode,
    ConstraintNode,
    DesignNode,
    EstimationLink,
    FunctionNode,
    MeasureNode,
    NamedNode,
    Node,
    Part,
    RequirementLink,
)
from rosa_core.model.changes import KIND_OF, Element, Elements
from rosa_core.model.elements import Constraint, ElementKind, ElementRef, Estimation, FunctionalRequirement


class _Ordered(Protocol):
    order: int


_O = TypeVar("_O", bound=_Ordered)
_order = attrgetter("order")


class Network:
    """The parts of a model by kind, in order of declaration.

    Attributes:
        measures, actions, functions, components, designs, configurations: the named nodes by name.
        constraints, requirements, estimations: the relations.
        constraints_on: the constraints on each node; a node without any is not there.
        estimations_of: the estimations of each causer, likewise.
        next_order: the place that the next element gets in the order of declaration.
    """

    def __init__(self) -> None:
        self.measures: dict[str, MeasureNode] = {}
        self.actions: dict[str, ActionNode] = {}
        self.functions: dict[str, FunctionNode] = {}
        self.components: dict[str, ComponentNode] = {}
        self.designs: dict[str, DesignNode] = {}
        self.configurations: dict[str, ConfigurationNode] = {}
        self.constraints: list[ConstraintNode] = []
        self.requirements: list[RequirementLink] = []
        self.estimations: list[EstimationLink] = []
        self.constraints_on: dict[Node, list[ConstraintNode]] = {}
        self.estimations_of: dict[Node, list[EstimationLink]] = {}
        self.next_order = 0
        self._named: dict[ElementKind, dict[str, NamedNode]] = {
            ElementKind.MEASURE: self.measures,  # type: ignore[dict-item]
            ElementKind.ACTION: self.actions,  # type: ignore[dict-item]
            ElementKind.FUNCTION: self.functions,  # type: ignore[dict-item]
            ElementKind.COMPONENT: self.components,  # type: ignore[dict-item]
            ElementKind.FUNCTION_DESIGN: self.designs,  # type: ignore[dict-item]
            ElementKind.COMPONENT_CONFIGURATION: self.configurations,  # type: ignore[dict-item]
        }

    # -- what there is --

    def named(self, kind: ElementKind) -> Mapping[str, NamedNode]:
        """The named nodes of a kind."""
        return self._named[kind]

    def elements(self) -> Elements:
        """All elements, each kind in order of declaration."""
        return Elements(
            measures=tuple([node.element for node in self.measures.values()]),
            actions=tuple([node.element for node in self.actions.values()]),
            functions=tuple([node.element for node in self.functions.values()]),
            components=tuple([node.element for node in self.components.values()]),
            requirements=tuple([link.element for link in self.requirements]),
            function_designs=tuple([node.element for node in self.designs.values()]),
            component_configurations=tuple([node.element for node in self.configurations.values()]),
            constraints=tuple([node.constraint for node in self.constraints]),
            estimations=tuple([link.element for link in self.estimations]),
        )

    def find(self, wanted: Element | ElementRef) -> Part | None:
        """The part of an element: by reference or name if it has one, else of the relation that is equal to it."""
        match wanted:
            case FunctionalRequirement(action):
                node = self.actions.get(action)
                return _equal(node.requirements, wanted) if node is not None else None
            case Constraint(constrained=target):
                return _equal(self.constraints_on.get(self._target(target), ()), wanted)  # type: ignore[arg-type]
            case Estimation(causer):
                return _equal(self.estimations_of.get(self._target(causer), ()), wanted)  # type: ignore[arg-type]
            case ElementRef(kind, name):
                return self._named.get(kind, {}).get(name)
        kind_of_type = KIND_OF.get(type(wanted))
        return None if kind_of_type is None else self._named[kind_of_type].get(wanted.name)

    def referring(self, part: Part) -> Iterator[Part]:
        """What names a part; for a measure all constraints and estimations are searched."""
        if isinstance(part, MeasureNode):
            if part.references:
                yield from (node for node in self.constraints if node.measure is part)
                yield from (link for link in self.estimations if link.measure is part)
            return
        if isinstance(part, ActionNode | FunctionNode):
            yield from part.requirements
        if isinstance(part, FunctionNode):
            yield from part.options
        if isinstance(part, ComponentNode):
            yield from chain(part.designs, part.options)
        if isinstance(part, Node):
            yield from self.constraints_on.get(part, ())
            yield from self.estimations_of.get(part, ())

    # -- coming and going --

    def make(self, elements: Elements) -> list[Part]:
        """Make the parts of elements whose names are known or among them, and tie them in.

        Returns:
            the parts: those that have a name, then the relations.
        """
        made: list[Part] = []
        for part in chain(self._named_parts(elements), self._relations(elements)):  # made one by one: names resolve
            self.tie(part)
            made.append(part)
        return made

    def tie(self, part: Part) -> None:
        """Enter a part, at its place in the order of declaration, be it new or one that was taken out."""
        match part:
            case RequirementLink():
                self._tie_requirement(part)
            case EstimationLink():
                part.measure.references += 1
                _put_in(self.estimations_of.setdefault(part.causer, []), part)
                _put_in(self.estimations, part)
            case ConstraintNode():
                part.measure.add_constraint(part)
                _put_in(self.constraints_on.setdefault(part.target, []), part)
                _put_in(self.constraints, part)
                part.join(part.target, part.target.constraints)
            case _:
                self._enter_name(part)
                if isinstance(part, ConfigurationNode):
                    _put_in(part.component.options, part)
                    part.join(part.component, part.component.configurations)
                elif isinstance(part, DesignNode):
                    self._tie_design(part)

    def untie(self, part: Part) -> None:
        """Take a part out; nothing that stays may name it."""
        match part:
            case RequirementLink():
                self._untie_requirement(part)
            case EstimationLink():
                part.measure.references -= 1
                _take_out_of(self.estimations_of, part.causer, part)
                _take_out(self.estimations, part)
            case ConstraintNode():
                part.measure.remove_constraint(part)
                _take_out_of(self.constraints_on, part.target, part)
                _take_out(self.constraints, part)
                part.leave(part.target, part.target.constraints)
            case _:
                del self._named[part.kind][part.name]
                if isinstance(part, ConfigurationNode):
                    _take_out(part.component.options, part)
                    part.leave(part.component, part.component.configurations)
                elif isinstance(part, DesignNode):
                    self._untie_design(part)

    def _tie_requirement(self, link: RequirementLink) -> None:
        action = link.action
        for function in link.functions:
            _put_in(function.requirements, link)
            function.join(action, action.functions)
        _put_in(action.requirements, link)
        action.members = [function for each in action.requirements for function in each.functions]
        _put_in(self.requirements, link)

    def _untie_requirement(self, link: RequirementLink) -> None:
        action = link.action
        for function in link.functions:
            _take_out(function.requirements, link)
            function.leave(action, action.functions)
        _take_out(action.requirements, link)
        action.members = [function for each in action.requirements for function in each.functions]
        _take_out(self.requirements, link)

    @staticmethod
    def _tie_design(design: DesignNode) -> None:
        for member in design.members:
            _put_in(member.designs, design)
            member.join(design, design.components)
        _put_in(design.function.options, design)
        design.join(design.function, design.function.designs)

    @staticmethod
    def _untie_design(design: DesignNode) -> None:
        for member in design.members:
            _take_out(member.designs, design)
            member.leave(design, design.components)
        _take_out(design.function.options, design)
        design.leave(design.function, design.function.designs)

    def _enter_name(self, node: NamedNode) -> None:
        """Enter a node by its name; one that is declared before others goes before them."""
        group = self._named[node.kind]
        is_last = node.order == self.next_order or not group or group[next(reversed(group))].order < node.order
        group[node.name] = node
        if not is_last:
            in_order = sorted(group.items(), key=lambda item: item[1].order)
            group.clear()
            group.update(in_order)

    def _named_parts(self, elements: Elements) -> Iterator[Part]:
        for measure in elements.measures:
            yield MeasureNode(measure, self._place())
        for action in elements.actions:
            yield ActionNode(action, self._place())
        for function in elements.functions:
            yield FunctionNode(function, self._place())
        for component in elements.components:
            yield ComponentNode(component, self._place())
        for design in elements.function_designs:
            members = [self.components[name] for name in design.components]
            yield DesignNode(design, self.functions[design.function], members, self._place())
        for configuration in elements.component_configurations:
            yield ConfigurationNode(configuration, self.components[configuration.component], self._place())

    def _relations(self, elements: Elements) -> Iterator[Part]:
        for requirement in elements.requirements:
            required = [self.functions[name] for name in requirement.functions]
            yield RequirementLink(requirement, self.actions[requirement.action], required, self._place())
        for constraint in elements.constraints:
            target, measured = self._node(constraint.constrained), self.measures[constraint.measure]
            yield ConstraintNode(constraint, measured, target, self._place())
        for estimation in elements.estimations:
            causer, affected = self._node(estimation.causer), self.measures[estimation.measure]
            yield EstimationLink(estimation, causer, affected, self._place())

    def _target(self, ref: ElementRef) -> NamedNode | None:
        return self._named.get(ref.kind, {}).get(ref.name)

    def _node(self, ref: ElementRef) -> Node:
        node = self._named[ref.kind][ref.name]
        if not isinstance(node, Node):
            raise TypeError(f"{ref} has no status")
        return node

    def _place(self) -> int:
        self.next_order += 1
        return self.next_order


def _equal(parts: Iterable[Part], element: Element) -> Part | None:
    return next((part for part in parts if part.element == element), None)


def _put_in(parts: list[_O], part: _O) -> None:
    if parts and parts[-1].order > part.order:
        parts.insert(bisect_left(parts, part.order, key=_order), part)
    else:
        parts.append(part)


def _take_out(parts: list[_O], part: _O) -> None:
    del parts[bisect_left(parts, part.order, key=_order)]


def _take_out_of(groups: dict[Node, list[_O]], node: Node, part: _O) -> None:
    _take_out(groups[node], part)
    if not groups[node]:
        del groups[node]
