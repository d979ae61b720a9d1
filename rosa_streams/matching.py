"""The validity matrix (section IV-D of the paper): which output may feed which input, kept up to date port by port."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from rosa_streams.environment import Target, Transformation
from rosa_streams.tags import Concept, Named, Ontology, Predicate, Similarity


class PortName(NamedTuple):
    """A port of a transformation; a target is an input port of nothing: ``PortName("", qid)``."""

    owner: str
    port: str

    def __str__(self) -> str:
        return f"{self.owner}.{self.port}" if self.owner else self.port


class ValidityMatrix:
    """Rows are inputs and targets, columns outputs; look-up takes constant time.

    Adding or removing a transformation computes its own rows and columns only. Ports with the same tag share one
    comparison, and an index over the classes of tags leaves out what cannot match.
    """

    def __init__(self, similarity: Similarity | None = None) -> None:
        self._similarity = similarity or Ontology()
        self._wanted: dict[Concept, dict[PortName, None]] = {}
        self._given: dict[Concept, dict[PortName, None]] = {}
        self._providers: dict[Concept, dict[Concept, None]] = {}
        self._by_class: dict[str, dict[Concept, None]] = {}
        self._wanted_by_class: dict[str, dict[Concept, None]] = {}
        self._wanted_by_none: dict[Concept, None] = {}
        self._tags: dict[PortName, tuple[Concept, bool]] = {}

    @classmethod
    def of(
        cls,
        transformations: Iterable[Transformation],
        targets: Iterable[Target] = (),
        similarity: Similarity | None = None,
    ) -> ValidityMatrix:
        """The matrix of a library and a goal."""
        matrix = cls(similarity)
        for transformation in transformations:
            matrix.add(transformation)
        for target in targets:
            matrix.add_target(target)
        return matrix

    @property
    def inputs(self) -> tuple[PortName, ...]:
        """The rows: input ports and targets."""
        return tuple(name for name, (_, is_input) in self._tags.items() if is_input)

    @property
    def outputs(self) -> tuple[PortName, ...]:
        """The columns: output ports."""
        return tuple(name for name, (_, is_input) in self._tags.items() if not is_input)

    def add(self, transformation: Transformation) -> None:
        """Add the rows and columns of a transformation."""
        for port in transformation.inputs:
            self._add_input(PortName(transformation.tid, port.name), port.tag)
        for port in transformation.outputs:
            self._add_output(PortName(transformation.tid, port.name), port.tag)

    def remove(self, transformation: Transformation) -> None:
        """Remove the rows and columns of a transformation."""
        for port in (*transformation.inputs, *transformation.outputs):
            self._remove(PortName(transformation.tid, port.name))

    def add_target(self, target: Target) -> None:
        """Add the row of a target."""
        self._add_input(PortName("", target.qid), target.tag)

    def remove_target(self, target: Target) -> None:
        """Remove the row of a target."""
        self._remove(PortName("", target.qid))

    def matches(self, output: PortName, wanted: PortName) -> bool:
        """Whether the output may feed the input. Raises: KeyError for ports that are not there."""
        return self._tags[output][0] in self._providers[self._tags[wanted][0]]

    def providers(self, wanted: PortName) -> Iterator[PortName]:
        """The outputs that may feed an input or a target. Raises: KeyError."""
        return self.providers_of_tag(self._tags[wanted][0])

    def providers_of_tag(self, tag: Concept) -> Iterator[PortName]:
        """The outputs that may feed what asks for the tag. Raises: KeyError if nothing does."""
        for given in self._providers[tag]:
            yield from self._given[given]

    def pairs(self) -> Iterator[tuple[PortName, PortName]]:
        """Every output and input that match."""
        for wanted, names in self._wanted.items():
            for name in names:
                for output in self.providers_of_tag(wanted):
                    yield output, name

    def _add_input(self, name: PortName, tag: Concept) -> None:
        self._tags[name] = (tag, True)
        names = self._wanted.setdefault(tag, {})
        if not names:
            matches = self._similarity.matches
            self._providers[tag] = {given: None for given in self._candidates(tag) if matches(given, tag)}
            index_name = _index_name(self._resolved(tag))
            if index_name is None:
                self._wanted_by_none[tag] = None
            else:
                self._wanted_by_class.setdefault(index_name, {})[tag] = None
        names[name] = None

    def _add_output(self, name: PortName, tag: Concept) -> None:
        self._tags[name] = (tag, False)
        names = self._given.setdefault(tag, {})
        if not names:
            matches = self._similarity.matches
            for wanted in self._askers(tag):
                if matches(tag, wanted):
                    self._providers[wanted][tag] = None
            for each in self._classes(tag):
                self._by_class.setdefault(each, {})[tag] = None
        names[name] = None

    def _remove(self, name: PortName) -> None:
        tag, is_input = self._tags.pop(name)
        names = self._wanted[tag] if is_input else self._given[tag]
        del names[name]
        if names:
            return
        if is_input:
            del self._wanted[tag], self._providers[tag]
            index_name = _index_name(self._resolved(tag))
            del (self._wanted_by_none if index_name is None else self._wanted_by_class[index_name])[tag]
        else:
            del self._given[tag]
            for wanted in self._askers(tag):
                self._providers[wanted].pop(tag, None)
            for each in self._classes(tag):
                self._by_class[each].pop(tag, None)

    def _resolved(self, tag: Concept) -> Concept:
        return self._similarity.resolve(tag) if isinstance(self._similarity, Ontology) else Concept(frozenset())

    def _classes(self, tag: Concept) -> frozenset[str]:
        return self._similarity.classes_of(tag) if isinstance(self._similarity, Ontology) else frozenset()

    def _candidates(self, wanted: Concept) -> Iterable[Concept]:
        name = _index_name(self._resolved(wanted))
        return self._given if name is None else self._by_class.get(name, ())

    def _askers(self, given: Concept) -> Iterator[Concept]:
        yield from self._wanted_by_none
        for name in self._classes(given):
            yield from self._wanted_by_class.get(name, ())


def _index_name(tag: Concept) -> str | None:
    """One class (or predicate) that whatever matches the tag must be part of; None if it names none."""
    names = [str(atom) for atom in tag.atoms if isinstance(atom, Named | Predicate)]
    return max(names, key=lambda name: (len(name), name)) if names else None
