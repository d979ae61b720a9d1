"""The types, attributes and roles of ROSA's knowledge model, as TypeQL files and queries spell them.

One declarative table (ROSA paper, section 5, tables 2 to 4; spellings of the published TypeQL schemas), used both for
reading models and for answering queries. A short spelling such as ``value`` is an abstract attribute: it stands for the
attribute of that kind which a type has (``attribute-value`` of a constraint, ``estimation-value`` of an estimation).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cache

from rosa_core.errors import nearest


class ValueKind(StrEnum):
    """What the values of an attribute are."""

    TEXT = "text"
    NUMBER = "number"
    BOOLEAN = "true or false"
    TIME = "time"
    ANY = "any value"


@dataclass(frozen=True, slots=True)
class AttributeType:
    """An attribute: the abstract one that it is an instance of, and the words it is limited to, if it is."""

    label: str
    kind: ValueKind
    parent: str = "attribute"
    allowed: tuple[str, ...] = ()
    abstract: bool = False


@dataclass(frozen=True, slots=True)
class Role:
    """A role of a relation: what may play it, and whether several may."""

    label: str
    players: tuple[str, ...]
    many: bool = False


@dataclass(frozen=True, slots=True)
class ThingType:
    """An entity or relation type. ``owns`` and ``roles`` are its own; those of its supertypes come on top."""

    label: str
    parent: str
    key: str | None = None
    owns: tuple[str, ...] = ()
    roles: tuple[Role, ...] = ()
    abstract: bool = False


_OPERATORS = ("<", "<=", ">", ">=")
_PARAMETER_TYPES = tuple(f"{t}{array}" for t in ("boolean", "double", "long", "string") for array in ("", "_array"))
_ABSTRACT = {
    "name": ValueKind.TEXT,
    "status": ValueKind.TEXT,
    "time": ValueKind.TIME,
    "value": ValueKind.ANY,
    "key": ValueKind.TEXT,
    "type": ValueKind.TEXT,
    "operator": ValueKind.TEXT,
}
REMARKS = ("description", "comment", "note", "label", "unit", "author", "source", "version")
"""Attributes that anything may have and that mean nothing to the rules."""
_QOS_TEXTS = ("reliability", "history", "durability", "liveliness")
_QOS_NUMBERS = ("depth", "deadline", "lifespan", "lease-duration")
_INTERFACE_TEXTS = ("interface-type", "function-name", "function-lib", "function-args")

ATTRIBUTES: dict[str, AttributeType] = {
    a.label: a
    for a in (
        AttributeType("attribute", ValueKind.ANY, "", abstract=True),
        *(AttributeType(label, kind, abstract=True) for label, kind in _ABSTRACT.items()),
        AttributeType("action-name", ValueKind.TEXT, "name"),
        AttributeType("function-name", ValueKind.TEXT, "name"),
        AttributeType("component-name", ValueKind.TEXT, "name"),
        AttributeType("function-design-name", ValueKind.TEXT, "name"),
        AttributeType("component-configuration-name", ValueKind.TEXT, "name"),
        AttributeType("measure-name", ValueKind.TEXT, "name"),
        AttributeType("measurement-interface-name", ValueKind.TEXT, "name"),
        AttributeType("action-status", ValueKind.TEXT, "status"),
        AttributeType("function-status", ValueKind.TEXT, "status"),
        AttributeType("component-status", ValueKind.TEXT, "status"),
        AttributeType("function-design-status", ValueKind.TEXT, "status"),
        AttributeType("component-configuration-status", ValueKind.TEXT, "status"),
        AttributeType("constraint-status", ValueKind.TEXT, "status"),
        AttributeType("start-time", ValueKind.TIME, "time"),
        AttributeType("end-time", ValueKind.TIME, "time"),
        AttributeType("measurement-time", ValueKind.TIME, "time"),
        AttributeType("attribute-value", ValueKind.NUMBER, "value"),
        AttributeType("estimation-value", ValueKind.NUMBER, "value"),
        AttributeType("measurement-value", ValueKind.NUMBER, "value"),
        AttributeType("parameter-value", ValueKind.ANY, "value"),
        AttributeType("parameter-key", ValueKind.TEXT, "key"),
        AttributeType("parameter-type", ValueKind.TEXT, "type", _PARAMETER_TYPES),
        AttributeType("estimation-type", ValueKind.TEXT, "type", ("positive", "negative", "absolute")),
        AttributeType("constraint-operator", ValueKind.TEXT, "operator", _OPERATORS),
        AttributeType("result", ValueKind.TEXT, allowed=("completed", "failed", "abandoned")),
        AttributeType("priority", ValueKind.NUMBER),
        AttributeType("is-required", ValueKind.BOOLEAN),
        AttributeType("is-selected", ValueKind.BOOLEAN),
        AttributeType("is-active", ValueKind.BOOLEAN),
        AttributeType("always-improve", ValueKind.BOOLEAN),
        AttributeType("latest", ValueKind.BOOLEAN),
        AttributeType("package", ValueKind.TEXT),
        AttributeType("executable", ValueKind.TEXT),
        *(AttributeType(f"measurement-{label}", ValueKind.TEXT) for label in _INTERFACE_TEXTS),
        *(AttributeType(label, ValueKind.TEXT) for label in _QOS_TEXTS),
        *(AttributeType(label, ValueKind.NUMBER) for label in (*_QOS_NUMBERS, "rate")),
        *(AttributeType(label, ValueKind.ANY) for label in REMARKS),
    )
}

_ADAPTABLE = ("Component", "function-design", "component-configuration")
_INTERFACE = ("measurement-interface-name", *(f"measurement-{label}" for label in _INTERFACE_TEXTS), "rate")

TYPES: dict[str, ThingType] = {
    t.label: t
    for t in (
        ThingType("thing", "", owns=REMARKS, abstract=True),
        ThingType("entity", "thing", abstract=True),
        ThingType("relation", "thing", abstract=True),
        ThingType("Measure", "entity", "measure-name", ("measure-name",)),
        ThingType("EnvironmentalAttribute", "Measure"),
        ThingType("QualityAttribute", "Measure"),
        ThingType("Action", "entity", "action-name", ("action-name", "action-status", "is-required")),
        ThingType(
            "Function", "entity", "function-name", ("function-name", "function-status", "is-required", "always-improve")
        ),
        ThingType(
            "Component",
            "entity",
            "component-name",
            ("component-name", "component-status", "is-required", "is-active", "always-improve"),
        ),
        ThingType("ROSNode", "Component", owns=("package", "executable")),
        ThingType("LifeCycleNode", "ROSNode"),
        ThingType("ComponentParameter", "entity", owns=("parameter-key", "parameter-value", "parameter-type")),
        ThingType("QoSProfile", "entity", owns=(*_QOS_TEXTS, *_QOS_NUMBERS)),
        ThingType(
            "functional-requirement",
            "relation",
            roles=(Role("action", ("Action",)), Role("required-function", ("Function",), many=True)),
        ),
        ThingType(
            "function-design",
            "relation",
            "function-design-name",
            ("function-design-name", "function-design-status", "priority", "is-selected"),
            (Role("function", ("Function",)), Role("required-component", ("Component",), many=True)),
        ),
        ThingType(
            "component-configuration",
            "relation",
            "component-configuration-name",
            ("component-configuration-name", "component-configuration-status", "priority", "is-selected"),
            (Role("component", ("Component",)), Role("parameter", ("ComponentParameter",), many=True)),
        ),
        ThingType(
            "constraint",
            "relation",
            owns=("attribute-value", "constraint-operator", "constraint-status"),
            roles=(Role("constraint", ("Measure",)), Role("constrained", ("Action", *_ADAPTABLE), many=True)),
        ),
        ThingType(
            "estimation",
            "relation",
            owns=("estimation-value", "estimation-type"),
            roles=(Role("causer", _ADAPTABLE, many=True), Role("affected", ("Measure",))),
        ),
        ThingType(
            "measurement",
            "relation",
            owns=("measurement-value", "measurement-time", "latest"),
            roles=(Role("measured-attribute", ("Measure",)),),
        ),
        ThingType(
            "required-action",
            "relation",
            owns=("start-time", "end-time", "result"),
            roles=(Role("action", ("Action",)), Role("preference", ("Measure",))),
        ),
        ThingType("component-adaptation", "relation", roles=(Role("component", ("Component",), True),), abstract=True),
        ThingType("component-activation", "component-adaptation"),
        ThingType("component-deactivation", "component-adaptation"),
        ThingType(
            "parameter-adaptation",
            "relation",
            roles=(Role("component-configuration", ("component-configuration",), many=True),),
        ),
        ThingType(
            "reconfiguration-plan",
            "relation",
            owns=("start-time", "end-time", "result"),
            roles=(
                Role("structural-adaptation", ("component-adaptation",), many=True),
                Role("parameter-adaptation", ("parameter-adaptation",), many=True),
            ),
        ),
        ThingType("measurement-interface", "relation", owns=_INTERFACE, roles=(Role("measure", ("Measure",)),)),
        ThingType("topic-interface", "measurement-interface", roles=(Role("qos", ("QoSProfile",)),)),
    )
}

OTHER_SPELLINGS = {
    "Attribute": "Measure",
    "attribute-name": "measure-name",
    "constrainment": "constraint",
    "constrainment-operator": "constraint-operator",
    "constrainment-status": "constraint-status",
}
"""What older files call it, and what it is called here."""

_OTHER_ROLES = {
    ("constraint", "measure"): "constraint",
    ("estimation", "measure"): "affected",
    ("measurement", "measure"): "measured-attribute",
}


def type_named(label: str) -> ThingType | None:
    """The entity or relation type of that spelling, None if there is none."""
    return TYPES.get(OTHER_SPELLINGS.get(label, label))


def attribute_named(label: str) -> AttributeType | None:
    """The attribute of that spelling, None if there is none."""
    return ATTRIBUTES.get(OTHER_SPELLINGS.get(label, label))


@cache
def ancestry(label: str) -> tuple[str, ...]:
    """A type or attribute and all above it, nearest first.

    Example:
        >>> ancestry("action-name")
        ('action-name', 'name', 'attribute')
    """
    found = [label]
    while parent := (TYPES.get(found[-1]) or ATTRIBUTES[found[-1]]).parent:
        found.append(parent)
    return tuple(found)


@cache
def subtypes(label: str) -> tuple[str, ...]:
    """The types that are of this type, itself included, and without those that nothing can be exactly."""
    return tuple(t.label for t in TYPES.values() if label in ancestry(t.label) and not t.abstract)


@cache
def attributes_of_kind(label: str) -> tuple[str, ...]:
    """The attributes that an abstract attribute stands for; of any other, itself."""
    return tuple(a.label for a in ATTRIBUTES.values() if label in ancestry(a.label) and not a.abstract)


@cache
def ordered(labels: frozenset[str]) -> tuple[str, ...]:
    """Types in the order of the schema."""
    return tuple(label for label in TYPES if label in labels)


@cache
def owned(type_label: str) -> tuple[str, ...]:
    """The attributes that a type has, with those of its supertypes."""
    return tuple(attribute for label in ancestry(type_label) for attribute in TYPES[label].owns)


@cache
def roles(type_label: str) -> dict[str, Role]:
    """The roles that a relation type has, with those of its supertypes."""
    return {role.label: role for label in ancestry(type_label) for role in TYPES[label].roles}


@cache
def resting_on(type_label: str) -> frozenset[str]:
    """The relation types in which things of a type can play a role, directly or as part of another relation."""
    found: set[str] = set()
    left = [type_label]
    while left:
        label = left.pop()
        new = {r for r in TYPES if r not in found and any(may_play(role, label) for role in roles(r).values())}
        found |= new
        left.extend(new)
    return frozenset(found)


@cache
def key_of(type_label: str) -> str | None:
    """The attribute that names things of this type, if they have names."""
    return next((key for label in ancestry(type_label) if (key := TYPES[label].key)), None)


def role_named(type_label: str, spelling: str) -> Role | None:
    """The role of that spelling in a relation type, None if it has none such.

    Args:
        type_label: of the relation; roles that it inherits count.
        spelling: the role's label, or another spelling that is accepted for this relation.
    """
    return roles(type_label).get(_OTHER_ROLES.get((type_label, spelling), spelling))


def may_play(role: Role, type_label: str) -> bool:
    """Whether a thing of a type may play a role.

    Args:
        role: of a relation.
        type_label: of the player; what a type above it may play, it may.
    """
    return any(label in role.players for label in ancestry(type_label))


def a_or_an(label: str) -> str:
    """The label with its article.

    Example:
        >>> a_or_an("Action"), a_or_an("constraint")
        ('an Action', 'a constraint')
    """
    return f"an {label}" if label[0] in "aeiouAEIOU" else f"a {label}"


def hint_type(spelling: str) -> str:
    """The hint for a type that is not known.

    Example:
        >>> hint_type("Acton")
        "did you mean 'Action'?"
    """
    known = [*TYPES, *(other for other, label in OTHER_SPELLINGS.items() if label in TYPES)]
    return nearest(spelling, known) or f"there are: {', '.join(t.label for t in TYPES.values() if not t.abstract)}"


def hint_attribute(spelling: str, type_label: str | None = None) -> str:
    """The hint for an attribute that is not known, or that a type does not have.

    Args:
        spelling: as it is written.
        type_label: the type that does not have it; None if no type has.
    """
    if type_label is None:
        return nearest(spelling, [*ATTRIBUTES, *OTHER_SPELLINGS]) or "see the list of spellings in docs/typeql.md"
    known = owned(type_label)
    for below in subtypes(type_label):
        if attribute_named(spelling) is not None and OTHER_SPELLINGS.get(spelling, spelling) in owned(below):
            return f"{a_or_an(below)} has it"
    shown = [label for label in known if label not in REMARKS]
    return nearest(spelling, known) or f"it has: {', '.join([*shown, REMARKS[0]])}"


def hint_role(spelling: str, type_label: str) -> str:
    """The hint for a role that a relation does not have.

    Args:
        spelling: as it is written.
        type_label: of the relation.

    Example:
        >>> hint_role("acton", "functional-requirement")
        "did you mean 'action'?"
    """
    known = roles(type_label)
    return nearest(spelling, known) or (f"it has: {', '.join(known)}" if known else "it has no roles")
