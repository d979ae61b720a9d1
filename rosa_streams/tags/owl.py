"""Ontologies from OWL files, and tags in Turtle, through rdflib (extra ``ontology``)."""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosa_core.errors import InputError, Location, Problem
from rosa_core.formats.text_source import read_text
from rosa_streams.errors import StreamError, TagError
from rosa_streams.tags.concepts import EVERYTHING, Concept, Named, One, Some, conjunction
from rosa_streams.tags.ontology import Axioms, Individual, Role

if TYPE_CHECKING:
    from rdflib import Graph

LARGEST = 8_000_000
"""How many characters an OWL file may have."""

_DEEPEST = 40
_FORMATS = {".ttl": "turtle", ".nt": "nt", ".owl": "xml", ".rdf": "xml"}
_PREFIXES = (
    "@prefix : <#> . @prefix owl: <http://www.w3.org/2002/07/owl#> . "
    "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> . "
)


class _BeyondError(Exception):
    """A class expression beyond EL; the text names it."""


def parse_turtle_tag(text: str, where: Location | None = None) -> Concept:
    """Read a tag in Turtle: one class expression, such as ``[ owl:onProperty :hasSource ; owl:hasValue :cam1 ]``.

    The prefixes ``owl:``, ``rdf:`` and the empty one are declared.

    Raises:
        TagError: if it is not Turtle, or goes beyond EL.
        StreamError: if rdflib is missing.
    """
    graph = _graph(where)
    try:
        graph.parse(data=f"{_PREFIXES}<#the-tag> owl:equivalentClass {text} .", format="turtle", publicID="tag:")
    # rdflib's readers fail on text from outside in whatever way it comes.
    except Exception as error:
        what = f"not valid Turtle: {' '.join(str(error).split())[:200]}"
        raise TagError(Problem(what, where, "write one class expression in [ ]")) from None
    from rdflib import OWL

    (_, _, node), *_ = graph.triples((None, OWL.equivalentClass, None))
    try:
        return _Reader(graph, where or Location("tag")).concept(node)
    except _BeyondError as error:
        raise TagError(Problem(f"the tag goes beyond EL: {error}", where)) from None


def read_owl(file: str | PathLike[str]) -> Axioms:
    """What an OWL file says, as far as EL goes; the rest is in ``Axioms.ignored``.

    Raises:
        InputError: if it cannot be read, is not RDF, or two of its names have the same local name.
        StreamError: if rdflib is missing.
    """
    where = Location(str(file))
    text = read_text(file)
    if len(text) > LARGEST:
        raise StreamError(Problem(f"it has more than {LARGEST:,} characters", where))
    kind = _FORMATS[Path(file).suffix]
    if kind == "xml":
        _refuse_entities(text, where)
    graph = _graph(where)
    try:
        graph.parse(data=text, format=kind, publicID="ontology:")
    except Exception as error:
        line = getattr(error, "lines", None)
        place = Location(str(file), line + 1 if isinstance(line, int) else None)
        what = " ".join(str(error).split())[:200]
        raise StreamError(Problem(f"not valid {'RDF/XML' if kind == 'xml' else 'Turtle'}: {what}", place)) from None
    return _Reader(graph, where).axioms()


def _refuse_entities(text: str, where: Location) -> None:
    """RDF/XML often declares entities for its namespaces; a bounded number of plain ones would do, none is safe."""
    from xml.sax import SAXException, SAXParseException
    from xml.sax.handler import ContentHandler

    from defusedxml import DefusedXmlException
    from defusedxml.sax import parseString

    try:
        parseString(text.encode(), ContentHandler())
    except SAXParseException as error:
        raise StreamError(
            Problem(f"not valid RDF/XML: {error.getMessage()}", Location(where.file, error.getLineNumber()))
        ) from None
    except DefusedXmlException:
        hint = "save it as Turtle, or write the namespaces out"
        raise StreamError(Problem("entities are not allowed in RDF/XML", where, hint)) from None
    except (SAXException, ValueError, LookupError) as error:
        raise StreamError(Problem(f"not valid RDF/XML: {error}", where)) from None


def _graph(where: Location | None) -> Graph:
    try:
        from rdflib import Graph
    except ImportError:
        hint = "pip install 'rosa-coadaptation[ontology]'"
        raise StreamError(Problem("reading OWL and Turtle needs rdflib", where, hint)) from None
    return Graph()


