"""Tags: the meaning of streams as concepts, and whether one is part of another."""

from rosa_streams.tags.concepts import EVERYTHING, Concept, Named, One, Predicate, Some
from rosa_streams.tags.loading import load_ontology
from rosa_streams.tags.ontology import Axioms, Individual, Ontology, Role, Similarity
from rosa_streams.tags.parsing import parse_tag

__all__ = [
    "EVERYTHING",
    "Axioms",
    "Concept",
    "Individual",
    "Named",
    "One",
    "Ontology",
    "Predicate",
    "Role",
    "Similarity",
    "Some",
    "load_ontology",
    "parse_tag",
]
