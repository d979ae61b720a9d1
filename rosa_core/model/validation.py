"""What makes a set of elements a knowledge model: names that resolve, nothing double, nothing empty."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Protocol

from rosa_core.errors import nearest
from rosa_core.model.elements import (
    CONSTRAINABLE,
    ESTIMABLE,
    Component,
    ComponentConfiguration,
    Constraint,
    ElementKind,
    ElementRef,
    Estimation,
    FunctionalRequirement,
    FunctionDesign,
)


@dataclass(frozen=True, slots=True)
class Flaw:
    """Something wrong within a model, at a path such as ``("action", "fly", "requires", "float")``."""

    path: tuple[str, ...]
    what: str
    hint: str | None = None


class DeclaredElements(Protocol):
    """What is checked: the names of each kind in order of declaration, and the elements that refer to names.

    A :class:`~rosa_core.model.KnowledgeModel` is one.
    """

    @property
    def names(self) -> Mapping[ElementKind, tuple[str, ...]]: ...
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


def _a(kind: ElementKind) -> str:
    """A kind in words, with its article."""
    words = kind.value.replace("_", " ")
    return f"an {words}" if words[0] in "aeiou" else f"a {words}"


class _Names:
    """The declared names, and the words for a name that is not among them."""

    def __init__(self, model: DeclaredElements) -> None:
        self._ordered = model.names
        self._sets = {kind: frozenset(names) for kind, names in model.names.items()}

    def knows(self, kind: ElementKind, name: str) -> bool:
        return name in self._sets[kind]

    def dangling(self, path: tuple[str, ...], subject: str, kind: ElementKind, name: str) -> Flaw:
        words = kind.value.replace("_", " ")
        hint = nearest(name, self._ordered[kind])
        if hint is None:
            elsewhere = [other for other, names in self._sets.items() if name in names]
            if elsewhere:
                hint = f"'{name}' is {_a(elsewhere[0])}, not {_a(kind)}"
            else:
                hint = f"declare it as {_a(kind)} or name one of those declared"
        return Flaw(path, f"{subject} names the unknown {words} '{name}'", hint)


def find_flaws(model: DeclaredElements) -> list[Flaw]:
    """Everything that is wrong with a model, in the order of its elements; empty when it holds together."""
    names = _Names(model)
    return list(
        chain(
            _double_names(model),
            _requirements(model, names),
            chain.from_iterable(_design(design, names) for design in model.function_designs),
            chain.from_iterable(_configuration(c, names) for c in model.component_configurations),
            _nodes_only(model),
            _constraints(model, names),
            _estimations(model, names),
        )
    )


def _twice(items: Iterable[str]) -> list[str]:
    return [item for item, count in Counter(items).items() if count > 1]


def _double_names(model: DeclaredElements) -> Iterator[Flaw]:
    for kind, names in model.names.items():
        words = kind.value.replace("_", " ")
        for name in _twice(names):
            yield Flaw((kind, name), f"{words} '{name}' is declared twice", "names are unique within a kind")
        if "" in names:
            yield Flaw((kind, ""), f"{_a(kind)} has an empty name", "give it one")


def _requirements(model: DeclaredElements, names: _Names) -> Iterator[Flaw]:
    required: set[tuple[str, str]] = set()
    for requirement in model.requirements:
        path = (ElementKind.ACTION.value, requirement.action, "requires")
        if not names.knows(ElementKind.ACTION, requirement.action):
            yield names.dangling(path, "a functional requirement", ElementKind.ACTION, requirement.action)
        if not requirement.functions:
            yield Flaw(path, f"a functional requirement of action '{requirement.action}' lists no function")
        for function in requirement.functions:
            at = (*path, function)
            if not names.knows(ElementKind.FUNCTION, function):
                yield names.dangling(at, f"action '{requirement.action}'", ElementKind.FUNCTION, function)
            if (requirement.action, function) in required:
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


def _nodes_only(model: DeclaredElements) -> Iterator[Flaw]:
    for component in model.components:
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


def _constraints(model: DeclaredElements, names: _Names) -> Iterator[Flaw]:
    seen = set()
    for constraint in model.constraints:
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
        if constraint in seen:
            yield Flaw(path, f"{subject} stands twice: {constraint}", "state it once")
        seen.add(constraint)


def _estimations(model: DeclaredElements, names: _Names) -> Iterator[Flaw]:
    seen = set()
    for estimation in model.estimations:
        path = (estimation.causer.kind.value, estimation.causer.name, "estimations", estimation.measure)
        subject = f"an estimation for {estimation.causer}"
        yield from _on_element(path, subject, estimation.causer, ESTIMABLE, names)
        if not names.knows(ElementKind.MEASURE, estimation.measure):
            yield names.dangling(path, subject, ElementKind.MEASURE, estimation.measure)
        if not math.isfinite(estimation.value):
            yield Flaw(path, f"{subject} has the value {estimation.value}", "give a finite number")
        key = (estimation.causer, estimation.measure)
        if key in seen:
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