class _Reader:
    """Reads axioms out of a graph."""

    def __init__(self, graph: Graph, where: Location) -> None:
        from rdflib import OWL, RDF, RDFS

        self._graph = graph
        self._where = where
        self._owl, self._rdf, self._rdfs = OWL, RDF, RDFS
        self._names: dict[str, Any] = {}
        self._ignored: dict[str, None] = {}

    def axioms(self) -> Axioms:
        from rdflib import URIRef

        owl, rdf, rdfs = self._owl, self._rdf, self._rdfs
        classes = {self._name(node) for node in self._graph.subjects(rdf.type, owl.Class) if isinstance(node, URIRef)}
        roles = {node for node in self._graph.subjects(rdf.type, owl.ObjectProperty) if isinstance(node, URIRef)}
        inclusions = tuple(self._inclusions())
        supers = {
            self._name(role): Role(
                tuple(sorted(self._name(above) for above in self._graph.objects(role, rdfs.subPropertyOf))),
                (role, rdf.type, owl.TransitiveProperty) in self._graph,
            )
            for role in sorted(roles)
        }
        for forbidden in (owl.disjointWith, owl.complementOf, owl.inverseOf, rdfs.range, owl.propertyChainAxiom):
            if next(self._graph.triples((None, forbidden, None)), None) is not None:
                self._ignored[f"'{_local(forbidden)}' is beyond what tags are matched by"] = None
        individuals = self._individuals(roles)
        return Axioms(frozenset(classes), inclusions, supers, individuals, tuple(self._ignored))

    def _inclusions(self) -> Iterator[tuple[Concept, Concept]]:
        owl, rdfs = self._owl, self._rdfs
        for sub, above in sorted(self._graph.subject_objects(rdfs.subClassOf), key=str):
            yield from self._pair(sub, above)
        for left, right in sorted(self._graph.subject_objects(owl.equivalentClass), key=str):
            yield from self._pair(left, right)
            yield from self._pair(right, left)
        for role, domain in sorted(self._graph.subject_objects(rdfs.domain), key=str):
            if (role, self._rdf.type, owl.ObjectProperty) in self._graph:
                for concept in self._understood(domain):
                    yield Concept.of(Some(self._name(role), EVERYTHING)), concept

    def _pair(self, left: Any, right: Any) -> Iterator[tuple[Concept, Concept]]:
        for first in self._understood(left):
            for second in self._understood(right):
                yield first, second

    def _understood(self, node: Any) -> list[Concept]:
        try:
            return [self.concept(node)]
        except _BeyondError as error:
            self._ignored[f"an axiom with {error} is beyond EL"] = None
            return []

    def _individuals(self, roles: set[Any]) -> dict[str, Individual]:
        from rdflib import URIRef

        owl, rdf = self._owl, self._rdf
        known: dict[str, Individual] = {}
        for node in sorted(self._graph.subjects(rdf.type, None, unique=True), key=str):
            kinds = list(self._graph.objects(node, rdf.type))
            if not isinstance(node, URIRef) or any(
                _is_vocabulary(kind) and kind != owl.NamedIndividual for kind in kinds
            ):
                continue
            types = tuple(
                concept
                for kind in sorted(kinds, key=str)
                if kind != owl.NamedIndividual
                for concept in self._understood(kind)
            )
            links = tuple(
                (self._name(role), self._name(other))
                for role in sorted(roles)
                for other in sorted(self._graph.objects(node, role), key=str)
                if isinstance(other, URIRef)
            )
            known[self._name(node)] = Individual(types, links)
        return known

    def concept(self, node: Any, depth: int = 0) -> Concept:
        """The concept of a class expression."""
        from rdflib import URIRef

        owl = self._owl
        if depth > _DEEPEST:
            raise TagError(Problem(f"a class expression is nested more than {_DEEPEST} levels deep", self._where))
        if isinstance(node, URIRef):
            return EVERYTHING if node == owl.Thing else Concept.of(Named(self._name(node)))
        members = self._graph.value(node, owl.intersectionOf)
        if members is not None:
            return conjunction(self.concept(member, depth + 1) for member in self._list(members))
        role = self._graph.value(node, owl.onProperty)
        if role is not None:
            return self._restriction(node, self._name(role), depth)
        ones = self._graph.value(node, owl.oneOf)
        if ones is not None:
            individuals = self._list(ones)
            if len(individuals) == 1:
                return Concept.of(One(self._name(individuals[0])))
        beyond = sorted({_local(kind) for kind in self._graph.predicates(node, None)} - {"type"})
        raise _BeyondError(f"'{beyond[0]}'" if beyond else "an unknown expression")

    def _restriction(self, node: Any, role: str, depth: int) -> Concept:
        filler = self._graph.value(node, self._owl.someValuesFrom)
        if filler is not None:
            return Concept.of(Some(role, self.concept(filler, depth + 1)))
        value = self._graph.value(node, self._owl.hasValue)
        if value is not None:
            return Concept.of(Some(role, Concept.of(One(self._name(value)))))
        beyond = sorted({_local(kind) for kind in self._graph.predicates(node, None)} - {"type", "onProperty"})
        raise _BeyondError(f"'{beyond[0]}'" if beyond else "a restriction without a filler")

    def _list(self, head: Any) -> list[Any]:
        members: list[Any] = []
        seen = set()
        while head != self._rdf.nil:
            if head in seen or head is None:
                raise TagError(Problem("a list of class expressions does not end", self._where))
            seen.add(head)
            members.append(self._graph.value(head, self._rdf.first))
            head = self._graph.value(head, self._rdf.rest)
        return members

    def _name(self, node: Any) -> str:
        local = _local(node)
        other = self._names.setdefault(local, node)
        if other != node:
            raise InputError(Problem(f"two names end in '{local}': {other} and {node}", self._where, "rename one"))
        return local


def _local(node: Any) -> str:
    text = str(node).rstrip("#/")
    return text[max(text.rfind(sign) for sign in "#/:") + 1 :]


def _is_vocabulary(node: Any) -> bool:
    return str(node).startswith(
        (
            "http://www.w3.org/2002/07/owl#",
            "http://www.w3.org/2000/01/rdf-schema#",
            "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
        )
    )
