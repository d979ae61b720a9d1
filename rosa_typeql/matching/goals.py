"""What a statement asks, in parts that can be tried one after the other (:mod:`rosa_typeql.matching.search`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product

from rosa_core.model.elements import Scalar
from rosa_typeql.matching.facts import Attribute, Thing
from rosa_typeql.matching.like import RegularExpression
from rosa_typeql.matching.search import NONE, Goal, Search, Solution, Term
from rosa_typeql.schema.table import ancestry, ordered
from rosa_typeql.schema.values import same

_SCAN = 20.0
_Players = Sequence[tuple[frozenset[str] | None, str]]


def thing_goal(thing: str, types: frozenset[str]) -> Goal:
    """``$thing isa Type``: one of these types.

    Args:
        thing: a variable, without its ``$``.
        types: the labels of the type and its subtypes.
    """
    labels = ordered(types)

    def extend(solution: Solution, search: Search) -> Iterator[Solution]:
        known = solution.get(thing)
        if known is not None:
            search.spend()
            if isinstance(known, Thing) and known.type in types:
                yield {}
            return
        for label in labels:
            for found in search.facts.of(label):
                search.spend()
                yield {thing: found}

    variables = frozenset({thing})
    return Goal(variables, variables, types, lambda bound: 0 if thing in bound else _SCAN, extend)


def attribute_goal(attribute: str, labels: tuple[str, ...], types: frozenset[str]) -> Goal:
    """``$attribute isa name``: one of these attributes, which things of these types have.

    Args:
        attribute: a variable, without its ``$``.
        labels: of the attributes.
        types: labels of the types whose things may own one.
    """

    def extend(solution: Solution, search: Search) -> Iterator[Solution]:
        known = solution.get(attribute)
        if known is not None:
            search.spend()
            if isinstance(known, Attribute) and known.label in labels:
                yield {}
            return
        seen = set()
        for label in ordered(types):
            for thing in search.facts.of(label):
                for found in _attributes(thing, labels):
                    search.spend()
                    if found not in seen:
                        seen.add(found)
                        yield {attribute: found}

    variables = frozenset({attribute})
    return Goal(variables, variables, types, lambda bound: 0 if attribute in bound else 2 * _SCAN, extend)


def type_goal(thing: str, kind: str, exactly: bool) -> Goal:
    """``$thing isa $kind``: the type, and, unless ``exactly``, each above it.

    Args:
        thing: a variable that other goals give a value.
        kind: the variable for the type's label.
        exactly: only the type itself, as ``isa!`` asks.
    """

    def extend(solution: Solution, search: Search) -> Iterator[Solution]:
        term = solution[thing]
        label = term if isinstance(term, str) else term.type if isinstance(term, Thing) else term.label
        known = solution.get(kind)
        for above in ancestry(label)[: 1 if exactly else None]:
            search.spend()
            if known is None or known == above:
                yield {kind: above}

    return Goal(
        frozenset({thing, kind}), frozenset({kind}), NONE, lambda bound: 0.2 if thing in bound else None, extend
    )


def has_goal(owner: str, labels: tuple[str, ...], types: frozenset[str], wanted: str | Attribute) -> Goal:
    """``$owner has label ...``: one of these attributes of things of these types.

    Args:
        owner: the variable of the thing.
        labels: the attributes that will do.
        types: what the thing can be.
        wanted: the variable of the attribute, or the value that it has (of whichever label).
    """
    variables = frozenset({owner, wanted} if isinstance(wanted, str) else {owner})
    few = labels[:1] != () and labels[0].endswith(("name", "key"))

    def cost(bound: frozenset[str]) -> float | None:
        looked_up = bound >= variables - {owner}
        if owner in bound:
            return 0.5 if looked_up else 1
        return (2 if few else 12) if looked_up else _SCAN + 5

    def extend(solution: Solution, search: Search) -> Iterator[Solution]:
        thing = solution.get(owner)
        if isinstance(wanted, str) and wanted not in solution:
            yield from _any_attribute(owner, thing, labels, types, wanted, search)
            return
        known = _known(solution[wanted], labels) if isinstance(wanted, str) else [(a, wanted.value) for a in labels]
        if thing is not None:
            search.spend()
            if isinstance(thing, Thing) and any(_has(thing, *attribute) for attribute in known):
                yield {}
            return
        for label, attribute in product(ordered(types), known):
            for found in search.facts.owners(label, *attribute):
                search.spend()
                if _has(found, *attribute):
                    yield {owner: found}

    return Goal(variables, variables, types, cost, extend)


def _any_attribute(
    owner: str, thing: Term | None, labels: tuple[str, ...], types: frozenset[str], wanted: str, search: Search
) -> Iterator[Solution]:
    things = [thing] if thing is not None else (found for label in ordered(types) for found in search.facts.of(label))
    for found in things:
        search.spend()
        for attribute in _attributes(found, labels) if isinstance(found, Thing) else ():
            search.spend()
            yield {owner: found, wanted: attribute}


def _known(term: Term, labels: tuple[str, ...]) -> list[tuple[str, Scalar]]:
    return [term] if isinstance(term, Attribute) and term.label in labels else []


def _has(thing: Thing, label: str, value: Scalar) -> bool:
    return any(same(value, known) for known in thing.attributes.get(label, ()))


def players_goal(relation: str, players: _Players, types: frozenset[str]) -> Goal:
    """``$relation (role: $player, ...)``: distinct players of one relation.

    Args:
        relation: the variable of the relation.
        players: their variables, each after the roles that it may play (spellings of which one relation has one); with
            None, any.
        types: what the relation can be.
    """
    names = [player for _, player in players]
    variables = frozenset({relation, *names})

    def cost(bound: frozenset[str]) -> float | None:
        if relation in bound:
            return 1.5
        return 4 if any(player in bound for player in names) else _SCAN + 10

    def extend(solution: Solution, search: Search) -> Iterator[Solution]:
        bound = next((solution[player] for player in names if player in solution), None)
        for found in [solution[relation]] if relation in solution else _relations(ordered(types), bound, search):
            search.spend()
            if isinstance(found, Thing) and found.type in types and relation not in names:
                for addition in _cast(players, found.players, {}, solution, search):
                    yield {relation: found, **addition}

    return Goal(variables, variables, types, cost, extend)


def _relations(labels: tuple[str, ...], player: Term | None, search: Search) -> Iterator[Thing]:
    """The relations in which a thing plays, if it is known."""
    for label in labels:
        if player is None:
            yield from search.facts.of(label)
        elif isinstance(player, Thing):
            yield from search.facts.relations(label, player)


def _cast(
    wanted: _Players,
    players: Sequence[tuple[str, Thing]],
    taken: dict[int, tuple[str, Thing]],
    solution: Solution,
    search: Search,
) -> Iterator[Solution]:
    """Give each player of the pattern one of the relation's, none twice; ``taken`` is by the relation's order."""
    if len(taken) == len(wanted):
        yield dict(taken.values())
        return
    roles, name = wanted[len(taken)]
    known = solution.get(name) or next((thing for other, thing in taken.values() if other == name), None)
    for position, (role, thing) in enumerate(players):
        search.spend()
        if position not in taken and (roles is None or role in roles) and (known is None or known is thing):
            yield from _cast(wanted, players, {**taken, position: (name, thing)}, solution, search)


def compare_goal(left: str, test: Callable[[Scalar, Scalar], bool], right: str | Attribute) -> Goal:
    """``$left operator right``; to the right is a variable or a value (of whichever label).

    Args:
        left: a variable that other goals give a value.
        test: the comparison of two values; it has to answer for values of different kinds too.
        right: another such variable, or the value.
    """

    def holds(solution: Solution, _: Search) -> bool:
        one = _value(solution[left])
        other = _value(solution[right] if isinstance(right, str) else right)
        return one is not None and other is not None and test(one, other)

    return _filter({left, right} if isinstance(right, str) else {left}, 0.1, holds)


def like_goal(left: str, expression: RegularExpression) -> Goal:
    """``$left like "..."``: the whole text matches.

    Args:
        left: a variable that other goals give a value; what is no text does not match.
        expression: the pattern; each match costs steps of the search in proportion to the text.
    """

    def holds(solution: Solution, search: Search) -> bool:
        text = _value(solution[left])
        if not isinstance(text, str):
            return False
        search.spend(expression.steps(text))
        return expression.matches(text)

    return _filter({left}, 0.3, holds)


def same_goal(left: str, right: str) -> Goal:
    """``$left is $right``: one thing, or the same attribute or type.

    Args:
        left: a variable that other goals give a value.
        right: another.
    """

    def holds(solution: Solution, _: Search) -> bool:
        one, other = solution[left], solution[right]
        return one is other or (not isinstance(one, Thing) and one == other)

    return _filter({left, right}, 0.1, holds)


def _filter(variables: set[str], cost: float, holds: Callable[[Solution, Search], bool]) -> Goal:
    """A goal that binds nothing: all of its variables have values, for which it holds or does not."""

    def extend(solution: Solution, search: Search) -> Iterator[Solution]:
        search.spend()
        if holds(solution, search):
            yield {}

    return Goal(frozenset(variables), NONE, NONE, lambda bound: cost if bound.issuperset(variables) else None, extend)


def _value(term: Term) -> Scalar | None:
    return term.value if isinstance(term, Attribute) else None


def _attributes(thing: Thing, labels: tuple[str, ...]) -> Iterator[Attribute]:
    for label in labels:
        for value in thing.attributes.get(label, ()):
            yield Attribute(label, value)
