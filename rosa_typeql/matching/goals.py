"""What a statement asks, in parts that can be tried one after the other (:mod:`rosa_typeql.matching.search`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from rosa_core.model.elements import Scalar
from rosa_typeql.matching.facts import Attribute, Thing
from rosa_typeql.matching.like import RegularExpression
from rosa_typeql.matching.search import Search, Solution, Term
from rosa_typeql.schema.table import ancestry
from rosa_typeql.schema.values import same

_NONE: frozenset[str] = frozenset()
_SCAN = 20.0


@dataclass(slots=True)
class IsaGoal:
    """``$thing isa Type``: one of these types."""

    thing: str
    types: frozenset[str]
    ordered: tuple[str, ...]

    @property
    def variables(self) -> frozenset[str]:
        return frozenset({self.thing})

    @property
    def binds(self) -> frozenset[str]:
        return self.variables

    def cost(self, bound: frozenset[str]) -> float | None:
        return 0 if self.thing in bound else _SCAN

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        known = solution.get(self.thing)
        if known is not None:
            search.spend()
            if isinstance(known, Thing) and known.type in self.types:
                yield {}
            return
        for label in self.ordered:
            for thing in search.facts.of(label):
                search.spend()
                yield {self.thing: thing}


@dataclass(slots=True)
class AttributeIsaGoal:
    """``$attribute isa name``: one of these attributes."""

    attribute: str
    labels: tuple[str, ...]
    types: frozenset[str]
    ordered: tuple[str, ...]

    @property
    def variables(self) -> frozenset[str]:
        return frozenset({self.attribute})

    @property
    def binds(self) -> frozenset[str]:
        return self.variables

    def cost(self, bound: frozenset[str]) -> float | None:
        return 0 if self.attribute in bound else 2 * _SCAN

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        known = solution.get(self.attribute)
        if known is not None:
            search.spend()
            if isinstance(known, Attribute) and known.label in self.labels:
                yield {}
            return
        seen = set()
        for label in self.ordered:
            for thing in search.facts.of(label):
                for attribute in _attributes(thing, self.labels):
                    search.spend()
                    if attribute not in seen:
                        seen.add(attribute)
                        yield {self.attribute: attribute}


@dataclass(slots=True)
class TypeGoal:
    """``$thing isa $type``: the type, and, unless ``exactly``, each above it."""

    thing: str
    type: str
    exactly: bool
    types: frozenset[str] = _NONE

    @property
    def variables(self) -> frozenset[str]:
        return frozenset({self.thing, self.type})

    @property
    def binds(self) -> frozenset[str]:
        return frozenset({self.type})

    def cost(self, bound: frozenset[str]) -> float | None:
        return 0.2 if self.thing in bound else None

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        thing = solution[self.thing]
        label = thing if isinstance(thing, str) else thing.type if isinstance(thing, Thing) else thing.label
        known = solution.get(self.type)
        for above in ancestry(label)[: 1 if self.exactly else None]:
            search.spend()
            if known is None:
                yield {self.type: above}
            elif known == above:
                yield {}


@dataclass(slots=True)
class HasGoal:
    """``$owner has label ...``: one of these attributes, as a variable or equal to a value."""

    owner: str
    labels: tuple[str, ...]
    types: frozenset[str]
    ordered: tuple[str, ...]
    attribute: str | None = None
    value: Scalar | None = None

    @property
    def variables(self) -> frozenset[str]:
        return frozenset({self.owner} if self.attribute is None else {self.owner, self.attribute})

    @property
    def binds(self) -> frozenset[str]:
        return self.variables

    def cost(self, bound: frozenset[str]) -> float | None:
        looked_up = self.attribute is None or self.attribute in bound
        if self.owner in bound:
            return 0.5 if looked_up else 1
        if not looked_up:
            return _SCAN + 5
        return 2 if self.labels[0].endswith(("name", "key")) else 12

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        owner = solution.get(self.owner)
        wanted = self._wanted(solution)
        if owner is not None:
            search.spend()
            if isinstance(owner, Thing):
                yield from self._of(owner, wanted, search)
        elif wanted is None:
            for label in self.ordered:
                for thing in search.facts.of(label):
                    search.spend()
                    for addition in self._of(thing, None, search):
                        yield {self.owner: thing, **addition}
        else:
            yield from self._owners(wanted, search)

    def _wanted(self, solution: Solution) -> Sequence[Attribute] | None:
        """The attributes that will do, None for any."""
        if self.attribute is None:
            if self.value is None:
                raise TypeError("a goal 'has' needs an attribute or a value")
            return [Attribute(label, self.value) for label in self.labels]
        known = solution.get(self.attribute)
        if known is None:
            return None
        return [known] if isinstance(known, Attribute) and known.label in self.labels else []

    def _of(self, thing: Thing, wanted: Sequence[Attribute] | None, search: Search) -> Iterator[Solution]:
        if wanted is None and self.attribute is not None:
            for attribute in _attributes(thing, self.labels):
                search.spend()
                yield {self.attribute: attribute}
        elif any(same(value, known) for label, value in wanted or () for known in thing.attributes.get(label, ())):
            yield {}

    def _owners(self, wanted: Sequence[Attribute], search: Search) -> Iterator[Solution]:
        for label in self.ordered:
            for attribute, value in wanted:
                for thing in search.facts.owners(label, attribute, value):
                    search.spend()
                    if any(same(value, known) for known in thing.attributes[attribute]):
                        yield {self.owner: thing}


@dataclass(slots=True)
class PlayersGoal:
    """``$relation (role: $player, ...)``: distinct players of one relation.

    A player may play one of several roles (spellings of which one relation has one), or, with None, any.
    """

    relation: str
    players: tuple[tuple[frozenset[str] | None, str], ...]
    types: frozenset[str]
    ordered: tuple[str, ...]

    @property
    def variables(self) -> frozenset[str]:
        return frozenset({self.relation, *(player for _, player in self.players)})

    @property
    def binds(self) -> frozenset[str]:
        return self.variables

    def cost(self, bound: frozenset[str]) -> float | None:
        if self.relation in bound:
            return 1.5
        return 4 if any(player in bound for _, player in self.players) else _SCAN + 10

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        for relation in self._candidates(solution, search):
            search.spend()
            for addition in self._assign(relation, {}, solution, search):
                yield {self.relation: relation, **addition}

    def _candidates(self, solution: Solution, search: Search) -> Iterator[Thing]:
        known = solution.get(self.relation)
        if known is not None:
            if isinstance(known, Thing) and known.type in self.types:
                yield known
            return
        players = [solution[player] for _, player in self.players if player in solution]
        for label in self.ordered:
            if not players:
                yield from search.facts.of(label)
            elif isinstance(players[0], Thing):
                yield from search.facts.relations(label, players[0])

    def _assign(
        self, relation: Thing, taken: dict[int, tuple[str, Thing]], solution: Solution, search: Search
    ) -> Iterator[Solution]:
        """Give each player of the pattern one of the relation's, none twice."""
        if len(taken) == len(self.players):
            yield dict(taken.values())
            return
        # Positions in order of the pattern; the keys of taken are the relation's.
        roles, player = self.players[len(taken)]
        if player == self.relation:
            return
        known = solution.get(player) or next((t for name, t in taken.values() if name == player), None)
        for position, (played, thing) in enumerate(relation.players):
            search.spend()
            if position in taken or (roles is not None and played not in roles):
                continue
            if known is None or known is thing:
                yield from self._assign(relation, {**taken, position: (player, thing)}, solution, search)


