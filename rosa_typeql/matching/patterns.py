"""Patterns checked against the schema and made ready to be matched against facts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from rosa_core.errors import InputError, Location, Problem, nearest
from rosa_typeql.matching.facts import Attribute, FactTables, Thing
from rosa_typeql.matching.goals import (
    attribute_goal,
    compare_goal,
    has_goal,
    like_goal,
    players_goal,
    same_goal,
    thing_goal,
    type_goal,
)
from rosa_typeql.matching.like import RegularExpression, RegularExpressionError
from rosa_typeql.matching.search import (
    Goal,
    Search,
    Solution,
    Term,
    UnboundVariableError,
    in_order,
    not_goal,
    or_goal,
    solve,
    types_of,
)
from rosa_typeql.parsing.problems import Problems
from rosa_typeql.parsing.statements import (
    Comparison,
    Disjunction,
    Has,
    Isa,
    Negation,
    Pattern,
    Statement,
    Variable,
)
from rosa_typeql.schema.table import (
    ATTRIBUTES,
    ValueKind,
    a_or_an,
    attribute_named,
    attributes_of_kind,
    hint_attribute,
    hint_role,
    hint_type,
    ordered,
    owned,
    role_named,
    roles,
    subtypes,
    type_named,
)
from rosa_typeql.schema.values import TESTS, fits, plain, value_rank

MOST_STATEMENTS = 1000
"""How many statements a match may have."""


class VariableKind(StrEnum):
    """What a variable stands for."""

    THING = "a thing"
    ATTRIBUTE = "an attribute"
    TYPE = "a type"


@dataclass(frozen=True, slots=True)
class Match:
    """Patterns that were checked. ``variables``: those with a name and a value in every solution, as they appear."""

    goals: tuple[Goal, ...]
    variables: tuple[str, ...]
    kinds: dict[str, VariableKind]

    @property
    def types(self) -> frozenset[str]:
        """The types of the things that it looks at."""
        return types_of(self.goals)

    def solutions(self, facts: FactTables, steps: int) -> list[Solution]:
        """What the variables can stand for, each solution once, in the order of declaration of what is found.

        Args:
            facts: what is known.
            steps: how much work it may be; looking at one fact is one step.

        Raises:
            TooMuchWorkError: if it takes more steps than given.
        """
        search = Search(facts, steps)
        found: dict[tuple[Term, ...], None] = {}
        for solution in solve(self.goals, {}, search):
            found[tuple(solution[name] for name in self.variables)] = None
        ordered = sorted(found, key=lambda terms: [rank(term) for term in terms])
        return [dict(zip(self.variables, terms, strict=True)) for terms in ordered]


def rank(term: Term) -> tuple[object, ...]:
    """For sorting terms in an order that is the same in every run."""
    if isinstance(term, Thing):
        return (0, *term.rank)
    if isinstance(term, Attribute):
        return (1, *value_rank(term.value), term.label)
    return (2, term)


def check_patterns(patterns: Sequence[Pattern], source: str) -> Match:
    """Make patterns ready for matching.

    Args:
        patterns: what a match asks for.
        source: the file, or what messages call the text.

    Raises:
        InputError: with everything that cannot be, its line in the source, and the hint.
    """
    if (count := sum(1 for _ in _statements(patterns))) > MOST_STATEMENTS:
        raise InputError(Problem(f"a match of {count} statements is too large", Location(source), "split it"))
    checker = _Checker(source)
    block = checker.block(patterns, _Scope(frozenset(), {}))
    if checker.problems.found:
        raise InputError(checker.problems.found)
    try:
        goals = tuple(in_order(block.goals, frozenset()))
    except UnboundVariableError as error:
        what = f"nothing gives ${error} a value"
        raise InputError(Problem(what, Location(source), f"add a statement such as: $x has name ${error}")) from None
    named = dict.fromkeys(v.name for v in _variables(patterns) if not v.anonymous and v.name in block.bound)
    return Match(goals, tuple(named), checker.kinds)


def _statements(patterns: Iterable[Pattern]) -> Iterator[Statement]:
    for pattern in patterns:
        match pattern:
            case Statement():
                yield pattern
            case Negation():
                yield from _statements(pattern.patterns)
            case Disjunction():
                for branch in pattern.branches:
                    yield from _statements(branch)


def _variables(patterns: Iterable[Pattern]) -> Iterator[Variable]:
    for statement in _statements(patterns):
        yield statement.variable
        yield from (player.variable for player in statement.players)
        yield from (isa.type for isa in statement.isa if isinstance(isa.type, Variable))
        yield from (has.value for has in statement.has if isinstance(has.value, Variable))


_Types = dict[str, frozenset[str]]
"""The types that a variable's thing can be of."""


@dataclass(frozen=True, slots=True)
class _Scope:
    """What is known from outside of a block."""

    bound: frozenset[str]
    types: _Types


@dataclass(frozen=True, slots=True)
class _CheckedBlock:
    goals: list[Goal]
    bound: frozenset[str]


