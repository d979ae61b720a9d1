"""Knowledge as facts: things of a type, with attributes and, for relations, role players.

This is the form that patterns are matched against (:mod:`rosa_typeql.matching.patterns`). Tables are made type by type,
when they are first asked for, so that asking about actions does not cost anything per component.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from rosa_core.model.elements import (
    Action,
    Annotation,
    Component,
    ComponentConfiguration,
    ComponentParameter,
    ComponentType,
    Constraint,
    ElementKind,
    ElementRef,
    Estimation,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
    MeasureKind,
    Scalar,
)
from rosa_typeql.matching.parameter_text import parameter_text
from rosa_typeql.schema.table import TYPES, owned, resting_on

_RANKS = {label: rank for rank, label in enumerate(TYPES)}


class Attribute(NamedTuple):
    """A value of an attribute. The same label and value are the same attribute, whoever has it."""

    label: str
    value: Scalar


@dataclass(frozen=True, slots=True, eq=False)
class Thing:
    """An entity or relation. ``order`` is its place among those of its type; ``ref`` is set for named elements."""

    type: str
    order: int
    attributes: Mapping[str, tuple[Scalar, ...]]
    players: tuple[tuple[str, Thing], ...] = ()
    ref: ElementRef | None = None

    @property
    def rank(self) -> tuple[int, int]:
        """For sorting things of several types in an order that is the same in every run."""
        return _RANKS[self.type], self.order


class FactTables:
    """Tables of things by exact type, with indexes that are made when first used."""

    def __init__(self, loaders: Mapping[str, Callable[[FactTables], Iterable[Thing]]]) -> None:
        self._loaders = loaders
        self._tables: dict[str, tuple[Thing, ...]] = {}
        self._owners: dict[tuple[str, str], dict[Scalar, list[Thing]]] = {}
        self._related: dict[str, dict[Thing, list[Thing]]] = {}
        self._by_ref: dict[ElementRef, Thing] = {}

    def reset(self, labels: Iterable[str]) -> None:
        """Make the tables of these types anew when they are next asked for, and those of relations between them."""
        stale = {below for label in labels for below in (label, *resting_on(label))}
        if "component-configuration" in stale:
            stale.add("ComponentParameter")
        for label in stale:
            for thing in self._tables.pop(label, ()):
                if thing.ref is not None:
                    self._by_ref.pop(thing.ref, None)
            self._related.pop(label, None)
        self._owners = {key: index for key, index in self._owners.items() if key[0] not in stale}

    def of(self, label: str) -> tuple[Thing, ...]:
        """All things of exactly this type, in order of declaration."""
        table = self._tables.get(label)
        if table is None:
            loader = self._loaders.get(label)
            table = self._tables[label] = () if loader is None else tuple(loader(self))
            self._by_ref.update({thing.ref: thing for thing in table if thing.ref is not None})
        return table

    def element(self, ref: ElementRef) -> Thing | None:
        """The thing that an element is, None if there is none."""
        if ref not in self._by_ref:
            for label in _LABELS[ref.kind]:
                self.of(label)
        return self._by_ref.get(ref)

    def owners(self, label: str, attribute: str, value: Scalar) -> list[Thing]:
        """The things of exactly this type that have this value of the attribute."""
        index = self._owners.get((label, attribute))
        if index is None:
            index = self._owners[label, attribute] = defaultdict(list)
            for thing in self.of(label):
                for known in thing.attributes.get(attribute, ()):
                    index[known].append(thing)
        return index.get(value, [])

    def relations(self, label: str, player: Thing) -> list[Thing]:
        """The relations of exactly this type in which the thing plays a role."""
        index = self._related.get(label)
        if index is None:
            index = self._related[label] = defaultdict(list)
            for relation in self.of(label):
                for known in dict.fromkeys(thing for _, thing in relation.players):
                    index[known].append(relation)
        return index.get(player, [])


class Elements(Protocol):
    """The elements of a model, finished or in the making."""

    @property
    def measures(self) -> Sequence[Measure]: ...
    @property
    def actions(self) -> Sequence[Action]: ...
    @property
    def functions(self) -> Sequence[Function]: ...
    @property
    def components(self) -> Sequence[Component]: ...
    @property
    def requirements(self) -> Sequence[FunctionalRequirement]: ...
    @property
    def function_designs(self) -> Sequence[FunctionDesign]: ...
    @property
    def component_configurations(self) -> Sequence[ComponentConfiguration]: ...
    @property
    def constraints(self) -> Sequence[Constraint]: ...
    @property
    def estimations(self) -> Sequence[Estimation]: ...
    @property
    def annotations(self) -> Sequence[Annotation]: ...


MEASURE_LABELS = {
    MeasureKind.MEASURE: "Measure",
    MeasureKind.ENVIRONMENTAL: "EnvironmentalAttribute",
    MeasureKind.QUALITY: "QualityAttribute",
}
COMPONENT_LABELS = {
    ComponentType.COMPONENT: "Component",
    ComponentType.ROS_NODE: "ROSNode",
    ComponentType.LIFECYCLE_NODE: "LifeCycleNode",
}
_LABELS: dict[ElementKind, tuple[str, ...]] = {
    ElementKind.MEASURE: tuple(MEASURE_LABELS.values()),
    ElementKind.ACTION: ("Action",),
    ElementKind.FUNCTION: ("Function",),
    ElementKind.COMPONENT: tuple(COMPONENT_LABELS.values()),
    ElementKind.FUNCTION_DESIGN: ("function-design",),
    ElementKind.COMPONENT_CONFIGURATION: ("component-configuration",),
    ElementKind.CONSTRAINT: ("constraint",),
}

RunTimeFacts = Callable[[ElementRef | Constraint], Mapping[str, Scalar]]
"""The attributes that an element has at run time, by label."""


def _nothing(_element: ElementRef | Constraint) -> Mapping[str, Scalar]:
    return {}


class ElementLoaders:
    """Makes the tables of a model's elements; ``run_time`` adds what is known of them at run time."""

    def __init__(self, elements: Elements, run_time: RunTimeFacts = _nothing) -> None:
        self._elements = elements
        self._run_time = run_time
        self._annotations: dict[ElementRef, list[Annotation]] = defaultdict(list)
        self._annotated = 0

    def loaders(self) -> dict[str, Callable[[FactTables], Iterable[Thing]]]:
        """What to give to :class:`FactTables`."""
        loaders: dict[str, Callable[[FactTables], Iterable[Thing]]] = {
            "Action": lambda _: self._actions(),
            "Function": lambda _: self._functions(),
            "ComponentParameter": lambda _: (thing for thing, _ in self._parameters()),
            "functional-requirement": self._requirements,
            "function-design": self._designs,
            "component-configuration": self._configurations,
            "constraint": self._constraints,
            "estimation": self._estimations,
        }
        loaders.update({label: self._measures(kind) for kind, label in MEASURE_LABELS.items()})
        loaders.update({label: self._components(kind) for kind, label in COMPONENT_LABELS.items()})
        return loaders

    def _thing(
        self,
        label: str,
        order: int,
        ref: ElementRef,
        attributes: Mapping[str, Scalar | None],
        players: Iterable[tuple[str, Thing | None]] = (),
        of: ElementRef | Constraint | None = None,
    ) -> Thing:
        """A thing with what is stated of it, what was annotated, and what is known at run time, which counts most."""
        known: dict[str, tuple[Scalar, ...]] = {}
        for annotation in self._annotations_of(ref):
            if annotation.attribute in owned(label):
                known[annotation.attribute] = (*known.get(annotation.attribute, ()), annotation.value)
        known.update({name: (value,) for name, value in attributes.items() if value is not None})
        known.update({name: (value,) for name, value in self._run_time(of or ref).items()})
        told = tuple((role, player) for role, player in players if player is not None)
        return Thing(label, order, known, told, ref)

    def _annotations_of(self, ref: ElementRef) -> Sequence[Annotation]:
        annotations = self._elements.annotations
        if self._annotated != len(annotations):
            # Of a model in the making there may be more than before.
            for annotation in annotations[self._annotated :]:
                self._annotations[annotation.element].append(annotation)
            self._annotated = len(annotations)
        return self._annotations.get(ref, ())

    def _measures(self, kind: MeasureKind) -> Callable[[FactTables], Iterable[Thing]]:
        return lambda _: (
            self._thing(MEASURE_LABELS[kind], i, ElementRef(ElementKind.MEASURE, m.name), {"measure-name": m.name})
            for i, m in enumerate(self._elements.measures)
            if m.kind is kind
        )

    def _actions(self) -> Iterable[Thing]:
        for i, action in enumerate(self._elements.actions):
            yield self._thing("Action", i, ElementRef(ElementKind.ACTION, action.name), {"action-name": action.name})

    def _functions(self) -> Iterable[Thing]:
        for i, function in enumerate(self._elements.functions):
            attributes: dict[str, Scalar | None] = {
                "function-name": function.name,
                "always-improve": function.always_improve,
            }
            yield self._thing("Function", i, ElementRef(ElementKind.FUNCTION, function.name), attributes)

    def _components(self, kind: ComponentType) -> Callable[[FactTables], Iterable[Thing]]:
        return lambda _: (
            self._thing(
                COMPONENT_LABELS[kind],
                i,
                ElementRef(ElementKind.COMPONENT, component.name),
                {
                    "component-name": component.name,
                    "always-improve": component.always_improve,
                    "package": component.package,
                    "executable": component.executable,
                },
            )
            for i, component in enumerate(self._elements.components)
            if component.type is kind
        )

    def _parameters(self) -> Iterable[tuple[Thing, ComponentParameter]]:
        distinct = dict.fromkeys(p for c in self._elements.component_configurations for p in c.parameters)
        for i, parameter in enumerate(distinct):
            attributes: dict[str, tuple[Scalar, ...]] = {
                "parameter-key": (parameter.key,),
                "parameter-value": (parameter_text(parameter.value),),
                "parameter-type": (parameter.type.value,),
            }
            yield Thing("ComponentParameter", i, attributes), parameter

    def _requirements(self, tables: FactTables) -> Iterable[Thing]:
        for i, requirement in enumerate(self._elements.requirements):
            players = [("action", tables.element(ElementRef(ElementKind.ACTION, requirement.action)))]
            for function in requirement.functions:
                players.append(("required-function", tables.element(ElementRef(ElementKind.FUNCTION, function))))
            told = tuple((role, player) for role, player in players if player is not None)
            yield Thing("functional-requirement", i, {}, told)

    def _designs(self, tables: FactTables) -> Iterable[Thing]:
        for i, design in enumerate(self._elements.function_designs):
            players = [("function", tables.element(ElementRef(ElementKind.FUNCTION, design.function)))]
            for component in design.components:
                players.append(("required-component", tables.element(ElementRef(ElementKind.COMPONENT, component))))
            ref = ElementRef(ElementKind.FUNCTION_DESIGN, design.name)
            attributes = {"function-design-name": design.name, "priority": design.priority}
            yield self._thing("function-design", i, ref, attributes, players)

    def _configurations(self, tables: FactTables) -> Iterable[Thing]:
        # The table holds the same things that the parameters' table makes: one order, so the same index.
        distinct = dict.fromkeys(p for c in self._elements.component_configurations for p in c.parameters)
        parameters = dict(zip(distinct, tables.of("ComponentParameter"), strict=True))
        for i, configuration in enumerate(self._elements.component_configurations):
            component = tables.element(ElementRef(ElementKind.COMPONENT, configuration.component))
            players = [("component", component), *(("parameter", parameters[p]) for p in configuration.parameters)]
            ref = ElementRef(ElementKind.COMPONENT_CONFIGURATION, configuration.name)
            attributes = {"component-configuration-name": configuration.name, "priority": configuration.priority}
            yield self._thing("component-configuration", i, ref, attributes, players)

    def _constraints(self, tables: FactTables) -> Iterable[Thing]:
        for i, constraint in enumerate(self._elements.constraints):
            players = [
                ("constraint", tables.element(ElementRef(ElementKind.MEASURE, constraint.measure))),
                ("constrained", tables.element(constraint.constrained)),
            ]
            attributes = {"attribute-value": constraint.value, "constraint-operator": constraint.operator.value}
            yield self._thing("constraint", i, constraint_ref(constraint), attributes, players, constraint)

    def _estimations(self, tables: FactTables) -> Iterable[Thing]:
        for i, estimation in enumerate(self._elements.estimations):
            players = [
                ("causer", tables.element(estimation.causer)),
                ("affected", tables.element(ElementRef(ElementKind.MEASURE, estimation.measure))),
            ]
            told = tuple((role, player) for role, player in players if player is not None)
            attributes: dict[str, tuple[Scalar, ...]] = {
                "estimation-value": (estimation.value,),
                "estimation-type": (estimation.type.value,),
            }
            yield Thing("estimation", i, attributes, told)


def constraint_ref(constraint: Constraint) -> ElementRef:
    """What a constraint is called: it has no name of its own."""
    return ElementRef(ElementKind.CONSTRAINT, f"{constraint} on {constraint.constrained}")