@dataclass(slots=True)
class CompareGoal:
    """``$left operator right``."""

    left: str
    test: Callable[[Scalar, Scalar], bool]
    right: str | None = None
    value: Scalar | None = None
    types: frozenset[str] = _NONE

    @property
    def variables(self) -> frozenset[str]:
        return frozenset({self.left} if self.right is None else {self.left, self.right})

    @property
    def binds(self) -> frozenset[str]:
        return _NONE

    def cost(self, bound: frozenset[str]) -> float | None:
        return 0.1 if self.variables <= bound else None

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        search.spend()
        left = _value(solution[self.left])
        right = self.value if self.right is None else _value(solution[self.right])
        if left is not None and right is not None and self.test(left, right):
            yield {}


@dataclass(slots=True)
class LikeGoal:
    """``$left like "..."``: the whole text matches."""

    left: str
    expression: RegularExpression
    types: frozenset[str] = _NONE

    @property
    def variables(self) -> frozenset[str]:
        return frozenset({self.left})

    @property
    def binds(self) -> frozenset[str]:
        return _NONE

    def cost(self, bound: frozenset[str]) -> float | None:
        return 0.3 if self.left in bound else None

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        left = solution[self.left]
        if isinstance(left, Attribute) and isinstance(left.value, str):
            search.spend(self.expression.steps(left.value))
            if self.expression.matches(left.value):
                yield {}


@dataclass(slots=True)
class SameGoal:
    """``$left is $right``."""

    left: str
    right: str
    types: frozenset[str] = _NONE

    @property
    def variables(self) -> frozenset[str]:
        return frozenset({self.left, self.right})

    @property
    def binds(self) -> frozenset[str]:
        return _NONE

    def cost(self, bound: frozenset[str]) -> float | None:
        return 0.1 if self.variables <= bound else None

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        search.spend()
        left, right = solution[self.left], solution[self.right]
        if left is right or (not isinstance(left, Thing) and left == right):
            yield {}


def _value(term: Term) -> Scalar | None:
    return term.value if isinstance(term, Attribute) else None


def _attributes(thing: Thing, labels: tuple[str, ...]) -> Iterator[Attribute]:
    for label in labels:
        for value in thing.attributes.get(label, ()):
            yield Attribute(label, value)
