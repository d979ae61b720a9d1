"""What a model gains and loses while a robot runs: some elements, what they refer to, and how they are described."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any

from rosa_core.errors import KnowledgeModelError, Problem
from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    Constraint,
    ElementKind,
    ElementRef,
    Estimation,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from rosa_core.model.knowledge_model import KnowledgeModel

NamedElement = Measure | Action | Function | Component | FunctionDesign | ComponentConfiguration
Relation = FunctionalRequirement | Constraint | Estimation
Element = NamedElement | Relation

KIND_OF: Mapping[type, ElementKind] = {
    Measure: ElementKind.MEASURE,
    Action: ElementKind.ACTION,
    Function: ElementKind.FUNCTION,
    Component: ElementKind.COMPONENT,
    FunctionDesign: ElementKind.FUNCTION_DESIGN,
    ComponentConfiguration: ElementKind.COMPONENT_CONFIGURATION,
}
"""The kinds of the elements that have a name, by their types."""


@dataclass(frozen=True, slots=True)
class Elements:
    """Some elements, by kind as a model has them.

    Args:
        measures, actions, functions, components, requirements, function_designs, component_configurations, constraints,
            estimations: each kind in order of declaration; names may point outside.
    """

    measures: tuple[Measure, ...] = ()
    actions: tuple[Action, ...] = ()
    functions: tuple[Function, ...] = ()
    components: tuple[Component, ...] = ()
    requirements: tuple[FunctionalRequirement, ...] = ()
    function_designs: tuple[FunctionDesign, ...] = ()
    component_configurations: tuple[ComponentConfiguration, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    estimations: tuple[Estimation, ...] = ()

    @classmethod
    def of(cls, elements: Iterable[Element]) -> Elements:
        """Sort elements; each kind keeps its order.

        Args:
            elements: of any kinds, in order of declaration.

        Raises:
            KnowledgeModelError: if one is not an element.
        """
        sorted_: dict[str, list[Any]] = {}
        for element in elements:
            section = _SECTIONS.get(type(element))
            if section is None:
                hint = f"an element is one of: {', '.join(kind.__name__ for kind in _SECTIONS)}"
                raise KnowledgeModelError(Problem(f"{element!r} is not an element of a model", hint=hint))
            sorted_.setdefault(section, []).append(element)
        return cls(**{section: tuple(several) for section, several in sorted_.items()})

    def __iter__(self) -> Iterator[Element]:
        for field in fields(self):
            yield from getattr(self, field.name)


NO_ELEMENTS = Elements()

_SECTIONS: dict[type, str] = {
    Measure: "measures",
    Action: "actions",
    Function: "functions",
    Component: "components",
    FunctionalRequirement: "requirements",
    FunctionDesign: "function_designs",
    ComponentConfiguration: "component_configurations",
    Constraint: "constraints",
    Estimation: "estimations",
}


def ref(element: NamedElement) -> ElementRef:
    """The kind and name of an element that has a name.

    Example:
        >>> print(ref(Component("lidar")))
        component 'lidar'
    """
    return ElementRef(KIND_OF[type(element)], element.name)


def referring_to(model: KnowledgeModel, target: ElementRef) -> tuple[Element, ...]:
    """The elements of a model that refer to one by name, and so would keep it from being removed.

    Args:
        model: to search.
        target: the element referred to; it need not be in the model.

    Returns:
        in the order of the model's kinds, then of declaration.
    """
    return tuple(element for element in elements_of(model) if target in references(element))


def references(element: Element) -> Iterator[ElementRef]:
    """What an element refers to by name.

    Example:
        >>> from rosa_core.model import FunctionDesign
        >>> [str(reference) for reference in references(FunctionDesign("by lidar", "see", ("lidar",)))]
        ["function 'see'", "component 'lidar'"]
    """
    match element:
        case FunctionalRequirement(action, functions):
            yield ElementRef(ElementKind.ACTION, action)
            for function in functions:
                yield ElementRef(ElementKind.FUNCTION, function)
        case FunctionDesign(_, function, components):
            yield ElementRef(ElementKind.FUNCTION, function)
            for component in components:
                yield ElementRef(ElementKind.COMPONENT, component)
        case ComponentConfiguration(_, component):
            yield ElementRef(ElementKind.COMPONENT, component)
        case Constraint(measure, constrained):
            yield ElementRef(ElementKind.MEASURE, measure)
            yield constrained
        case Estimation(causer, measure):
            yield causer
            yield ElementRef(ElementKind.MEASURE, measure)


def elements_of(model: KnowledgeModel) -> Iterator[Element]:
    """All elements and relations of a model, by kind and in order of declaration."""
    for field in fields(Elements):
        yield from getattr(model, field.name)


def describe(element: object) -> str:
    """An element in words."""
    match element:
        case FunctionalRequirement(action, functions):
            return f"functional requirement of action '{action}' ({', '.join(functions)})"
        case Constraint(constrained=constrained):
            return f"constraint {element} on {constrained}"
        case Estimation(causer, measure, value, kind):
            return f"estimation of {causer} on '{measure}' ({kind} {value:g})"
        case Measure() | Action() | Function() | Component() | FunctionDesign() | ComponentConfiguration():
            return str(ref(element))
    return repr(element)


def difference(one: KnowledgeModel, other: KnowledgeModel, names: tuple[str, str]) -> str:
    """What two models that are not equal do not share, in words.

    Args:
        one: a model.
        other: another, which differs.
        names: what to call the two, such as ``("the file", "the journal")``.

    Returns:
        the first three elements that only one of them has, and how many more; a hint at the order if there are none.
    """
    in_one, in_other = set(elements_of(one)), set(elements_of(other))
    only_one = [describe(element) for element in elements_of(one) if element not in in_other]
    only_other = [describe(element) for element in elements_of(other) if element not in in_one]
    parts = [
        f"only {whose} has {', '.join(words[:3])}" + (f" and {len(words) - 3} more" if len(words) > 3 else "")
        for whose, words in zip(names, (only_one, only_other), strict=True)
        if words
    ]
    return "; ".join(parts) or "they declare the same in another order"
