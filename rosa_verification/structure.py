"""When each element is unfeasible, as a formula over failures and regions of measures, made from the status rules.

Whether an element is unfeasible follows from failures and violated constraints alone, not from what is required,
selected or active. The rules (:mod:`rosa_core.inference.rules`) ask which statuses occur among the elements of a group,
so that a few questions to a rule, one for each mixture of good and bad, say what it makes of the group: here they are
asked, and nothing is stated a second time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cache

from rosa_core.inference.rules import (
    action_status,
    component_configuration_status,
    component_status,
    constraint_status,
    function_design_status,
    function_status,
    is_selectable,
)
from rosa_core.model.elements import Constraint, ElementKind, ElementRef
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.status import Status
from rosa_verification.causes import GREATEST, LEAST, Cause, Region

KINDS = (
    ElementKind.ACTION,
    ElementKind.FUNCTION,
    ElementKind.FUNCTION_DESIGN,
    ElementKind.COMPONENT,
    ElementKind.COMPONENT_CONFIGURATION,
)
"""The kinds of element that can be unfeasible."""


class Combination(StrEnum):
    """How many of a gate's inputs must be bad."""

    ANY = "any"
    ALL = "all"


@dataclass(frozen=True, slots=True)
class Gate:
    """Bad if any, or all, of its inputs are; of no inputs never, or always.

    Args:
        combination: how many of them.
        inputs: causes, elements that are unfeasible (or failed), and gates.
    """

    combination: Combination
    inputs: tuple[Cause | ElementRef | Gate, ...]


_Statuses = frozenset[Status]
_Rule = Callable[[_Statuses], Status]


class _Group(StrEnum):
    FAILURE = "failure"
    CONSTRAINTS = "constraints"
    PARTS = "parts"


def _component_rule(
    failed: bool = False, constraints: _Statuses = frozenset(), configurations: _Statuses = frozenset()
) -> Status:
    return component_status(
        failed=failed,
        required=False,
        active=False,
        constraints=constraints,
        configurations=configurations,
        selected_configurations=(),
    )


_NONE: _Statuses = frozenset()
_RULES: Mapping[ElementKind, Mapping[_Group, _Rule]] = {
    ElementKind.COMPONENT_CONFIGURATION: {_Group.CONSTRAINTS: component_configuration_status},
    ElementKind.COMPONENT: {
        _Group.FAILURE: lambda statuses: _component_rule(failed=Status.FAILURE in statuses),
        _Group.CONSTRAINTS: lambda statuses: _component_rule(constraints=statuses),
        _Group.PARTS: lambda statuses: _component_rule(configurations=statuses),
    },
    ElementKind.FUNCTION_DESIGN: {
        _Group.CONSTRAINTS: lambda s: function_design_status(selected=False, constraints=s, components=_NONE),
        _Group.PARTS: lambda s: function_design_status(selected=False, constraints=_NONE, components=s),
    },
    ElementKind.FUNCTION: {
        _Group.PARTS: lambda s: function_status(required=False, designs=s, selected_designs=_NONE),
    },
    ElementKind.ACTION: {
        _Group.CONSTRAINTS: lambda s: action_status(required=False, constraints=s, functions=_NONE),
        _Group.PARTS: lambda s: action_status(required=False, constraints=_NONE, functions=s),
    },
}
"""For each group of what a status follows from: the rule, with nothing bad in the other groups."""

_GOOD_AND_BAD = {
    _Group.FAILURE: (Status.FEASIBLE, Status.FAILURE),
    _Group.CONSTRAINTS: (Status.SATISFIED, Status.VIOLATED),
    _Group.PARTS: (Status.FEASIBLE, Status.UNFEASIBLE),
}


