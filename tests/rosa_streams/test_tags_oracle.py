"""Subsumption against HermiT, a complete reasoner for all of OWL (where Java is)."""

from __future__ import annotations

import random
import shutil
import types
import warnings
from typing import Any

import pytest

from rosa_streams.tags import Axioms, Concept, Individual, Named, One, Ontology, Role, Some

CLASSES = [f"C{n}" for n in range(7)]
ROLES = ["r0", "r1", "r2"]
INDIVIDUALS = ["i0", "i1", "i2", "i3"]


def a_concept(rng: random.Random, depth: int) -> Concept:
    atoms: list[Any] = []
    for _ in range(rng.choice([1, 1, 2, 2, 3])):
        kind = rng.random()
        if kind < 0.45 or depth == 0:
            atoms.append(Named(rng.choice(CLASSES)))
        elif kind < 0.6:
            atoms.append(One(rng.choice(INDIVIDUALS)))
        else:
            atoms.append(Some(rng.choice(ROLES), a_concept(rng, depth - 1)))
    return Concept.of(*atoms)


def some_axioms(rng: random.Random) -> Axioms:
    inclusions = [(Concept.of(Named(rng.choice(CLASSES))), a_concept(rng, 1)) for _ in range(4)]
    inclusions += [(a_concept(rng, 1), Concept.of(Named(rng.choice(CLASSES)))) for _ in range(2)]
    return Axioms(
        frozenset(CLASSES),
        tuple(inclusions),
        {"r0": Role(("r1",)), "r1": Role(), "r2": Role((), transitive=True)},
        {
            name: Individual((a_concept(rng, 1),), ((rng.choice(ROLES), rng.choice(INDIVIDUALS)),))
            for name in INDIVIDUALS
        },
    )


class _Owl:
    """The same axioms in owlready2."""

    def __init__(self, axioms: Axioms) -> None:
        import owlready2

        self.owl = owlready2
        self.world = owlready2.World()
        self.ontology = self.world.get_ontology("http://example.org/o#")
        with self.ontology:
            self.classes = {name: types.new_class(name, (owlready2.Thing,)) for name in CLASSES}
            self.roles = {name: types.new_class(name, (owlready2.ObjectProperty,)) for name in ROLES}
            self.roles["r0"].is_a.append(self.roles["r1"])
            self.roles["r2"].is_a.append(owlready2.TransitiveProperty)
            self.individuals = {name: owlready2.Thing(name) for name in INDIVIDUALS}
            for number, (left, right) in enumerate(axioms.inclusions):
                general = types.new_class(f"Left{number}", (owlready2.Thing,))
                general.equivalent_to.append(self.expression(left))
                general.is_a.append(self.expression(right))
            for name, known in axioms.individuals.items():
                for concept in known.types:
                    self.individuals[name].is_a.append(self.expression(concept))
                for role, other in known.links:
                    getattr(self.individuals[name], role).append(self.individuals[other])

    def expression(self, concept: Concept) -> Any:
        parts = [self._atom(atom) for atom in sorted(concept.atoms, key=str)]
        return parts[0] if len(parts) == 1 else self.owl.And(parts)

    def _atom(self, atom: Any) -> Any:
        if isinstance(atom, Named):
            return self.classes[atom.name]
        if isinstance(atom, One):
            return self.owl.OneOf([self.individuals[atom.individual]])
        return self.roles[atom.role].some(self.expression(atom.filler))

    def subsumptions(self, concepts: list[Concept]) -> list[set[int]]:
        """For each concept, the numbers of those that it is part of."""
        with self.ontology:
            named = [types.new_class(f"Q{number}", (self.owl.Thing,)) for number in range(len(concepts))]
            for each, concept in zip(named, concepts, strict=True):
                each.equivalent_to.append(self.expression(concept))
            self.owl.sync_reasoner(self.world, debug=0)
        found = []
        for each in named:
            above = each.ancestors() | {
                other for same in each.ancestors() for other in same.equivalent_to if other in named
            }
            found.append({number for number, other in enumerate(named) if other in above})
        return found


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("java") is None, reason="HermiT needs Java")
@pytest.mark.parametrize("seed", range(4))
def test_subsumption_agrees_with_hermit_on_random_ontologies_and_concepts(seed: int) -> None:
    pytest.importorskip("owlready2")
    rng = random.Random(seed)
    axioms = some_axioms(rng)
    ontology = Ontology(axioms)
    concepts = list({a_concept(rng, 2): None for _ in range(45)})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        expected = _Owl(axioms).subsumptions(concepts)
    wrong = [
        (str(output), str(wanted), there)
        for first, output in enumerate(concepts)
        for second, wanted in enumerate(concepts)
        if (there := second in expected[first]) != ontology.matches(output, wanted)
    ]
    assert not wrong
    positive = sum(map(len, expected))
    assert positive > len(concepts), "some pairs besides a concept and itself"
