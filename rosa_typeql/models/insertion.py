"""What the things that a TypeQL file inserts mean: the statements that they are for the model's builder."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from rosa_core.formats.builder import ModelBuilder
from rosa_core.model.elements import (
    Annotation,
    ComponentParameter,
    ComponentType,
    Constraint,
    ConstraintOperator,
    ElementKind,
    ElementRef,
    Estimation,
    EstimationType,
    MeasureKind,
    ParameterType,
    Scalar,
)
from rosa_typeql.matching.elements import constraint_ref
from rosa_typeql.matching.facts import COMPONENT_LABELS, MEASURE_LABELS, Thing
from rosa_typeql.matching.parameter_text import parameter_text, parameter_value, suggested_type
from rosa_typeql.matching.search import Solution
from rosa_typeql.models.attributes import Attributes, stated_attributes
from rosa_typeql.models.players import Cast, cast_players
from rosa_typeql.parsing.problems import Problems
from rosa_typeql.parsing.statements import Has, Isa, Player, Variable
from rosa_typeql.schema.table import REMARKS, a_or_an, ancestry, attribute_named, hint_type, key_of, type_named

KINDS = {
    "Measure": ElementKind.MEASURE,
    "Action": ElementKind.ACTION,
    "Function": ElementKind.FUNCTION,
    "Component": ElementKind.COMPONENT,
    "function-design": ElementKind.FUNCTION_DESIGN,
    "component-configuration": ElementKind.COMPONENT_CONFIGURATION,
}
"""The kind of element that things of a type, or below it, are."""

_FIELDS = {
    "always-improve": "always_improve",
    "priority": "priority",
    "package": "package",
    "executable": "executable",
}
_NEEDS = {
    "ComponentParameter": ("parameter-key", "parameter-value"),
    "estimation": ("estimation-value",),
    "measurement": ("measurement-value",),
}
_MADE_AT_RUN_TIME = frozenset(
    {"reconfiguration-plan", "component-activation", "component-deactivation", "parameter-adaptation"}
)


@dataclass(slots=True)
class Draft:
    """All that the statements of one insert say of one variable."""

    variable: Variable
    line: int
    isa: Isa | None = None
    has: list[Has] = field(default_factory=list)
    players: list[Player] = field(default_factory=list)


class Insertion:
    """Turns what one solution of a statement inserts into statements for the builder.

    Args:
        builder: takes elements and relations.
        problems: takes what is wrong.
        solution: what the variables of the match stand for.
    """

    def __init__(self, builder: ModelBuilder, problems: Problems, solution: Solution) -> None:
        self._builder = builder
        self._problems = problems
        self._at = problems.at
        self._solution = solution
        self._relating: Mapping[str, Callable[[Thing, Cast], None]] = {
            "functional-requirement": self._requirement,
            "function-design": self._design,
            "component-configuration": self._configuration,
            "constraint": self._constraint,
            "estimation": self._estimation,
            "measurement": self._measurement,
            "required-action": self._required_action,
            "measurement-interface": self._interface,
        }

    def create(self, draft: Draft, isa: Isa) -> Thing:
        """A new thing; if it has a name, it is declared.

        Args:
            draft: what the statement says of the thing.
            isa: its type.

        Returns:
            the thing with the attributes that are stated.

        Raises:
            InputError: if there cannot be such a thing.
        """
        label = self._type(isa)
        attributes = stated_attributes(label, draft.has, self._solution, self._problems)
        key = key_of(label)
        missing = [name for name in (key, *_NEEDS.get(label, ())) if name is not None and name not in attributes]
        if missing:
            what = f"{a_or_an(label)} has no {' and no '.join(missing)}"
            raise self._problems.error(draft.line, what, f"add: has {missing[0]} ...")
        kind = next((KINDS[above] for above in ancestry(label) if above in KINDS), None)
        ref = None
        if kind is not None and key is not None:
            name, line = attributes[key][0]
            ref = ElementRef(kind, str(name))
            self._declare(ref, label, line)
            self._state(ref, attributes)
        return Thing(
            label, 0, {name: tuple(value for value, _ in values) for name, values in attributes.items()}, (), ref
        )

    def extend(self, draft: Draft, matched: Thing) -> None:
        """Add attributes to something that is there.

        Args:
            draft: what the statement says of the thing.
            matched: the thing.

        Raises:
            InputError: if they cannot be added.
        """
        for label, values in stated_attributes(matched.type, draft.has, self._solution, self._problems).items():
            if matched.ref is None or label not in (*_FIELDS, *REMARKS) or matched.ref.kind is ElementKind.CONSTRAINT:
                what = f"'{label}' cannot be added to {a_or_an(matched.type)} that is there"
                self._problems.add(values[0][1], what, "state it where it is inserted")
            else:
                self._state(matched.ref, {label: values})

    def relate(self, draft: Draft, made: Thing, players: Sequence[tuple[Player, Thing]]) -> None:
        """State what a relation says.

        Args:
            draft: the statement, for its line.
            made: the relation.
            players: who plays in it, each with the role that is written.

        Raises:
            InputError: if not everybody is there who plays in it, or what is made is no relation.
        """
        relating = next((self._relating[label] for label in ancestry(made.type) if label in self._relating), None)
        if relating is not None:
            relating(made, cast_players(made.type, players, draft.line, self._problems))
        elif players:
            raise self._problems.error(draft.line, f"{a_or_an(made.type)} is not a relation, so it has no players")

    # -- things --

    def _type(self, isa: Isa) -> str:
        if isinstance(isa.type, Variable):
            raise self._problems.error(isa.line, "the type of what is inserted must be named")
        known = type_named(isa.type)
        if known is None:
            hint = f"it is an attribute: $x has {isa.type} ..." if attribute_named(isa.type) else hint_type(isa.type)
            raise self._problems.error(isa.line, f"unknown type '{isa.type}'", hint)
        if known.label in _MADE_AT_RUN_TIME:
            what = f"{a_or_an(known.label)} is made at run time, not stated in a model"
            raise self._problems.error(isa.line, what, "leave it out")
        if known.abstract:
            raise self._problems.error(isa.line, f"nothing can be just {a_or_an(known.label)}", hint_type(""))
        return known.label

    def _declare(self, ref: ElementRef, label: str, line: int) -> None:
        first = self._builder.declared_at(ref.kind, ref.name)
        if first is not None:
            hint = "choose another name, or match it to say more of it"
            raise self._problems.error(line, f"{ref} is there already, at {first}", hint)
        at = self._at(line)
        self._builder.declare(ref.kind, ref.name, at)
        for kind, spelled in MEASURE_LABELS.items():
            if spelled == label and kind is not MeasureKind.MEASURE:
                self._builder.state(ref.kind, ref.name, "kind", kind, at)
        for component_type, spelled in COMPONENT_LABELS.items():
            if spelled == label and component_type is not ComponentType.COMPONENT:
                self._builder.state(ref.kind, ref.name, "type", component_type, at)

    def _state(self, ref: ElementRef, attributes: Attributes) -> None:
        """The attributes of a named element: those that the model has a place for, and remarks."""
        for label, values in attributes.items():
            for value, line in values:
                if label in _FIELDS:
                    stated = float(value) if label == "priority" else value
                    self._builder.state(ref.kind, ref.name, _FIELDS[label], stated, self._at(line))
                elif not label.endswith("-name"):
                    self._builder.annotate(Annotation(ref, label, value))

    # -- relations --

    def _requirement(self, made: Thing, cast: Cast) -> None:
        action, line = cast["action"][0]
        path = (ElementKind.ACTION, _name(action), "requires")
        self._builder.locate(path, self._at(line))
        for function, at in cast["required-function"]:
            self._builder.locate((*path, _name(function)), self._at(at))
        self._builder.requirement(_name(action), [_name(function) for function, _ in cast["required-function"]])
        self._remark(_ref(action), made, REMARKS)

    def _design(self, made: Thing, cast: Cast) -> None:
        kind, name = ElementKind.FUNCTION_DESIGN, _name(made)
        function, line = cast["function"][0]
        self._builder.state(kind, name, "function", _name(function), self._at(line))
        components = tuple(_name(component) for component, _ in cast["required-component"])
        self._builder.state(kind, name, "components", components, self._at(line))
        for component, at in cast["required-component"]:
            self._builder.locate((kind, name, "components", _name(component)), self._at(at))

    def _configuration(self, made: Thing, cast: Cast) -> None:
        kind, name = ElementKind.COMPONENT_CONFIGURATION, _name(made)
        component, line = cast["component"][0]
        self._builder.state(kind, name, "component", _name(component), self._at(line))
        for parameter, at in cast.get("parameter", ()):
            with self._problems.gathering():
                self._builder.parameter(name, self._parameter(_name(component), parameter, at), self._at(at))

    def _parameter(self, component: str, parameter: Thing, line: int) -> ComponentParameter:
        key, raw = _one(parameter, "parameter-key"), _one(parameter, "parameter-value")
        text = raw if isinstance(raw, str) else parameter_text(raw)
        stated = parameter.attributes.get("parameter-type")
        wanted = ParameterType(str(stated[0])) if stated else suggested_type(text)
        value = parameter_value(text, wanted)
        if value is None:
            what = f"parameter '{key}' is not a {wanted.value.replace('_', ' ')}: {text!r}"
            raise self._problems.error(line, what, "give a value of that type, or another parameter-type")
        return ComponentParameter(component, str(key), value, wanted)

    def _constraint(self, made: Thing, cast: Cast) -> None:
        measure = _name(cast["constraint"][0][0])
        operator = ConstraintOperator(str(_one(made, "constraint-operator", ConstraintOperator.GREATER_OR_EQUAL.value)))
        value = made.attributes.get("attribute-value")
        for constrained, line in cast["constrained"]:
            ref = _ref(constrained)
            self._builder.locate((ref.kind, ref.name, "constraints", measure), self._at(line))
            constraint = Constraint(measure, ref, operator, float(value[0]) if value else None)
            self._builder.constraint(constraint)
            self._remark(constraint_ref(constraint), made, (*REMARKS, "constraint-status"))

    def _estimation(self, made: Thing, cast: Cast) -> None:
        measure = _name(cast["affected"][0][0])
        kind = EstimationType(str(_one(made, "estimation-type", EstimationType.POSITIVE.value)))
        for causer, line in cast["causer"]:
            ref = _ref(causer)
            self._builder.locate((ref.kind, ref.name, "estimations", measure), self._at(line))
            self._builder.estimation(Estimation(ref, measure, float(_one(made, "estimation-value")), kind))
            self._remark(ref, made, REMARKS)

    def _measurement(self, made: Thing, cast: Cast) -> None:
        if _one(made, "latest", True):
            self._remark(_ref(cast["measured-attribute"][0][0]), made, ("measurement-value", "measurement-time"))

    def _required_action(self, made: Thing, cast: Cast) -> None:
        if "result" not in made.attributes:
            self._builder.annotate(Annotation(_ref(cast["action"][0][0]), "is-required", True))

    def _interface(self, made: Thing, cast: Cast) -> None:
        measure = _ref(cast["measure"][0][0])
        for thing in (made, *(profile for profile, _ in cast.get("qos", ()))):
            self._remark(measure, thing, tuple(thing.attributes))

    def _remark(self, ref: ElementRef, made: Thing, labels: Sequence[str]) -> None:
        for label in labels:
            for value in made.attributes.get(label, ()):
                self._builder.annotate(Annotation(ref, label, value))


def _one(thing: Thing, label: str, default: Scalar = "") -> Scalar:
    return thing.attributes.get(label, (default,))[0]


def _ref(thing: Thing) -> ElementRef:
    if thing.ref is None:
        raise TypeError(f"{a_or_an(thing.type)} has no name")
    return thing.ref


def _name(thing: Thing) -> str:
    return _ref(thing).name
