"""Ontologies: what the words of tags mean, and whether one concept is part of another."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from rosa_streams.tags.concepts import Concept, Named, One, Predicate, Some
from rosa_streams.tags.saturation import Node, Saturation


class Similarity(Protocol):
    """The relation between tags of an environment (definition 5)."""

    def matches(self, output: Concept, wanted: Concept) -> bool:
        """Whether a stream with the tag ``output`` may feed what asks for ``wanted``."""
        ...


@dataclass(frozen=True, slots=True)
class Individual:
    """What is known of an individual: the concepts it is in, and its roles to other individuals."""

    types: tuple[Concept, ...] = ()
    links: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class Role:
    """What is known of a role: the roles it is a special case of, and whether it is transitive."""

    supers: tuple[str, ...] = ()
    transitive: bool = False


@dataclass(frozen=True)
class Axioms:
    """What an ontology says.

    Attributes:
        inclusions: pairs of concepts of which the first is part of the second.
        ignored: what the ontology's file says beyond that, in words; tags are matched without it.
    """

    classes: frozenset[str] = frozenset()
    inclusions: tuple[tuple[Concept, Concept], ...] = ()
    roles: Mapping[str, Role] = field(default_factory=dict)
    individuals: Mapping[str, Individual] = field(default_factory=dict)
    ignored: tuple[str, ...] = ()

    def merged(self, other: Axioms) -> Axioms:
        """What both say."""
        individuals = dict(self.individuals)
        for name, more in other.individuals.items():
            known = individuals.get(name, Individual())
            individuals[name] = Individual(known.types + more.types, known.links + more.links)
        roles = dict(self.roles)
        for name, role in other.roles.items():
            known_role = roles.get(name, Role())
            roles[name] = Role(known_role.supers + role.supers, known_role.transitive or role.transitive)
        return Axioms(
            self.classes | other.classes,
            self.inclusions + other.inclusions,
            roles,
            individuals,
            self.ignored + other.ignored,
        )


_MOST_MEMORISED = 1_000_000


class Ontology:
    """Axioms with the questions that tags ask of them.

    A name that is an individual and no class is read as that individual: ``∃hasSource.cam1`` is
    ``∃hasSource.{cam1}`` (the paper's punning, section IV-B).

    >>> from rosa_streams.tags import parse_tag
    >>> axioms = Axioms(individuals={"cam1": Individual(types=(parse_tag("Camera"),))})
    >>> Ontology(axioms).matches(parse_tag("RawImage ⊓ ∃hasSource.cam1"), parse_tag("hasSource some Camera"))
    True
    """

    def __init__(self, axioms: Axioms | None = None) -> None:
        self.axioms = axioms or Axioms()
        self._individuals = frozenset(self.axioms.individuals) - self.axioms.classes
        self._resolved: dict[Concept, Concept] = {}
        self._saturation: Saturation | None = None
        self._matches: dict[tuple[Concept, Concept], bool] = {}

    def matches(self, output: Concept, wanted: Concept) -> bool:
        """Whether ``output`` is part of ``wanted`` (``output ⊑ wanted``); not symmetric. Answers are remembered."""
        key = (output, wanted)
        known = self._matches.get(key)
        if known is None:
            if len(self._matches) >= _MOST_MEMORISED:
                self._matches.clear()
            known = output == wanted or self._saturated(output).satisfies(self.resolve(wanted))
            self._matches[key] = known
        return known

    def classes_of(self, concept: Concept) -> frozenset[str]:
        """The named classes, and predicates as text, that a concept is part of: what an index of tags goes by."""
        return frozenset(self._saturated(concept).names)

    def individuals_of(self, class_name: str) -> tuple[str, ...]:
        """The individuals of a class, in order of their names."""
        wanted = Concept.of(Named(class_name))
        found = (name for name in self.axioms.individuals if self.matches(Concept.of(One(name)), wanted))
        return tuple(sorted(found))

    def known_names(self) -> frozenset[str]:
        """The classes and individuals that the ontology declares."""
        return self.axioms.classes | frozenset(self.axioms.individuals)

    def resolve(self, concept: Concept) -> Concept:
        """The concept with names of individuals read as nominals."""
        if not self._individuals:
            return concept
        known = self._resolved.get(concept)
        if known is None:
            if len(self._resolved) >= _MOST_MEMORISED:
                self._resolved.clear()
            known = Concept(frozenset(self._resolve_atom(atom) for atom in concept.atoms))
            self._resolved[concept] = known
        return known

    def _resolve_atom(self, atom: Named | One | Some | Predicate) -> Named | One | Some | Predicate:
        if isinstance(atom, Named) and atom.name in self._individuals:
            return One(atom.name)
        if isinstance(atom, Some):
            return Some(atom.role, self.resolve(atom.filler))
        return atom

    def _saturated(self, concept: Concept) -> Node:
        if self._saturation is None:
            self._saturation = Saturation(
                [(self.resolve(left), self.resolve(right)) for left, right in self.axioms.inclusions],
                {name: role.supers for name, role in self.axioms.roles.items()},
                frozenset(name for name, role in self.axioms.roles.items() if role.transitive),
                {
                    name: (tuple(self.resolve(each) for each in known.types), known.links)
                    for name, known in self.axioms.individuals.items()
                },
            )
        return self._saturation.node(self.resolve(concept))


def unknown_names(ontology: Ontology, names: Iterable[str]) -> list[str]:
    """Those of the names that the ontology does not declare, in order and once each."""
    known = ontology.known_names()
    return [name for name in dict.fromkeys(names) if name not in known]