@cache
def combination_of(kind: ElementKind, group: str, *, is_empty: bool) -> Combination | None:
    """How many of a group must be bad for an element to be unfeasible, as its rule answers.

    >>> combination_of(ElementKind.FUNCTION, "parts", is_empty=False)
    <Combination.ALL: 'all'>
    >>> combination_of(ElementKind.FUNCTION, "parts", is_empty=True)
    <Combination.ALL: 'all'>
    >>> combination_of(ElementKind.COMPONENT, "parts", is_empty=True) is None
    True

    Args:
        kind: of the element.
        group: "failure", "constraints" or "parts": what the element is made of.
        is_empty: whether there is nothing in the group.

    Returns:
        None if the group does not matter.
    """
    rule = _RULES[kind].get(_Group(group))
    if rule is None:
        return None
    if is_empty:
        return None if is_selectable(rule(_NONE)) else Combination.ALL
    good, bad = _GOOD_AND_BAD[_Group(group)]
    if not is_selectable(rule(frozenset({good, bad}))):
        return Combination.ANY
    return None if is_selectable(rule(frozenset({bad}))) else Combination.ALL


def violated_region(constraint: Constraint) -> Region | None:
    """Where a measure violates a constraint; None if it never does.

    >>> print(violated_region(Constraint("battery", ElementRef(ElementKind.ACTION, "fly"), value=0.2)))
    battery < 0.2
    """
    limit = constraint.value
    if limit is None:
        return None
    below, at, above = (
        constraint_status(constraint.operator, limit, value) is Status.VIOLATED
        for value in (-math.inf, limit, math.inf)
    )
    return Region(
        constraint.measure,
        LEAST if below else (limit, 0 if at else 1),
        GREATEST if above else (limit, 1 if at else 0),
    )


class Structure:
    """The formulas of a model.

    Args:
        model: whose elements they are.
    """

    def __init__(self, model: KnowledgeModel) -> None:
        self.model = model
        self.parts: dict[ElementRef, list[ElementRef]] = {
            ElementRef(kind, name): [] for kind in KINDS for name in model.names[kind]
        }
        """Of what each element is made: functions of an action, designs, components, configurations."""
        for requirement in model.requirements:
            functions = (ElementRef(ElementKind.FUNCTION, name) for name in requirement.functions)
            self.parts[ElementRef(ElementKind.ACTION, requirement.action)] += functions
        for design in model.function_designs:
            ref = ElementRef(ElementKind.FUNCTION_DESIGN, design.name)
            self.parts[ElementRef(ElementKind.FUNCTION, design.function)].append(ref)
            self.parts[ref] += (ElementRef(ElementKind.COMPONENT, name) for name in design.components)
        for configuration in model.component_configurations:
            ref = ElementRef(ElementKind.COMPONENT_CONFIGURATION, configuration.name)
            self.parts[ElementRef(ElementKind.COMPONENT, configuration.component)].append(ref)
        self.violations: dict[ElementRef, list[Region]] = {}
        """Where the constraints on each element are violated; elements without are absent."""
        for constraint in model.constraints:
            region = violated_region(constraint)
            if region is not None:
                self.violations.setdefault(constraint.constrained, []).append(region)
        self._gates: dict[ElementRef, Gate] = {}

    def elements(self) -> list[ElementRef]:
        """All elements that can be unfeasible, by kind, in order of declaration."""
        return list(self.parts)

    def unfeasible(self, element: ElementRef) -> Gate:
        """When an element is unfeasible, or failed.

        Args:
            element: one of :meth:`elements`.
        """
        known = self._gates.get(element)
        if known is None:
            known = self._gates[element] = self._gate(element)
        return known

    def _gate(self, element: ElementRef) -> Gate:
        kind, parts = element.kind, tuple(dict.fromkeys(self.parts[element]))
        groups: dict[_Group, tuple[Cause | ElementRef, ...]] = {
            _Group.FAILURE: (element.name,),
            _Group.CONSTRAINTS: tuple(dict.fromkeys(self.violations.get(element, ()))),
            _Group.PARTS: parts,
        }
        inputs: list[Cause | ElementRef | Gate] = []
        for group, members in groups.items():
            combination = combination_of(kind, group, is_empty=not members)
            if combination is Combination.ANY:
                inputs += members
            elif combination is Combination.ALL:
                inputs.append(Gate(Combination.ALL, members))
        return Gate(Combination.ANY, tuple(inputs))
