"""Knowledge models written in TypeQL 2.x, as TypeDB-based ROSA systems have them.

A file is a sequence of ``insert`` and ``match ... insert`` statements; ``match`` finds what earlier statements and
files, in TypeQL or YAML, have stated. Which types, attributes and roles there are is said by
:mod:`rosa_typeql.schema.table`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from rosa_core.errors import InputError, Location, Problem, nearest
from rosa_core.formats.builder import ModelBuilder
from rosa_core.formats.text_source import read_text
from rosa_typeql.matching.elements import ElementLoaders
from rosa_typeql.matching.facts import FactTables, Thing
from rosa_typeql.matching.patterns import check_patterns
from rosa_typeql.matching.search import Solution, TooMuchWorkError
from rosa_typeql.models.insertion import KINDS, Insertion, NewThing, told_value
from rosa_typeql.parsing.parser import parse_model
from rosa_typeql.parsing.statements import (
    Comparison,
    Has,
    InsertStatement,
    Isa,
    Pattern,
    Player,
    Statement,
    Variable,
)
from rosa_typeql.schema.table import attribute_named, key_of, subtypes, type_named

_MOST_STEPS = 1_000_000
"""How much work the match of one statement may be."""


def read_typeql(path: str, builder: ModelBuilder) -> None:
    """Add the statements of one TypeQL file to the builder.

    Raises:
        InputError: if the file cannot be read or is not TypeQL, with file, line and hint. What is wrong with the
            statements themselves is added to the builder's problems.
    """
    reader = _Reader(path, builder)
    for statement in parse_model(read_text(path), path):
        reader.read(statement)


@dataclass(slots=True)
class _Draft:
    """All that the statements of one insert say of one variable."""

    variable: Variable
    line: int
    isa: Isa | None = None
    has: list[Has] = field(default_factory=list)
    players: list[Player] = field(default_factory=list)


class _Reader:
    """Reads the statements of one file, one after the other."""

    def __init__(self, path: str, builder: ModelBuilder) -> None:
        self._path = path
        self._builder = builder
        self._changed: set[str] = set()
        self._facts = FactTables(ElementLoaders(builder).loaders())

    def read(self, statement: InsertStatement) -> None:
        """Insert once for every solution of the match; without a match, once."""
        solutions = self._solutions(statement) if statement.match else [{}]
        problems, remarks = len(self._builder.problems), len(self._builder.annotations)
        drafts = self._drafts(statement.insert)
        for solution in solutions:
            if len(self._builder.problems) > problems:
                # The same is wrong for the other solutions too.
                break
            self._insert(drafts, solution)
        # Remarks may be on things of any type; otherwise only the types of what was inserted have changed.
        changed = {"thing"} if len(self._builder.annotations) > remarks else self._changed
        self._facts.reset(label for above in changed for label in subtypes(above))
        self._changed = set()

    def _problem(self, line: int, what: str, hint: str | None = None) -> None:
        self._builder.problems.append(Problem(what, Location(self._path, line), hint))

    # -- match --

    def _solutions(self, statement: InsertStatement) -> list[Solution]:
        try:
            match = check_patterns(statement.match, self._path)
            solutions = match.solutions(self._facts, _MOST_STEPS)
        except InputError as error:
            self._builder.problems.extend(error.problems)
            return []
        except TooMuchWorkError:
            self._problem(statement.line, "the match takes too much work", "say more of what is to be matched")
            return []
        if not solutions:
            self._nothing_matches(statement)
        return solutions

    def _nothing_matches(self, statement: InsertStatement) -> None:
        """Say which element is not there, or, failing that, that nothing fits the match as a whole."""
        missing = False
        for pattern in statement.match:
            for has in pattern.has if isinstance(pattern, Statement) else ():
                missing = self._misses(pattern, has) or missing
        if not missing:
            line = statement.match[0].line
            self._problem(line, "nothing that was inserted before matches all of this", "compare it with the inserts")

    def _misses(self, pattern: Pattern, has: Has) -> bool:
        if not isinstance(pattern, Statement) or not isinstance(has.value, Comparison) or has.value.operator != "=":
            return False
        label = _name_attribute(has.label, pattern.isa)
        kind = next((kind for type_label, kind in KINDS.items() if key_of(type_label) == label), None)
        name = has.value.operand
        if kind is None or not isinstance(name, str) or self._builder.declared_at(kind, name) is not None:
            return False
        hint = nearest(name, self._builder.declared(kind)) or "insert it in an earlier statement or file"
        self._problem(has.line, f"there is no {kind.value.replace('_', ' ')} '{name}' to match", hint)
        return True

    # -- insert --

    def _drafts(self, statements: Sequence[Statement]) -> list[_Draft]:
        drafts: dict[str, _Draft] = {}
        for statement in statements:
            draft = drafts.setdefault(statement.variable.name, _Draft(statement.variable, statement.line))
            draft.has.extend(statement.has)
            draft.players.extend(statement.players)
            for isa in statement.isa:
                if draft.isa is not None:
                    what = f"what {draft.variable} is stands twice; it is already in line {draft.isa.line}"
                    self._problem(isa.line, what, "use two variables for two things")
                draft.isa = draft.isa or isa
                draft.line = isa.line
            if statement.comparisons or statement.same_as:
                self._problem(statement.line, "an insert compares nothing", "compare in the match")
        return list(drafts.values())

    def _insert(self, drafts: Iterable[_Draft], solution: Solution) -> None:
        insertion = Insertion(self._path, self._builder)
        known = [d.variable.name for d in drafts if d.isa and not d.variable.anonymous]
        known += [name for name, term in solution.items() if isinstance(term, Thing)]
        new: list[NewThing] = []
        for draft in drafts:
            matched = solution.get(draft.variable.name)
            if matched is not None:
                self._extend(insertion, draft, matched, solution)
            elif thing := self._new(draft, known, solution):
                new.append(thing)
        created = insertion.create(new)
        self._changed.update(made.type for _, made in created)
        players = {name: term for name, term in solution.items() if isinstance(term, Thing)}
        players.update({thing.variable: made for thing, made in created})
        broken = {draft.variable.name for draft in drafts} - set(players)
        for thing, made in created:
            insertion.relate(thing, made, self._players(thing, players, broken, known))

    def _extend(self, insertion: Insertion, draft: _Draft, matched: object, solution: Solution) -> None:
        if not isinstance(matched, Thing):
            self._problem(draft.line, f"{draft.variable} is not a thing, so nothing can be inserted of it")
        elif draft.isa is not None:
            hint = "leave the isa out, or use another variable"
            self._problem(draft.isa.line, f"{draft.variable} is matched, so it has its type", hint)
        elif draft.players:
            what = f"{draft.variable} is matched; a relation that is there gets no more players"
            self._problem(draft.players[0].line, what, "state all players where it is inserted")
        else:
            thing = NewThing(draft.variable.name, matched.type, draft.line, self._told(draft, solution), ())
            insertion.extend(thing, matched)
            self._changed.add(matched.type)

    def _new(self, draft: _Draft, known: Sequence[str], solution: Solution) -> NewThing | None:
        if draft.isa is None:
            self._untyped(draft, known)
            return None
        if isinstance(draft.isa.type, Variable):
            self._problem(draft.isa.line, "the type of what is inserted must be named")
            return None
        found = type_named(draft.isa.type)
        label = draft.isa.type if found is None else found.label
        players = tuple(draft.players)
        return NewThing(draft.variable.name, label, draft.line, self._told(draft, solution), players)

    def _untyped(self, draft: _Draft, known: Sequence[str]) -> None:
        if draft.players:
            self._problem(draft.line, "a relation without a type", "add isa, such as: isa functional-requirement")
        else:
            hint = nearest(draft.variable.name, known)
            self._problem(draft.line, f"{draft.variable} has no type, here or in a match", hint or "add isa")

    def _told(self, draft: _Draft, solution: Solution) -> tuple[tuple[Has, object], ...]:
        """The attributes with their values; what has none is a problem."""
        told = []
        for has in draft.has:
            value = told_value(has, solution)
            if isinstance(value, Problem):
                self._problem(has.line, value.what, value.hint)
            else:
                told.append((has, value))
        return tuple(told)

    def _players(
        self, thing: NewThing, things: dict[str, Thing], broken: set[str], known: Sequence[str]
    ) -> list[tuple[Player, Thing]] | None:
        """The players as things; None where one is missing, which is said once."""
        found = []
        complete = True
        for player in thing.players:
            made = things.get(player.variable.name)
            if made is not None:
                found.append((player, made))
                continue
            complete = False
            if player.variable.name not in broken:
                hint = nearest(player.variable.name, known) or "insert it or match it"
                self._problem(player.line, f"{player.variable} is not known here", hint)
        return found if complete else None


def _name_attribute(spelling: str | None, isa: Sequence[Isa]) -> str | None:
    """The attribute that a spelling means; ``name`` is that of the type."""
    known = attribute_named(spelling or "")
    if known is None:
        return None
    if known.label == "name" and isa and isinstance(isa[0].type, str):
        found = type_named(isa[0].type)
        return None if found is None else key_of(found.label)
    return known.label
