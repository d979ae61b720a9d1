"""What a domain and a problem declare: types, constants and objects, predicates and functions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from rosa_core.errors import Location, Problem, nearest
from task_layer.pddl.reading.source import Form, Symbol

ANY_TYPE = "object"


@dataclass(frozen=True, slots=True)
class Signature:
    """A predicate or function: the types of its arguments, each a choice of types."""

    types: tuple[tuple[str, ...], ...]


@dataclass(slots=True)
class Declarations:
    """Everything declared, by lower-case name, and the problems found with it."""

    parents: dict[str, str] = field(default_factory=lambda: {ANY_TYPE: ANY_TYPE})
    objects: dict[str, tuple[str, ...]] = field(default_factory=dict)
    predicates: dict[str, Signature] = field(default_factory=dict)
    functions: dict[str, Signature] = field(default_factory=dict)
    problems: list[Problem] = field(default_factory=list)

    def is_a(self, types: Sequence[str], wanted: Sequence[str]) -> bool:
        """Whether something of one of these types is of one of the types wanted."""
        return any(ancestor in wanted for name in types for ancestor in self.ancestors(name))

    def ancestors(self, name: str) -> Iterator[str]:
        """A type and those above it."""
        seen: set[str] = set()
        while name not in seen:
            yield name
            seen.add(name)
            name = self.parents.get(name, ANY_TYPE)


def declare_types(section: Form, file: str, known: Declarations) -> None:
    """Read ``(:types ...)``."""
    for symbol, parents in typed_list(section.items[1:], file, known):
        if symbol.key == ANY_TYPE:
            continue
        if symbol.key in known.ancestors(parents[0]):
            what = f"the type '{symbol.text}' is a kind of itself"
            known.problems.append(Problem(what, Location(file, symbol.line), "remove one '- TYPE' of the circle"))
            continue
        known.parents[symbol.key] = parents[0]
    for name in list(known.parents.values()):
        known.parents.setdefault(name, ANY_TYPE)


def declare_objects(section: Form, file: str, known: Declarations) -> None:
    """Read ``(:constants ...)`` or ``(:objects ...)``."""
    for symbol, types in typed_list(section.items[1:], file, known):
        check_types(symbol, types, file, known)
        if symbol.key in known.objects:
            known.problems.append(declared_twice(symbol.text, symbol.line, file))
        known.objects[symbol.key] = types


def declare_signatures(section: Form, file: str, into: dict[str, Signature], known: Declarations) -> None:
    """Read ``(:predicates ...)`` or ``(:functions ...)``."""
    for form in section.forms:
        if not form.head:
            known.problems.append(Problem("a declaration has no name", Location(file, form.line)))
            continue
        if form.head in known.predicates or form.head in known.functions:
            known.problems.append(declared_twice(form.head, form.line, file))
        parameters = list(typed_list(form.items[1:], file, known))
        for symbol, types in parameters:
            check_types(symbol, types, file, known)
        into[form.head] = Signature(tuple(types for _, types in parameters))


def declared_twice(name: str, line: int, file: str) -> Problem:
    """The problem that a name stands for two things."""
    return Problem(f"'{name}' is declared twice", Location(file, line), "remove or rename one of the two")


def typed_list(
    items: Sequence[Symbol | Form], file: str, known: Declarations
) -> Iterator[tuple[Symbol, tuple[str, ...]]]:
    """The names of ``a b - type c - (either t u) d`` with their types; without a type, ``object``."""
    names: list[Symbol] = []
    rest = iter(items)
    for item in rest:
        if isinstance(item, Form):
            known.problems.append(
                Problem("a name is expected here, not a form", Location(file, item.line), "write it as: a b - type")
            )
        elif item.text == "-":
            following = next(rest, None)
            types = _types_of(following)
            if not types:
                known.problems.append(Problem("'-' without a type", Location(file, item.line), "name the type"))
            elif isinstance(following, Form):
                hint = "declare a type above both, and use that"
                known.problems.append(Problem("'either' is not supported", Location(file, following.line), hint))
            yield from ((name, types or (ANY_TYPE,)) for name in names)
            names = []
        else:
            names.append(item)
    yield from ((name, (ANY_TYPE,)) for name in names)


def _types_of(item: Symbol | Form | None) -> tuple[str, ...]:
    if isinstance(item, Symbol):
        return (item.key,)
    if item is None or item.head != "either":
        return ()
    return tuple(inner.key for inner in item.items[1:] if isinstance(inner, Symbol))


def check_types(symbol: Symbol, types: Sequence[str], file: str, known: Declarations) -> None:
    """Add a problem for each type that is not declared."""
    for name in types:
        if name not in known.parents:
            what = f"'{symbol.text}' is of type '{name}', which is not declared"
            hint = nearest(name, known.parents) or "declare it in (:types ...)"
            known.problems.append(Problem(what, Location(file, symbol.line), hint))
