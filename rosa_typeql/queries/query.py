"""Answers read queries in TypeQL 2.x (``~/query`` in the ROSA paper, table 5): ``match`` with ``fetch`` or ``get``.

A row is a plain dictionary keyed by variable name, without the ``$``:

- an attribute gives its value; times are seconds, as everywhere in the knowledge base;
- ``fetch $a: name, status;`` gives ``{"a": {"name": ..., "status": ...}}``: the value, None if there is none, a list if
  there are several (``time`` of a plan that has ended);
- a thing itself gives ``{"isa": type, attribute: value, ...}`` with all its attributes;
- a type gives its label;
- ``count`` and the other aggregates give one row, such as ``{"count": 3}``.

Rows are distinct. They come in the order of declaration of what was found, unless sorted.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from rosa_core.errors import InputError, Location, Problem, QueryError, nearest
from rosa_core.kb.history import History
from rosa_core.kb.state import RuntimeState
from rosa_core.model.elements import Scalar
from rosa_typeql.matching.facts import Attribute, FactTables, Thing
from rosa_typeql.matching.patterns import Match, VariableKind, check_patterns
from rosa_typeql.matching.search import Solution, Term, TooMuchWorkError
from rosa_typeql.parsing.parser import parse_query
from rosa_typeql.parsing.statements import Aggregate, Projection, Query, Variable
from rosa_typeql.queries.snapshot import snapshot
from rosa_typeql.schema.table import attribute_named, attributes_of_kind, hint_attribute
from rosa_typeql.schema.values import value_rank

MOST_STEPS = 1_000_000
"""How many steps a query may take: some seconds."""
LONGEST = 100_000
"""How many characters a query may have."""
_SOURCE = "query"

Row = dict[str, Any]


class PreparedQuery:
    """A query that was read and checked: the query language of ``KnowledgeBase.query``.

    Args:
        text: the query.
        steps: how much work it may be; matching one fact is one step.

    Raises:
        QueryError: if it cannot be read, writes, or speaks of what the schema does not have; with line and hint.

    >>> from rosa_core import KnowledgeBase, KnowledgeModel
    >>> from rosa_core.model.elements import Action
    >>> kb = KnowledgeBase(KnowledgeModel(actions=(Action("fly"), Action("land"))))
    >>> kb.query("match $a isa Action, has name $name; $name like 'f.*'; get $name;")
    [{'name': 'fly'}]
    """

    def __init__(self, text: str, steps: int = MOST_STEPS) -> None:
        if not isinstance(text, str) or len(text) > LONGEST:
            raise QueryError(Problem(f"a query is a text of at most {LONGEST} characters"))
        try:
            self._query: Query = parse_query(text, _SOURCE)
            self._match: Match = check_patterns(self._query.match, _SOURCE)
        except InputError as error:
            raise QueryError(error.problems) from None
        self._steps = steps
        self._projections = self._query.projections or tuple(
            Projection(Variable(name), name, (), 1) for name in self._match.variables
        )
        _check(self._query, self._projections, self._match)

    def snapshot(self, state: RuntimeState, history: History) -> FactTables:
        """The facts that :meth:`rows` needs, as they are now; call it while writes are locked out.

        Args:
            state: the model, the statuses of its elements, and the run-time facts.
            history: what is over, as far as memory is kept for it.
        """
        return snapshot(state, history, self._match.types)

    def rows(self, facts: FactTables) -> list[Row]:
        """The answer, from what :meth:`snapshot` returned.

        Raises:
            QueryError: if it takes more work than allowed, or aggregates what are not numbers.
        """
        try:
            solutions = self._match.solutions(facts, self._steps)
        except TooMuchWorkError:
            hint = "say more of what is wanted, connect its parts, or sort and limit less"
            raise QueryError(Problem(f"the query was given up after {self._steps} steps", hint=hint)) from None
        for key in reversed(self._query.sort):
            solutions.sort(key=_sorting_by(key.variable.name), reverse=key.descending)
        distinct: dict[tuple[Term, ...], Solution] = {}
        for solution in solutions:
            distinct.setdefault(_terms(solution, self._projections), solution)
        end = None if self._query.limit is None else self._query.offset + self._query.limit
        kept = list(distinct.values())[self._query.offset : end]
        if self._query.aggregate is not None:
            return [_aggregate(self._query.aggregate, kept)]
        return [{p.name: _shown(solution[p.variable.name], p) for p in self._projections} for solution in kept]


def _sorting_by(name: str) -> Callable[[Solution], tuple[int, Scalar]]:
    def value(solution: Solution) -> tuple[int, Scalar]:
        term = solution[name]
        return value_rank(term.value if isinstance(term, Attribute) else "")

    return value


def _terms(solution: Solution, projections: Sequence[Projection]) -> tuple[Term, ...]:
    return tuple(solution[projection.variable.name] for projection in projections)


def _shown(term: Term, projection: Projection) -> Any:
    if isinstance(term, Attribute):
        return term.value
    if not isinstance(term, Thing):
        return term
    if not projection.attributes:
        return {"isa": term.type, **{label: _plain(values) for label, values in term.attributes.items()}}
    return {name: _plain(_values(term, spelling)) for spelling, name in projection.attributes}


def _values(thing: Thing, spelling: str) -> Sequence[Scalar]:
    known = attribute_named(spelling)
    labels = attributes_of_kind(known.label) if known else ()
    return [value for label in labels for value in thing.attributes.get(label, ())]


def _plain(values: Sequence[Scalar]) -> Scalar | list[Scalar] | None:
    if len(values) > 1:
        return list(values)
    return values[0] if values else None


# -- checks --


def _check(query: Query, projections: Sequence[Projection], match: Match) -> None:
    problems: list[Problem] = []
    for projection in projections:
        problems += _of_variable(projection.variable.name, projection.line, match)
        problems += _of_attributes(projection, match)
    names = [projection.name for projection in projections]
    for projection in projections:
        if names.count(projection.name) > 1 and names.index(projection.name) == projections.index(projection):
            where = Location(_SOURCE, projection.line)
            problems.append(Problem(f"'{projection.name}' stands twice in a row", where, "use: as another_name"))
    for key in query.sort:
        problems += _of_variable(key.variable.name, key.line, match, to="sort by")
    if query.aggregate is not None and query.aggregate.variable is not None:
        problems += _of_variable(query.aggregate.variable.name, query.aggregate.line, match, to="aggregate")
    if problems:
        raise QueryError(problems)


def _of_variable(name: str, line: int, match: Match, to: str | None = None) -> Iterable[Problem]:
    """What keeps a variable out of a row, or, with ``to``, an attribute from being used so."""
    where = Location(_SOURCE, line)
    if name not in match.variables:
        hint = nearest(name, match.variables) or "bind it in the match, outside of not {} and in every branch of or"
        yield Problem(f"${name} has no value in every row", where, hint)
    elif to and match.kinds.get(name) is not VariableKind.ATTRIBUTE:
        yield Problem(f"${name} is not an attribute to {to}", where, "bind one: has name $n")


def _of_attributes(projection: Projection, match: Match) -> Iterable[Problem]:
    where = Location(_SOURCE, projection.line)
    if projection.attributes and match.kinds.get(projection.variable.name) is not VariableKind.THING:
        yield Problem(f"{projection.variable} has no attributes", where, "fetch it without ': ...'")
        return
    for spelling, _ in projection.attributes:
        known = attribute_named(spelling)
        if known is None:
            yield Problem(f"unknown attribute '{spelling}'", where, hint_attribute(spelling))


# -- aggregates --


def _deviation(numbers: Sequence[float]) -> float:
    return statistics.stdev(numbers) if len(numbers) > 1 else 0.0


_FUNCTIONS: Mapping[str, Callable[[Sequence[float]], float]] = {
    "sum": sum,
    "min": min,
    "max": max,
    "mean": statistics.fmean,
    "median": statistics.median,
    "std": _deviation,
}


def _aggregate(aggregate: Aggregate, solutions: Sequence[Solution]) -> Row:
    """One row; the aggregate of nothing is None, its count and sum are 0."""
    if aggregate.variable is None:
        return {aggregate.function: len(solutions)}
    numbers: list[float] = []
    for solution in solutions:
        term = solution[aggregate.variable.name]
        value = term.value if isinstance(term, Attribute) else None
        if isinstance(value, bool) or not isinstance(value, int | float):
            what = f"{aggregate.function} is of numbers, and {aggregate.variable} is {value!r}"
            raise QueryError(Problem(what, Location(_SOURCE, aggregate.line), "aggregate a number, such as a priority"))
        numbers.append(value)
    if not numbers and aggregate.function != "sum":
        return {aggregate.function: None}
    return {aggregate.function: _FUNCTIONS[aggregate.function](numbers)}
