"""The elements of a model as facts."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any

from rosa_core.formats.builder import ModelBuilder
from rosa_core.model.elements import Annotation, ComponentParameter, Constraint, ElementKind, ElementRef, Scalar
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_typeql.matching.facts import COMPONENT_LABELS, MEASURE_LABELS, FactTables, Loader, Thing, cast
from rosa_typeql.matching.parameter_text import parameter_text
from rosa_typeql.schema.table import key_of, owned

RunTimeFacts = Callable[[ElementRef | Constraint], Mapping[str, Scalar]]
"""The attributes that an element has at run time, by label."""

_FIELDS = {"always-improve": "always_improve", "package": "package", "executable": "executable"}


def _nothing(_element: ElementRef | Constraint) -> Mapping[str, Scalar]:
    return {}


class ElementLoaders:
    """Makes the tables of a model's elements.

    Args:
        elements: the model, finished or in the making.
        run_time: adds what is known of an element at run time.
    """

    def __init__(self, elements: KnowledgeModel | ModelBuilder, run_time: RunTimeFacts = _nothing) -> None:
        self._elements = elements
        self._run_time = run_time
        self._annotations: dict[ElementRef, list[Annotation]] = defaultdict(list)
        self._annotated = 0

    def loaders(self) -> dict[str, Loader]:
        """What to give to :class:`FactTables`."""
        return {
            "Action": partial(self._entities, "Action", ElementKind.ACTION, "actions", {}),
            "Function": partial(self._entities, "Function", ElementKind.FUNCTION, "functions", {}),
            **{
                label: partial(self._entities, label, ElementKind.MEASURE, "measures", {"kind": kind})
                for kind, label in MEASURE_LABELS.items()
            },
            **{
                label: partial(self._entities, label, ElementKind.COMPONENT, "components", {"type": kind})
                for kind, label in COMPONENT_LABELS.items()
            },
            "ComponentParameter": lambda _: (_parameter(i, p) for i, p in enumerate(self._distinct_parameters())),
            "functional-requirement": self._requirements,
            "function-design": self._designs,
            "component-configuration": self._configurations,
            "constraint": self._constraints,
            "estimation": self._estimations,
        }

    def _thing(
        self,
        order: int,
        label: str,
        ref: ElementRef,
        attributes: Mapping[str, Scalar | None],
        players: Sequence[tuple[str, Thing | None]] = (),
        of: ElementRef | Constraint | None = None,
    ) -> Thing:
        """A thing with what is stated of it, what was annotated, and what is known at run time, which counts most."""
        known: dict[str, tuple[Scalar, ...]] = {}
        for annotation in self._annotations_of(ref):
            if annotation.attribute in owned(label):
                known[annotation.attribute] = (*known.get(annotation.attribute, ()), annotation.value)
        key = key_of(label)
        stated = attributes if key is None else {key: ref.name, **attributes}
        known.update({name: (value,) for name, value in stated.items() if value is not None})
        known.update({name: (value,) for name, value in self._run_time(of or ref).items()})
        return Thing(label, order, known, cast(players) if players else (), ref)

    def _annotations_of(self, ref: ElementRef) -> Sequence[Annotation]:
        annotations = self._elements.annotations
        if self._annotated != len(annotations):
            # Of a model in the making there may be more than before.
            for annotation in annotations[self._annotated :]:
                self._annotations[annotation.element].append(annotation)
            self._annotated = len(annotations)
        return self._annotations.get(ref, ())

    def _entities(
        self, label: str, kind: ElementKind, section: str, wanted: Mapping[str, object], _: FactTables
    ) -> Iterable[Thing]:
        """The elements of a section of the model whose fields are as wanted."""
        fields = [(name, field) for name, field in _FIELDS.items() if name in owned(label)]
        for order, element in enumerate(getattr(self._elements, section)):
            if not wanted or all(getattr(element, name) is value for name, value in wanted.items()):
                attributes = {name: getattr(element, field) for name, field in fields}
                yield self._thing(order, label, ElementRef(kind, element.name), attributes)

    def _distinct_parameters(self) -> Iterable[ComponentParameter]:
        return dict.fromkeys(p for c in self._elements.component_configurations for p in c.parameters)

    def _requirements(self, tables: FactTables) -> Iterable[Thing]:
        for order, requirement in enumerate(self._elements.requirements):
            players = [_player(tables, "action", ElementKind.ACTION, requirement.action)]
            players += [_player(tables, "required-function", ElementKind.FUNCTION, n) for n in requirement.functions]
            yield Thing("functional-requirement", order, {}, cast(players))

    def _designs(self, tables: FactTables) -> Iterable[Thing]:
        for order, design in enumerate(self._elements.function_designs):
            players = [_player(tables, "function", ElementKind.FUNCTION, design.function)]
            players += [_player(tables, "required-component", ElementKind.COMPONENT, n) for n in design.components]
            ref = ElementRef(ElementKind.FUNCTION_DESIGN, design.name)
            yield self._thing(order, "function-design", ref, {"priority": design.priority}, players)

    def _configurations(self, tables: FactTables) -> Iterable[Thing]:
        # The table holds the same things that the parameters' table makes: one order, so the same index.
        parameters = dict(zip(self._distinct_parameters(), tables.of("ComponentParameter"), strict=True))
        for order, configuration in enumerate(self._elements.component_configurations):
            players = [_player(tables, "component", ElementKind.COMPONENT, configuration.component)]
            players += [("parameter", parameters[parameter]) for parameter in configuration.parameters]
            ref = ElementRef(ElementKind.COMPONENT_CONFIGURATION, configuration.name)
            yield self._thing(order, "component-configuration", ref, {"priority": configuration.priority}, players)

    def _constraints(self, tables: FactTables) -> Iterable[Thing]:
        for order, constraint in enumerate(self._elements.constraints):
            measure = _player(tables, "constraint", ElementKind.MEASURE, constraint.measure)
            players = [measure, ("constrained", tables.element(constraint.constrained))]
            attributes = {"attribute-value": constraint.value, "constraint-operator": constraint.operator.value}
            yield self._thing(order, "constraint", constraint_ref(constraint), attributes, players, constraint)

    def _estimations(self, tables: FactTables) -> Iterable[Thing]:
        for order, estimation in enumerate(self._elements.estimations):
            measure = _player(tables, "affected", ElementKind.MEASURE, estimation.measure)
            attributes = {"estimation-value": (estimation.value,), "estimation-type": (estimation.type.value,)}
            players = cast([("causer", tables.element(estimation.causer)), measure])
            yield Thing("estimation", order, attributes, players)


def _player(tables: FactTables, role: str, kind: ElementKind, name: str) -> tuple[str, Thing | None]:
    return role, tables.element(ElementRef(kind, name))


def _parameter(order: int, parameter: ComponentParameter) -> Thing:
    attributes: dict[str, tuple[Any, ...]] = {
        "parameter-key": (parameter.key,),
        "parameter-value": (parameter_text(parameter.value),),
        "parameter-type": (parameter.type.value,),
    }
    return Thing("ComponentParameter", order, attributes)


def constraint_ref(constraint: Constraint) -> ElementRef:
    """What a constraint is called: it has no name of its own."""
    return ElementRef(ElementKind.CONSTRAINT, f"{constraint} on {constraint.constrained}")
