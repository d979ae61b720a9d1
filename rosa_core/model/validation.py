"""What makes a set of elements a knowledge model: names that resolve, nothing double, nothing empty."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Protocol

from rosa_core.errors import nearest
from rosa_core.model.elements import (
    CONSTRAINABLE,
    ESTIMABLE,
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


@dataclass(frozen=True, slots=True)
class Flaw:
    """Something wrong within a model, at a path such as ``("action", "fly", "requires", "float")``."""

    path: tuple[str, ...]
    what: str
    hint: str | None = None


_Named = Measure | Action | Function | Component | FunctionDesign | ComponentConfiguration


class Sections(Protocol):
    """Elements by kind: a whole model, or what is to be added to one."""

    @property
    def measures(self) -> tuple[Measure, ...]: ...
    @property
    def actions(self) -> tuple[Action, ...]: ...
    @property
    def functions(self) -> tuple[Function, ...]: ...
    @property
    def components(self) -> tuple[Component, ...]: ...
    @property
    def requirements(self) -> tuple[FunctionalRequirement, ...]: ...
    @property
    def function_designs(self) -> tuple[FunctionDesign, ...]: ...
    @property
    def component_configurations(self) -> tuple[ComponentConfiguration, ...]: ...
    @property
    def constraints(self) -> tuple[Constraint, ...]: ...
    @property
    def estimations(self) -> tuple[Estimation, ...]: ...


class Known(Protocol):
    """What is there already when elements are added."""

    def names(self, kind: ElementKind) -> Mapping[str, object]:
        """The declared names of a kind, in order of declaration."""
        ...

    def requires(self, action: str, function: str) -> bool:
        """Whether the action requires the function.

        Args:
            action: its name.
            function: its name.
        """
        ...

    def has_constraint(self, constraint: Constraint) -> bool:
        """Whether the same constraint is there."""
        ...

    def has_estimation(self, causer: ElementRef, measure: str) -> bool:
        """Whether there is an estimation of that causer on that measure.

        Args:
            causer: a design, component or configuration.
            measure: its name.
        """
        ...


class _Nothing:
    """Nothing is there yet."""

    def names(self, _kind: ElementKind) -> Mapping[str, object]:
        return {}

    def requires(self, _action: str, _function: str) -> bool:
        return False

    def has_constraint(self, _constraint: Constraint) -> bool:
        return False

    def has_estimation(self, _causer: ElementRef, _measure: str) -> bool:
        return False


def _a(kind: ElementKind) -> str:
    """A kind in words, with its article."""
    words = kind.value.replace("_", " ")
    return f"an {words}" if words[0] in "aeiou" else f"a {words}"


class _Names:
    """The declared names, and the words for a name that is not among them."""

    def __init__(self, elements: Sections, known: Known) -> None:
        named: dict[ElementKind, tuple[_Named, ...]] = {
            ElementKind.MEASURE: elements.measures,
            ElementKind.ACTION: elements.actions,
            ElementKind.FUNCTION: elements.functions,
            ElementKind.COMPONENT: elements.components,
            ElementKind.FUNCTION_DESIGN: elements.function_designs,
            ElementKind.COMPONENT_CONFIGURATION: elements.component_configurations,
        }
        self.added = {kind: [element.name for element in several] for kind, several in named.items()}
        self._sets = {kind: frozenset(names) for kind, names in self.added.items()}
        self._known = known

    def knows(self, kind: ElementKind, name: str) -> bool:
        return name in self._sets[kind] or name in self._known.names(kind)

    def dangling(self, path: tuple[str, ...], subject: str, kind: ElementKind, name: str) -> Flaw:
        words = kind.value.replace("_", " ")
        hint = nearest(name, (*self._known.names(kind), *self.added[kind]))
        if hint is None:
            elsewhere = [other for other in self.added if self.knows(other, name)]
            if elsewhere:
                hint = f"'{name}' is {_a(elsewhere[0])}, not {_a(kind)}"
            else:
                hint = f"declare it as {_a(kind)} or name one of those declared"
        return Flaw(path, f"{subject} names the unknown {words} '{name}'", hint)


def find_flaws(elements: Sections, known: Known | None = None) -> list[Flaw]:
    """Everything that is wrong with elements, in their order; empty when they hold together.

    Args:
        elements: a whole model, or what is to be added to one.
        known: what is there already, and is not looked at again; by default nothing is.
    """
    known = _Nothing() if known is None else known
    names = _Names(elements, known)
    return list(
        chain(
            _double_names(names, known),
            _requirements(elements.requirements, names, known),
            chain.from_iterable(_design(design, names) for design in elements.function_designs),
            chain.from_iterable(_configuration(c, names) for c in elements.component_configurations),
            _nodes_only(elements.components),
            _constraints(elements.constraints, names, known),
            _estimations(elements.estimations, names, known),
        )
    )


def _twice(items: Iterable[str], before: Container[str] = ()) -> list[str]:
    return [item for item, count in Counter(items).items() if count > 1 or item in before]


def _double_names(declared: _Names, known: Known) -> Iterator[Flaw]:
    for kind, names in declared.added.items():
        words = kind.value.replace("_", " ")
        before = known.names(kind)
        for name in _twice(names, before):
            yield Flaw((kind, name), f"{words} '{name}' is declared twice", "names are unique within a kind")
        if "" in names:
            yield Flaw((kind, ""), f"{_a(kind)} has an empty name", "give it one")


def _requirements(requirements: Iterable[FunctionalRequirement], names: _Names, known: Known) -> Iterator[Flaw]:
    required: set[tuple[str, str]] = set()
    for requirement in requirements:
        path = (ElementKind.ACTION.value, requirement.action, "requires")
        if not names.knows(ElementKind.ACTION, requirement.action):
            yield names.dangling(path, "a functional requirement", ElementKind.ACTION, requirement.action)
        if not requirement.functions:
            yield Flaw(path, f"a functional requirement of action '{requirement.action}' lists no function")
        for function in requirement.functions:
            at = (*path, function)
            if not names.knows(ElementKind.FUNCTION, function):
                yield names.dangling(at, f"action '{requirement.action}'", ElementKind.FUNCTION, function)
            if (requirement.action, function) in required or known.requires(requirement.action, function):
                yield Flaw(at, f"action '{requirement.action}' requires '{function}' twice", "list it once")
            required.add((requirement.action, function))


def _design(design: FunctionDesign, names: _Names) -> Iterator[Flaw]:
    path = (ElementKind.FUNCTION_DESIGN.value, design.name)
    subject = f"function design '{design.name}'"
    if not names.knows(ElementKind.FUNCTION, design.function):
        yield names.dangling((*path, "function"), subject, ElementKind.FUNCTION, design.function)
    if not design.components:
        yield Flaw((*path, "components"), f"{subject} has no components", "a design is made of at least one")
    for component in _twice(design.components):
        yield Flaw((*path, "components", component), f"{subject} lists component '{component}' twice")
    for component in design.components:
        if not names.knows(ElementKind.COMPONENT, component):
            at = (*path, "components", component)
            if component in (design.name, design.function):
                hint = "a design is made of components"
                yield Flaw(at, f"{subject} is cyclic: it lists '{component}', which it is itself a part of", hint)
            else:
                yield names.dangling(at, subject, ElementKind.COMPONENT, component)
    yield from _priority(path, subject, design.priority)


def _configuration(configuration: ComponentConfiguration, names: _Names) -> Iterator[Flaw]:
    path = (ElementKind.COMPONENT_CONFIGURATION.value, configuration.name)
    subject = f"component configuration '{configuration.name}'"
    if not names.knows(ElementKind.COMPONENT, configuration.component):
        yield names.dangling((*path, "component"), subject, ElementKind.COMPONENT, configuration.component)
    for key in _twice(parameter.key for parameter in configuration.parameters):
        yield Flaw((*path, "parameters", key), f"{subject} gives parameter '{key}' twice")
    for parameter in configuration.parameters:
        if parameter.component != configuration.component:
            what = f"{subject} has a parameter of another component, '{parameter.component}'"
            yield Flaw((*path, "parameters", parameter.key), what)
    yield from _priority(path, subject, configuration.priority)


def _priority(path: tuple[str, ...], subject: str, priority: float | None) -> Iterator[Flaw]:
    if priority is not None and not math.isfinite(priority):
        yield Flaw((*path, "priority"), f"{subject} has priority {priority}", "give a finite number")


def _nodes_only(components: Iterable[Component]) -> Iterator[Flaw]:
    for component in components:
        if not component.type.is_node and (component.package or component.executable):
            yield Flaw(
                (
                    ElementKind.COMPONENT.value,
                    component.name,
                    "package" if component.package else "executable",
                ),
                f"component '{component.name}' is not a node, so it has no package or executable",
                "say 'type: lifecycle_node' or 'type: ros_node'",
            )


def _constraints(constraints: Iterable[Constraint], names: _Names, known: Known) -> Iterator[Flaw]:
    seen = set()
    for constraint in constraints:
        path = (
            constraint.constrained.kind.value,
            constraint.constrained.name,
            "constraints",
            constraint.measure,
        )
        subject = f"a constraint on {constraint.constrained}"
        yield from _on_element(path, subject, constraint.constrained, CONSTRAINABLE, names)
        if not names.knows(ElementKind.MEASURE, constraint.measure):
            yield names.dangling(path, subject, ElementKind.MEASURE, constraint.measure)
        if constraint.value is not None and not math.isfinite(constraint.value):
            yield Flaw(path, f"{subject} has the value {constraint.value}", "give a finite number")
        if constraint in seen or known.has_constraint(constraint):
            yield Flaw(path, f"{subject} stands twice: {constraint}", "state it once")
        seen.add(constraint)


def _estimations(estimations: Iterable[Estimation], names: _Names, known: Known) -> Iterator[Flaw]:
    seen = set()
    for estimation in estimations:
        path = (estimation.causer.kind.value, estimation.causer.name, "estimations", estimation.measure)
        subject = f"an estimation for {estimation.causer}"
        yield from _on_element(path, subject, estimation.causer, ESTIMABLE, names)
        if not names.knows(ElementKind.MEASURE, estimation.measure):
            yield names.dangling(path, subject, ElementKind.MEASURE, estimation.measure)
        if not math.isfinite(estimation.value):
            yield Flaw(path, f"{subject} has the value {estimation.value}", "give a finite number")
        key = (estimation.causer, estimation.measure)
        if key in seen or known.has_estimation(*key):
            yield Flaw(path, f"{subject} on '{estimation.measure}' stands twice", "one causer, one estimate")
        seen.add(key)


def _on_element(
    path: tuple[str, ...], subject: str, ref: ElementRef, kinds: frozenset[ElementKind], names: _Names
) -> Iterator[Flaw]:
    if ref.kind not in kinds:
        allowed = ", ".join(sorted(kind.value.replace("_", " ") for kind in kinds))
        yield Flaw(path, f"{subject} cannot be: only on {allowed}")
    elif not names.knows(ref.kind, ref.name):
        yield names.dangling(path, subject, ref.kind, ref.name)
