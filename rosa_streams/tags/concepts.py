"""Concepts: what a stream is about, in the description logic EL (named classes, conjunction, existential, nominals)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TypeAlias


@dataclass(frozen=True, slots=True, order=True)
class Named:
    """Everything of a class, such as ``YUVImage``."""

    name: str

    def __str__(self) -> str:
        return self.name


@dataclass(frozen=True, slots=True, order=True)
class One:
    """One individual (a nominal), such as ``{cam1}``."""

    individual: str

    def __str__(self) -> str:
        return f"{{{self.individual}}}"


@dataclass(frozen=True, slots=True)
class Some:
    """Everything with a role to something, such as ``∃hasSource.Camera``."""

    role: str
    filler: Concept

    def __str__(self) -> str:
        return f"∃{self.role}.{self.filler if len(self.filler.atoms) == 1 else f'({self.filler})'}"


@dataclass(frozen=True, slots=True, order=True)
class Predicate:
    """A first-order atom such as ``Undistorted(cam1)``: it matches the very same atom and nothing else."""

    name: str
    arguments: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.name}({', '.join(self.arguments)})"


Atom: TypeAlias = Named | One | Some | Predicate


@dataclass(frozen=True, slots=True)
class Concept:
    """A conjunction of atoms; of none of them, it is everything (``⊤``).

    >>> str(Concept.of(Named("Undistorted"), Some("hasSource", Concept.of(One("cam1")))))
    'Undistorted ⊓ ∃hasSource.{cam1}'
    """

    atoms: frozenset[Atom]
    _hash: int = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_hash", hash(self.atoms))

    def __hash__(self) -> int:
        return self._hash

    @classmethod
    def of(cls, *atoms: Atom) -> Concept:
        """The conjunction of these atoms."""
        return cls(frozenset(atoms))

    def both(self, other: Concept) -> Concept:
        """What is in this concept and in the other."""
        return Concept(self.atoms | other.atoms)

    def __str__(self) -> str:
        return " ⊓ ".join(str(atom) for atom in sorted(self.atoms, key=_spelling_order)) or "⊤"


EVERYTHING = Concept(frozenset())


def names_in(concept: Concept) -> Iterator[str]:
    """The names of classes and individuals that a concept mentions, at any depth."""
    for atom in concept.atoms:
        if isinstance(atom, Named):
            yield atom.name
        elif isinstance(atom, One):
            yield atom.individual
        elif isinstance(atom, Some):
            yield from names_in(atom.filler)


def roles_in(concept: Concept) -> Iterator[str]:
    """The roles that a concept mentions, at any depth."""
    for atom in concept.atoms:
        if isinstance(atom, Some):
            yield atom.role
            yield from roles_in(atom.filler)


def conjunction(concepts: Iterable[Concept]) -> Concept:
    """What is in all of these concepts."""
    return Concept(frozenset(atom for concept in concepts for atom in concept.atoms))


def _spelling_order(atom: Atom) -> tuple[int, str]:
    return (Named, Predicate, Some, One).index(type(atom)), str(atom)