_ALL_TYPES = frozenset(subtypes("thing"))
_RELATIONS = frozenset(subtypes("relation"))


class _Checker:
    """Patterns to goals; what is wrong with them is collected."""

    def __init__(self, source: str) -> None:
        self.problems = Problems(source, [])
        self.kinds: dict[str, VariableKind] = {}
        self._fresh = 0
        self._nesting = 0

    def block(self, patterns: Sequence[Pattern], outside: _Scope) -> _CheckedBlock:
        """The goals of one block, and the variables that are bound when all of them are satisfied."""
        types = dict(outside.types)
        statements = [pattern for pattern in patterns if isinstance(pattern, Statement)]
        for statement in statements:
            self._narrow_by_isa(statement, types)
        for statement in statements:
            self._narrow_by_players(statement, types)
        goals = [goal for statement in statements for goal in self._statement(statement, types)]
        bound = outside.bound.union(*(goal.binds for goal in goals))
        alternatives = [self._either(p, _Scope(bound, types)) for p in patterns if isinstance(p, Disjunction)]
        bound = bound.union(*(goal.binds for goal in alternatives))
        negations = [self._none_of(p, _Scope(bound, types)) for p in patterns if isinstance(p, Negation)]
        return _CheckedBlock([*goals, *alternatives, *negations], bound)

    def _either(self, pattern: Disjunction, scope: _Scope) -> Goal:
        branches = [self._inner(branch, scope) for branch in pattern.branches]
        binds = frozenset.intersection(*(branch.bound for branch in branches)) - scope.bound
        return or_goal([branch.goals for branch in branches], binds, scope.bound)

    def _none_of(self, pattern: Negation, scope: _Scope) -> Goal:
        return not_goal(self._inner(pattern.patterns, scope).goals, scope.bound)

    def _inner(self, patterns: Sequence[Pattern], scope: _Scope) -> _CheckedBlock:
        self._nesting += 1
        block = self.block(patterns, scope)
        self._nesting -= 1
        return block

    # -- which types a variable can be of --

    def _narrow_by_isa(self, statement: Statement, types: _Types) -> None:
        for isa in statement.isa:
            if isinstance(isa.type, Variable):
                continue
            if found := type_named(isa.type):
                possible = frozenset({found.label} if isa.exactly else subtypes(found.label))
                self._narrow(statement.variable.name, possible, types, isa.line)
            elif attribute_named(isa.type) is None:
                self.problems.add(isa.line, f"unknown type '{isa.type}'", hint_type(isa.type))

    def _narrow_by_players(self, statement: Statement, types: _Types) -> None:
        if not statement.players:
            return
        name = statement.variable.name
        possible = types.get(name, _ALL_TYPES) & _RELATIONS
        if not possible and statement.isa:
            what = f"{a_or_an(str(statement.isa[0].type))} is not a relation, so it has no players"
            self._impossible(statement.line, what)
            return
        for player in statement.players:
            if player.role is None:
                continue
            having = frozenset(label for label in possible if role_named(label, player.role))
            if not having:
                report = self._impossible if _is_role(player.role) else self.problems.add
                report(player.line, *_unknown_role(player.role, possible))
            possible = having
        self._narrow(name, possible, types, statement.line)
        for player in statement.players:
            wanted = [
                role
                for label in possible
                for role in ([role_named(label, player.role)] if player.role else roles(label).values())
                if role is not None
            ]
            able = frozenset(label for role in wanted for above in role.players for label in subtypes(above))
            self._narrow(player.variable.name, able, types, player.line, player.role)

    def _narrow(self, name: str, possible: frozenset[str], types: _Types, line: int, role: str | None = None) -> None:
        before = types.get(name, _ALL_TYPES)
        types[name] = before & possible
        if not types[name] and before:
            shown = f"play the role '{role}'" if role else f"be {_either_of(possible)}"
            self._impossible(line, f"${name} cannot {shown}: it is {_either_of(before)}", "use two variables")

    # -- statements --

    def _statement(self, statement: Statement, types: _Types) -> Iterator[Goal]:
        name = statement.variable.name
        parts = (statement.isa, statement.has, statement.players, statement.comparisons, statement.same_as)
        if not any(parts):
            hint = f"say what it is, such as: ${name} isa Action"
            self.problems.add(statement.line, f"nothing is said of ${name}", hint)
        for isa in statement.isa:
            yield from self._isa(name, isa, types)
        if statement.players:
            yield from self._players(statement, types)
        for has in statement.has:
            yield from self._has(name, has, types)
        for comparison in statement.comparisons:
            self._is_kind(name, VariableKind.ATTRIBUTE, comparison.line)
            yield from self._compare(name, comparison)
        for other in statement.same_as:
            yield same_goal(name, other.name)

    def _isa(self, name: str, isa: Isa, types: _Types) -> Iterator[Goal]:
        if isinstance(isa.type, Variable):
            self._is_kind(isa.type.name, VariableKind.TYPE, isa.line)
            yield type_goal(name, isa.type.name, isa.exactly)
            if self.kinds.get(name) is not VariableKind.ATTRIBUTE:
                yield thing_goal(name, types.get(name, _ALL_TYPES))
        elif found := type_named(isa.type):
            self._is_kind(name, VariableKind.THING, isa.line)
            yield thing_goal(name, frozenset({found.label} if isa.exactly else subtypes(found.label)))
        elif attribute := attribute_named(isa.type):
            self._is_kind(name, VariableKind.ATTRIBUTE, isa.line)
            labels = attributes_of_kind(attribute.label)
            having = frozenset(label for label in _ALL_TYPES if set(labels) & set(owned(label)))
            yield attribute_goal(name, labels, having)

    def _players(self, statement: Statement, types: _Types) -> Iterator[Goal]:
        name = statement.variable.name
        self._is_kind(name, VariableKind.THING, statement.line)
        possible = types.get(name, _ALL_TYPES) & _RELATIONS
        players: list[tuple[frozenset[str] | None, str]] = []
        for player in statement.players:
            self._is_kind(player.variable.name, VariableKind.THING, player.line)
            spelled = None
            if player.role is not None:
                found = (role_named(label, player.role) for label in possible)
                spelled = frozenset(role.label for role in found if role is not None)
            players.append((spelled, player.variable.name))
        yield players_goal(name, players, possible)

    def _has(self, name: str, has: Has, types: _Types) -> Iterator[Goal]:
        self._is_kind(name, VariableKind.THING, has.line)
        spelling = has.label or "attribute"
        known = attribute_named(spelling)
        if known is None:
            self.problems.add(has.line, f"unknown attribute '{spelling}'", hint_attribute(spelling))
            return
        possible = types.get(name, _ALL_TYPES)
        labels = attributes_of_kind(known.label)
        having = frozenset(label for label in possible if set(labels) & set(owned(label)))
        if not having and possible:
            hint = hint_attribute(spelling, ordered(possible)[0])
            self._impossible(has.line, f"{_either_of(possible)} has no attribute '{spelling}'", hint)
        if isinstance(has.value, Variable):
            self._is_kind(has.value.name, VariableKind.ATTRIBUTE, has.line)
            yield has_goal(name, labels, having, has.value.name)
        elif has.value.operator == "=" and not isinstance(has.value.operand, Variable):
            value = has.value.operand
            fitting = tuple(label for label in labels if fits(ATTRIBUTES[label].kind, value))
            if fitting:
                yield has_goal(name, fitting, having, Attribute(fitting[0], plain(value)))
            else:
                kind = ATTRIBUTES[labels[0]].kind
                what = f"'{spelling}' is {kind}, and {value!r} is not"
                self.problems.add(has.line, what, f"compare it with {_article(kind)}")
        else:
            self._fresh += 1
            attribute = f"{name} {spelling} {self._fresh}"
            yield has_goal(name, labels, having, attribute)
            yield from self._compare(attribute, has.value)

    def _compare(self, name: str, comparison: Comparison) -> Iterator[Goal]:
        operand = comparison.operand
        if comparison.operator == "like":
            yield from self._like(name, str(operand), comparison.line)
            return
        test = TESTS[comparison.operator]
        if isinstance(operand, Variable):
            self._is_kind(operand.name, VariableKind.ATTRIBUTE, comparison.line)
            yield compare_goal(name, test, operand.name)
        else:
            yield compare_goal(name, test, Attribute("", plain(operand)))

    def _like(self, name: str, pattern: str, line: int) -> Iterator[Goal]:
        try:
            yield like_goal(name, RegularExpression(pattern))
        except RegularExpressionError as error:
            shown = pattern if len(pattern) <= 40 else f"{pattern[:40]}..."
            self.problems.add(line, f"the regular expression {shown!r} cannot be used: {error.what}", error.hint)

    def _is_kind(self, name: str, kind: VariableKind, line: int) -> None:
        known = self.kinds.setdefault(name, kind)
        if known is not kind:
            self.problems.add(line, f"${name} is {kind} here and {known} elsewhere", "use two variables")

    def _impossible(self, line: int, what: str, hint: str | None = None) -> None:
        """What can never be is a slip, except in ``not`` and ``or``: there it just does not happen."""
        if self._nesting == 0:
            self.problems.add(line, what, hint)


def _is_role(spelling: str) -> bool:
    return any(role_named(label, spelling) for label in _RELATIONS)


def _unknown_role(role: str, possible: frozenset[str]) -> tuple[str, str | None]:
    labels = ordered(possible)
    if len(labels) == 1:
        return f"{a_or_an(labels[0])} has no role '{role}'", hint_role(role, labels[0])
    known = dict.fromkeys(name for label in labels for name in roles(label))
    return f"no relation has the role '{role}'", nearest(role, known)


def _either_of(labels: frozenset[str]) -> str:
    shown = ordered(labels)
    if len(shown) <= 2:
        return " or ".join(a_or_an(label) for label in shown)
    return f"{a_or_an(shown[0])} or the like"


def _article(kind: ValueKind) -> str:
    return f"a {kind}" if kind in (ValueKind.NUMBER, ValueKind.TIME) else str(kind)
