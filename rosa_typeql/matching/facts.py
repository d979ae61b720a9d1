"""Knowledge as facts: things of a type, with attributes and, for relations, role players.

This is the form that patterns are matched against (:mod:`rosa_typeql.matching.patterns`). Tables are made type by type,
when they are first asked for, so that asking about actions does not cost anything per component.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from rosa_core.model.elements import ComponentType, ElementKind, ElementRef, MeasureKind, Scalar
from rosa_typeql.schema.table import TYPES, resting_on

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


Loader = Callable[["FactTables"], Iterable[Thing]]
"""Makes a table; it may look into the others."""


class FactTables:
    """Tables of things by exact type, with indexes that are made when first used."""

    def __init__(self, loaders: Mapping[str, Loader]) -> None:
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
        """The things of exactly this type that have this value of the attribute.

        Args:
            label: of the things' type; things of its subtypes are not among them.
            attribute: its label.
            value: equal as Python compares, so 1, 1.0 and true are the same.

        Returns:
            in the order of the table; the list belongs to the index, which is made at the first question.
        """
        index = self._owners.get((label, attribute))
        if index is None:
            index = self._owners[label, attribute] = defaultdict(list)
            for thing in self.of(label):
                for known in thing.attributes.get(attribute, ()):
                    index[known].append(thing)
        return index.get(value, [])

    def relations(self, label: str, player: Thing) -> list[Thing]:
        """The relations of exactly this type in which the thing plays a role.

        Args:
            label: of the relations' type; relations of its subtypes are not among them.
            player: in any of the roles.

        Returns:
            in the order of the table, each once; the list belongs to the index, which is made at the first question.
        """
        index = self._related.get(label)
        if index is None:
            index = self._related[label] = defaultdict(list)
            for relation in self.of(label):
                for known in dict.fromkeys(thing for _, thing in relation.players):
                    index[known].append(relation)
        return index.get(player, [])


def cast(players: Iterable[tuple[str, Thing | None]]) -> tuple[tuple[str, Thing], ...]:
    """The players of a relation, without those that are not there."""
    return tuple((role, player) for role, player in players if player is not None)
