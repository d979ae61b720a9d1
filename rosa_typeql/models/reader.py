"""Knowledge models written in TypeQL 2.x, as TypeDB-based ROSA systems have them.

A file is a sequence of ``insert`` and ``match ... insert`` statements; ``match`` finds what earlier statements and
files, in TypeQL or YAML, have stated. Which types, attributes and roles there are is said by
:mod:`rosa_typeql.schema.table`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rosa_core.errors import InputError, nearest
from rosa_core.formats.builder import ModelBuilder
from rosa_core.formats.text_source import read_text
from rosa_typeql.matching.elements import ElementLoaders
from rosa_typeql.matching.facts import FactTables, Thing
from rosa_typeql.matching.patterns import check_patterns
from rosa_typeql.matching.search import Solution, TooMuchWorkError
from rosa_typeql.models.insertion import KINDS, Draft, Insertion
from rosa_typeql.parsing.parser import parse_model
from rosa_typeql.parsing.problems import Problems
from rosa_typeql.parsing.statements import (
    Comparison,
    Has,
    InsertStatement,
    Isa,
    Pattern,
    Statement,
)
from rosa_typeql.schema.table import attribute_named, key_of, subtypes, type_named

_MOST_STEPS = 1_000_000
"""How much work the match of one statement may be."""


def read_typeql(path: str, builder: ModelBuilder) -> None:
    """Add the statements of one TypeQL file to the builder: the reader of ``.tql`` files.

    Args:
        path: the file.
        builder: holds what earlier files have stated, which this one may match.

    Raises:
        InputError: if the file cannot be read or is not TypeQL, with file, line and hint. What is wrong with the
            statements themselves is added to the builder's problems.
    """
    reader = _Reader(path, builder)
    for statement in parse_model(read_text(path), path):
        reader.read(statement)


class _Reader:
    """Reads the statements of one file, one after the other."""

    def __init__(self, path: str, builder: ModelBuilder) -> None:
        self._path = path
        self._builder = builder
        self._problems = Problems(path, builder.problems)
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

    # -- match --

    def _solutions(self, statement: InsertStatement) -> list[Solution]:
        try:
            match = check_patterns(statement.match, self._path)
            solutions = match.solutions(self._facts, _MOST_STEPS)
        except InputError as error:
            self._builder.problems.extend(error.problems)
            return []
        except TooMuchWorkError:
            self._problems.add(statement.line, "the match takes too much work", "say more of what is to be matched")
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
            self._problems.add(
                line, "nothing that was inserted before matches all of this", "compare it with the inserts"
            )

    def _misses(self, pattern: Pattern, has: Has) -> bool:
        if not isinstance(pattern, Statement) or not isinstance(has.value, Comparison) or has.value.operator != "=":
            return False
        label = _name_attribute(has.label, pattern.isa)
        kind = next((kind for type_label, kind in KINDS.items() if key_of(type_label) == label), None)
        name = has.value.operand
        if kind is None or not isinstance(name, str) or self._builder.declared_at(kind, name) is not None:
            return False
        hint = nearest(name, self._builder.declared(kind)) or "insert it in an earlier statement or file"
        self._problems.add(has.line, f"there is no {kind.value.replace('_', ' ')} '{name}' to match", hint)
        return True

    # -- insert --

    def _drafts(self, statements: Sequence[Statement]) -> list[Draft]:
        drafts: dict[str, Draft] = {}
        for statement in statements:
            draft = drafts.setdefault(statement.variable.name, Draft(statement.variable, statement.line))
            draft.has.extend(statement.has)
            draft.players.extend(statement.players)
            for isa in statement.isa:
                if draft.isa is not None:
                    what = f"what {draft.variable} is stands twice; it is already in line {draft.isa.line}"
                    self._problems.add(isa.line, what, "use two variables for two things")
                draft.isa = draft.isa or isa
                draft.line = isa.line
            if statement.comparisons or statement.same_as:
                self._problems.add(statement.line, "an insert compares nothing", "compare in the match")
        return list(drafts.values())

    def _insert(self, drafts: Iterable[Draft], solution: Solution) -> None:
        insertion = Insertion(self._builder, self._problems, solution)
        things = {name: term for name, term in solution.items() if isinstance(term, Thing)}
        known = [d.variable.name for d in drafts if d.isa and not d.variable.anonymous] + list(things)
        created: list[tuple[Draft, Thing]] = []
        for draft in drafts:
            with self._problems.gathering():
                matched = solution.get(draft.variable.name)
                if matched is not None:
                    self._extend(insertion, draft, matched)
                elif draft.isa is None:
                    raise self._untyped(draft, known)
                else:
                    created.append((draft, insertion.create(draft, draft.isa)))
        self._changed.update(made.type for _, made in created)
        things.update({draft.variable.name: made for draft, made in created})
        broken = {draft.variable.name for draft in drafts} - set(things)
        for draft, made in created:
            players = [
                (player, things[player.variable.name]) for player in draft.players if player.variable.name in things
            ]
            if len(players) == len(draft.players):
                with self._problems.gathering():
                    insertion.relate(draft, made, players)
            for player in draft.players:
                if player.variable.name not in {*things, *broken}:
                    hint = nearest(player.variable.name, known) or "insert it or match it"
                    self._problems.add(player.line, f"{player.variable} is not known here", hint)

    def _extend(self, insertion: Insertion, draft: Draft, matched: object) -> None:
        if not isinstance(matched, Thing):
            what = f"{draft.variable} is not a thing, so nothing can be inserted of it"
            raise self._problems.error(draft.line, what)
        if draft.isa is not None:
            hint = "leave the isa out, or use another variable"
            raise self._problems.error(draft.isa.line, f"{draft.variable} is matched, so it has its type", hint)
        if draft.players:
            what = f"{draft.variable} is matched; a relation that is there gets no more players"
            raise self._problems.error(draft.players[0].line, what, "state all players where it is inserted")
        insertion.extend(draft, matched)
        self._changed.add(matched.type)

    def _untyped(self, draft: Draft, known: Sequence[str]) -> InputError:
        if draft.players:
            hint = "add isa, such as: isa functional-requirement"
            return self._problems.error(draft.line, "a relation without a type", hint)
        near = nearest(draft.variable.name, known)
        return self._problems.error(draft.line, f"{draft.variable} has no type, here or in a match", near or "add isa")


def _name_attribute(spelling: str | None, isa: Sequence[Isa]) -> str | None:
    """The attribute that a spelling means; ``name`` is that of the type."""
    known = attribute_named(spelling or "")
    if known is None:
        return None
    if known.label == "name" and isa and isinstance(isa[0].type, str):
        found = type_named(isa[0].type)
        return None if found is None else key_of(found.label)
    return known.label
