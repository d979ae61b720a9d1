"""Ontologies from files: YAML here, OWL and Turtle through :mod:`rosa_streams.tags.owl`."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import Any

from rosa_core.errors import InputError, Problem, nearest
from rosa_core.formats.yaml_source import KeyPath, YamlSource
from rosa_streams.errors import StreamError
from rosa_streams.tags.concepts import EVERYTHING, Concept, Named, Some
from rosa_streams.tags.ontology import Axioms, Individual, Ontology, Role
from rosa_streams.tags.parsing import parse_tag

OWL_SUFFIXES = {".owl", ".ttl", ".rdf", ".nt"}
SECTIONS = ("classes", "roles", "individuals")
_CLASS_KEYS = ("is", "equals")
_ROLE_KEYS = ("is", "transitive", "domain")
_INDIVIDUAL_KEYS = ("is", "links")


def load_ontology(*files: str | PathLike[str]) -> Ontology:
    """Read ontologies and put them together.

    Args:
        files: YAML, or OWL as RDF/XML (``.owl``, ``.rdf``), Turtle (``.ttl``) or N-Triples (``.nt``); these need the
            extra ``ontology``.

    Raises:
        InputError: for files that cannot be read or do not hold together.
    """
    axioms = Axioms()
    for file in files:
        axioms = axioms.merged(load_axioms(file))
    return Ontology(axioms)


def load_axioms(file: str | PathLike[str]) -> Axioms:
    """What one file says; see :func:`load_ontology`."""
    if Path(file).suffix in OWL_SUFFIXES:
        from rosa_streams.tags.owl import read_owl

        return read_owl(file)
    source = YamlSource(file)
    data = source.data
    if not isinstance(data, dict):
        what = "an ontology is a mapping with classes, roles or individuals"
        raise StreamError(Problem(what, source.location(())))
    return axioms_from_yaml(source, data, ())


def axioms_from_yaml(source: YamlSource, data: dict[Any, Any], path: KeyPath) -> Axioms:
    """The axioms in a mapping with ``classes``, ``roles`` and ``individuals``.

    Raises:
        InputError: with every problem that was found.
    """
    reader = _Reader(source)
    reader.known_keys(data, SECTIONS, path)
    axioms = Axioms()
    for section, read in (("classes", reader.class_), ("roles", reader.role), ("individuals", reader.individual)):
        entries = data.get(section) or {}
        if not isinstance(entries, dict):
            reader.problem(f"'{section}' is a mapping from names", (*path, section))
            continue
        for name, entry in entries.items():
            axioms = axioms.merged(read(str(name), entry or {}, (*path, section, name)))
    if reader.problems:
        raise StreamError(reader.problems)
    return axioms


class _Reader:
    """Reads entries of an ontology in YAML and collects what is wrong."""

    def __init__(self, source: YamlSource) -> None:
        self.problems: list[Problem] = []
        self._source = source

    def problem(self, what: str, path: KeyPath, hint: str | None = None) -> None:
        self.problems.append(Problem(what, self._source.location(path), hint))

    def known_keys(self, entry: Any, known: Iterable[str], path: KeyPath) -> dict[Any, Any]:
        if isinstance(entry, list | str):
            entry = {"is": entry}
        if not isinstance(entry, dict):
            self.problem(f"expected a mapping with {', '.join(known)}", path)
            return {}
        for key in entry:
            if key not in known:
                hint = nearest(str(key), known) or f"known are {', '.join(known)}"
                self.problem(f"unknown key '{key}'", (*path, key), hint)
        return entry

    def class_(self, name: str, entry: Any, path: KeyPath) -> Axioms:
        entry = self.known_keys(entry, _CLASS_KEYS, path)
        this = Concept.of(Named(name))
        inclusions = [(this, above) for above in self._concepts(entry.get("is"), (*path, "is"))]
        for same in self._concepts(entry.get("equals"), (*path, "equals")):
            inclusions += [(this, same), (same, this)]
        return Axioms(classes=frozenset({name}), inclusions=tuple(inclusions))

    def role(self, name: str, entry: Any, path: KeyPath) -> Axioms:
        entry = self.known_keys(entry, _ROLE_KEYS, path)
        transitive = entry.get("transitive", False)
        if not isinstance(transitive, bool):
            self.problem("'transitive' is true or false", (*path, "transitive"))
        supers = tuple(self._texts(entry.get("is"), (*path, "is")))
        left = Concept.of(Some(name, EVERYTHING))
        domains = tuple((left, domain) for domain in self._concepts(entry.get("domain"), (*path, "domain")))
        return Axioms(roles={name: Role(supers, bool(transitive))}, inclusions=domains)

    def individual(self, name: str, entry: Any, path: KeyPath) -> Axioms:
        entry = self.known_keys(entry, _INDIVIDUAL_KEYS, path)
        types = tuple(self._concepts(entry.get("is"), (*path, "is")))
        links = entry.get("links") or {}
        if not isinstance(links, dict):
            self.problem("'links' is a mapping from roles to individuals", (*path, "links"))
            links = {}
        pairs = tuple(
            (str(role), other)
            for role, others in links.items()
            for other in self._texts(others, (*path, "links", role))
        )
        return Axioms(individuals={name: Individual(types, pairs)})

    def _concepts(self, value: Any, path: KeyPath) -> list[Concept]:
        concepts = []
        for text in self._texts(value, path):
            try:
                concepts.append(parse_tag(text, self._source.location(path)))
            except InputError as error:
                self.problems.extend(error.problems)
        return concepts

    def _texts(self, value: Any, path: KeyPath) -> list[str]:
        values = value if isinstance(value, list) else [] if value is None else [value]
        for each in values:
            if not isinstance(each, str):
                self.problem(f"expected a name or a list of names, not {each!r}", path)
        return [each for each in values if isinstance(each, str)]
