"""What the things that a TypeQL file inserts mean: the statements that they are for the model's builder."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from rosa_core.errors import Location, Problem, nearest
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
from rosa_typeql.matching.facts import COMPONENT_LABELS, MEASURE_LABELS, Attribute, Thing
from rosa_typeql.matching.parameter_text import parameter_text, parameter_value, suggested_type
from rosa_typeql.matching.search import Solution
from rosa_typeql.parsing.statements import Has, Player, Variable
from rosa_typeql.schema.table import (
    ATTRIBUTES,
    REMARKS,
    TYPES,
    Role,
    a_or_an,
    ancestry,
    attribute_named,
    attributes_of_kind,
    hint_attribute,
    hint_role,
    hint_type,
    key_of,
    may_play,
    owned,
    role_named,
    roles,
)
from rosa_typeql.schema.values import fits, plain

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
_OPTIONAL_ROLES = frozenset({"parameter", "preference", "qos"})
_MADE_AT_RUN_TIME = frozenset(
    {"reconfiguration-plan", "component-activation", "component-deactivation", "parameter-adaptation"}
)


@dataclass(frozen=True, slots=True)
class NewThing:
    """What is inserted of one variable: its type, its attributes with their values, its players."""

    variable: str
    type: str
    line: int
    told: tuple[tuple[Has, object], ...]
    players: tuple[Player, ...]


_Told = dict[str, list[tuple[Scalar, int]]]
"""Attributes by label, each value with its line."""
_Cast = dict[str, list[tuple[Thing, int]]]
"""Players by role, each with its line."""


def told_value(has: Has, solution: Solution) -> Scalar | datetime | Problem:
    """The value that an insert gives an attribute, or what is wrong with it."""
    if isinstance(has.value, Variable):
        known = solution.get(has.value.name)
        if isinstance(known, Attribute):
            return known.value
        return Problem(f"{has.value} has no value here", hint="give a value, or match it as an attribute")
    if has.value.operator != "=" or isinstance(has.value.operand, Variable):
        return Problem("an insert compares nothing", hint="give one value")
    return has.value.operand


class Insertion:
    """Turns the things of one ``insert`` into statements for the builder; problems go to the builder too."""

    def __init__(self, path: str, builder: ModelBuilder) -> None:
        self._path = path
        self._builder = builder
        self._relating: Mapping[str, Callable[[Thing, _Cast], None]] = {
            "functional-requirement": self._requirement,
            "function-design": self._design,
            "component-configuration": self._configuration,
            "constraint": self._constraint,
            "estimation": self._estimation,
            "measurement": self._measurement,
            "required-action": self._required_action,
            "measurement-interface": self._interface,
        }

    def create(self, new: Sequence[NewThing]) -> list[tuple[NewThing, Thing]]:
        """Declare what has a name. What is wrong with a thing is a problem, and the thing is left out."""
        created = []
        for thing in new:
            made = self._create(thing)
            if made is not None:
                created.append((thing, made))
        return created

    def extend(self, thing: NewThing, matched: Thing) -> None:
        """Add attributes to something that is there."""
        told = self._attributes(thing)
        if told is None:
            return
        for label, values in told.items():
            line = values[0][1]
            if matched.ref is None or label not in (*_FIELDS, *REMARKS) or matched.ref.kind is ElementKind.CONSTRAINT:
                what = f"'{label}' cannot be added to {a_or_an(matched.type)} that is there"
                self._problem(line, what, "state it where it is inserted")
                continue
            self._state(matched.ref, {label: values})

    def relate(self, thing: NewThing, made: Thing, players: list[tuple[Player, Thing]] | None) -> None:
        """State what a relation says; ``players`` is None if some are not known."""
        if players is None:
            return
        relating = next((self._relating[label] for label in ancestry(made.type) if label in self._relating), None)
        if relating is None:
            if players:
                self._problem(thing.line, f"{a_or_an(made.type)} is not a relation, so it has no players")
            return
        cast = self._cast(made.type, players, thing.line)
        if cast is not None:
            relating(made, cast)

    # -- things --

    def _create(self, thing: NewThing) -> Thing | None:
        known = TYPES.get(thing.type)
        if known is None:
            hint = hint_type(thing.type)
            if attribute_named(thing.type):
                hint = f"it is an attribute: $x has {thing.type} ..."
            self._problem(thing.line, f"unknown type '{thing.type}'", hint)
            return None
        if thing.type in _MADE_AT_RUN_TIME:
            self._problem(
                thing.line, f"{a_or_an(thing.type)} is made at run time, not stated in a model", "leave it out"
            )
            return None
        if known.abstract:
            self._problem(thing.line, f"nothing can be just {a_or_an(thing.type)}", hint_type(""))
            return None
        told = self._attributes(thing)
        if told is None or not self._is_complete(thing, told):
            return None
        kind = next((KINDS[label] for label in ancestry(thing.type) if label in KINDS), None)
        attributes = {label: tuple(value for value, _ in values) for label, values in told.items()}
        ref = None
        if kind is not None:
            name, line = told[str(key_of(thing.type))][0]
            ref = ElementRef(kind, str(name))
            if not self._declare(ref, thing.type, Location(self._path, line)):
                return None
            self._state(ref, told)
        return Thing(thing.type, 0, attributes, (), ref)

    def _declare(self, ref: ElementRef, label: str, at: Location) -> bool:
        first = self._builder.declared_at(ref.kind, ref.name)
        if first is not None:
            hint = "choose another name, or match it to say more of it"
            self._builder.problems.append(Problem(f"{ref} is there already, at {first}", at, hint))
            return False
        self._builder.declare(ref.kind, ref.name, at)
        for kind, spelled in MEASURE_LABELS.items():
            if spelled == label and kind is not MeasureKind.MEASURE:
                self._builder.state(ref.kind, ref.name, "kind", kind, at)
        for component_type, spelled in COMPONENT_LABELS.items():
            if spelled == label and component_type is not ComponentType.COMPONENT:
                self._builder.state(ref.kind, ref.name, "type", component_type, at)
        return True

    def _state(self, ref: ElementRef, told: _Told) -> None:
        """The attributes of a named element: those that the model has a place for, and remarks."""
        for label, values in told.items():
            for value, line in values:
                if label in _FIELDS:
                    stated = float(value) if label == "priority" else value
                    self._builder.state(ref.kind, ref.name, _FIELDS[label], stated, Location(self._path, line))
                elif not label.endswith("-name"):
                    self._builder.annotate(Annotation(ref, label, value))

    # -- attributes --

    def _attributes(self, thing: NewThing) -> _Told | None:
        """The attributes by label, None if something is wrong with one, or one is missing."""
        told: _Told = {}
        problems = len(self._builder.problems)
        for has, value in thing.told:
            label = self._label(thing, has)
            if label is None:
                continue
            checked = self._checked(label, value, has)
            if checked is None:
                continue
            if label in told and label not in REMARKS and told[label][0][0] != checked:
                what = f"'{has.label}' is {checked!r} here and {told[label][0][0]!r} in line {told[label][0][1]}"
                self._problem(has.line, what, "keep one of the two")
                continue
            if label in REMARKS or label not in told:
                told.setdefault(label, []).append((checked, has.line))
        return told if len(self._builder.problems) == problems else None

    def _label(self, thing: NewThing, has: Has) -> str | None:
        """What a spelling means for a type: ``value`` of a constraint is its ``attribute-value``."""
        if has.label is None:
            self._problem(has.line, "an insert must name the attribute", "such as: has description 'why'")
            return None
        known = attribute_named(has.label)
        if known is None:
            self._problem(has.line, f"unknown attribute '{has.label}'", hint_attribute(has.label, thing.type))
            return None
        fitting = [label for label in attributes_of_kind(known.label) if label in owned(thing.type)]
        if len(fitting) == 1:
            return fitting[0]
        if fitting:
            hint = f"say which: {', '.join(label for label in fitting if label not in REMARKS)}"
            self._problem(has.line, f"{a_or_an(thing.type)} has more than one '{has.label}'", hint)
        else:
            hint = hint_attribute(has.label, thing.type)
            self._problem(has.line, f"{a_or_an(thing.type)} has no attribute '{has.label}'", hint)
        return None

    def _checked(self, label: str, value: object, has: Has) -> Scalar | None:
        attribute = ATTRIBUTES[label]
        if not isinstance(value, bool | int | float | str | datetime) or not fits(attribute.kind, value):
            hint = "write it without quotes" if isinstance(value, str) else "write it in quotes"
            self._problem(has.line, f"'{has.label}' is {attribute.kind}, not {value!r}", hint)
            return None
        if attribute.allowed and value not in attribute.allowed:
            hint = nearest(str(value), attribute.allowed) or f"one of: {', '.join(attribute.allowed)}"
            self._problem(has.line, f"'{has.label}' cannot be {value!r}", hint)
            return None
        return plain(value)

    def _is_complete(self, thing: NewThing, told: _Told) -> bool:
        key = key_of(thing.type)
        needed = (*((key,) if key else ()), *_NEEDS.get(thing.type, ()))
        missing = [label for label in needed if label not in told]
        for label in missing:
            self._problem(thing.line, f"{a_or_an(thing.type)} has no {label}", f"add: has {label} ...")
        return not missing

    # -- players --

    def _cast(self, label: str, players: Sequence[tuple[Player, Thing]], line: int) -> _Cast | None:
        cast: _Cast = {}
        problems = len(self._builder.problems)
        for player, thing in players:
            role = self._role(label, player, thing)
            if role is None:
                continue
            if role.label in cast and not role.many:
                self._problem(player.line, f"{a_or_an(label)} has one {role.label}", "state a relation for each")
            cast.setdefault(role.label, []).append((thing, player.line))
        if len(self._builder.problems) == problems:
            for name in roles(label):
                if name not in cast and name not in _OPTIONAL_ROLES:
                    self._problem(line, f"{a_or_an(label)} has no {name}", f"add ({name}: $...)")
        return cast if len(self._builder.problems) == problems else None

    def _role(self, label: str, player: Player, thing: Thing) -> Role | None:
        if player.role is None:
            able = [role for role in roles(label).values() if may_play(role, thing.type)]
            if len(able) == 1:
                return able[0]
            self._problem(player.line, f"which role {player.variable} plays is not said", hint_role("", label))
            return None
        role = role_named(label, player.role)
        if role is None:
            self._problem(player.line, f"{a_or_an(label)} has no role '{player.role}'", hint_role(player.role, label))
        elif not may_play(role, thing.type):
            what = f"{player.variable} is {a_or_an(thing.type)}, which cannot be the {player.role} of {a_or_an(label)}"
            self._problem(player.line, what, f"that is for: {', '.join(role.players)}")
        else:
            return role
        return None

    # -- relations --

    def _requirement(self, made: Thing, cast: _Cast) -> None:
        action, line = cast["action"][0]
        path = (ElementKind.ACTION, _name(action), "requires")
        self._builder.locate(path, Location(self._path, line))
        for function, at in cast["required-function"]:
            self._builder.locate((*path, _name(function)), Location(self._path, at))
        self._builder.requirement(_name(action), [_name(function) for function, _ in cast["required-function"]])
        self._remark(_ref(action), made, REMARKS)

    def _design(self, made: Thing, cast: _Cast) -> None:
        kind, name = ElementKind.FUNCTION_DESIGN, _name(made)
        function, line = cast["function"][0]
        self._builder.state(kind, name, "function", _name(function), Location(self._path, line))
        components = tuple(_name(component) for component, _ in cast["required-component"])
        self._builder.state(kind, name, "components", components, Location(self._path, line))
        for component, at in cast["required-component"]:
            self._builder.locate((kind, name, "components", _name(component)), Location(self._path, at))

    def _configuration(self, made: Thing, cast: _Cast) -> None:
        kind, name = ElementKind.COMPONENT_CONFIGURATION, _name(made)
        component, line = cast["component"][0]
        self._builder.state(kind, name, "component", _name(component), Location(self._path, line))
        for parameter, at in cast.get("parameter", ()):
            converted = self._parameter(_name(component), parameter, at)
            if converted is not None:
                self._builder.parameter(name, converted, Location(self._path, at))

    def _parameter(self, component: str, parameter: Thing, line: int) -> ComponentParameter | None:
        key, raw = _one(parameter, "parameter-key"), _one(parameter, "parameter-value")
        text = raw if isinstance(raw, str) else parameter_text(raw)
        told = parameter.attributes.get("parameter-type")
        wanted = ParameterType(str(told[0])) if told else suggested_type(text)
        value = parameter_value(text, wanted)
        if value is None:
            what = f"parameter '{key}' is not a {wanted.value.replace('_', ' ')}: {text!r}"
            self._problem(line, what, "give a value of that type, or another parameter-type")
            return None
        return ComponentParameter(component, str(key), value, wanted)

    def _constraint(self, made: Thing, cast: _Cast) -> None:
        measure = _name(cast["constraint"][0][0])
        operator = ConstraintOperator(str(_one(made, "constraint-operator", ConstraintOperator.GREATER_OR_EQUAL.value)))
        value = made.attributes.get("attribute-value")
        for constrained, line in cast["constrained"]:
            ref = _ref(constrained)
            self._builder.locate((ref.kind, ref.name, "constraints", measure), Location(self._path, line))
            constraint = Constraint(measure, ref, operator, float(value[0]) if value else None)
            self._builder.constraint(constraint)
            self._remark(constraint_ref(constraint), made, (*REMARKS, "constraint-status"))

    def _estimation(self, made: Thing, cast: _Cast) -> None:
        measure = _name(cast["affected"][0][0])
        kind = EstimationType(str(_one(made, "estimation-type", EstimationType.POSITIVE.value)))
        for causer, line in cast["causer"]:
            ref = _ref(causer)
            self._builder.locate((ref.kind, ref.name, "estimations", measure), Location(self._path, line))
            self._builder.estimation(Estimation(ref, measure, float(_one(made, "estimation-value")), kind))
            self._remark(ref, made, REMARKS)

    def _measurement(self, made: Thing, cast: _Cast) -> None:
        if _one(made, "latest", True):
            self._remark(_ref(cast["measured-attribute"][0][0]), made, ("measurement-value", "measurement-time"))

    def _required_action(self, made: Thing, cast: _Cast) -> None:
        if "result" not in made.attributes:
            self._builder.annotate(Annotation(_ref(cast["action"][0][0]), "is-required", True))

    def _interface(self, made: Thing, cast: _Cast) -> None:
        measure = _ref(cast["measure"][0][0])
        for told in (made, *(profile for profile, _ in cast.get("qos", ()))):
            self._remark(measure, told, tuple(told.attributes))

    def _remark(self, ref: ElementRef, made: Thing, labels: Sequence[str]) -> None:
        for label, value in _told_of(made, labels):
            self._builder.annotate(Annotation(ref, label, value))

    def _problem(self, line: int, what: str, hint: str | None = None) -> None:
        self._builder.problems.append(Problem(what, Location(self._path, line), hint))


def _told_of(thing: Thing, labels: Sequence[str]) -> Iterator[tuple[str, Scalar]]:
    for label in labels:
        for value in thing.attributes.get(label, ()):
            yield label, value


def _one(thing: Thing, label: str, default: Scalar = "") -> Scalar:
    return thing.attributes.get(label, (default,))[0]


def _ref(thing: Thing) -> ElementRef:
    if thing.ref is None:
        raise TypeError(f"{a_or_an(thing.type)} has no name")
    return thing.ref


def _name(thing: Thing) -> str:
    return _ref(thing).name
