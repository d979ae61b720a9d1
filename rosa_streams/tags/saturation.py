"""Subsumption in EL with nominals, by saturation: everything that follows of a concept is written down once.

The canonical model of a concept C has a node for C, for each individual, and for each filler of an existential; each
node carries the classes that follow for it. ``C ⊑ D`` holds exactly if the node of C satisfies D, a look down the
structure of D. This is sound and complete for the inclusions, role hierarchies, transitive roles and assertions that
:class:`~rosa_streams.tags.ontology.Axioms` holds (Baader, Brandt, Lutz: Pushing the EL Envelope, 2005; nominals that
are reachable are merged, as Kazakov, Krötzsch, Simančík do, 2012).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from rosa_streams.tags.concepts import Atom, Concept, Named, One, Predicate, Some

Inclusion = tuple[Concept, Concept]


class Node:
    """One element of the canonical model: its classes (predicates as text), its individuals, its roles to others."""

    __slots__ = ("fixed", "merged_into", "names", "ones", "successors")

    def __init__(self) -> None:
        self.names: set[str] = set()
        self.ones: set[str] = set()
        self.successors: dict[str, list[Node]] = {}
        self.merged_into: Node | None = None
        self.fixed = False

    def satisfies(self, concept: Concept) -> bool:
        """Whether the element is in the concept."""
        return all(self._satisfies(atom) for atom in concept.atoms)

    def _satisfies(self, atom: Atom) -> bool:
        if isinstance(atom, Named):
            return atom.name in self.names
        if isinstance(atom, Some):
            filler = atom.filler
            return any(found(node).satisfies(filler) for node in self.successors.get(atom.role, ()))
        return atom.individual in self.ones if isinstance(atom, One) else str(atom) in self.names


class _FixedError(Exception):
    """Something would follow for a node that all concepts share."""


def found(node: Node) -> Node:
    """The node that this one has been merged into."""
    while node.merged_into is not None:
        node = node.merged_into
    return node


class Saturation:
    """The canonical models of concepts under one ontology.

    The part that individuals have is computed once and shared. A concept that says something new of an individual
    gets a model of its own.
    """

    def __init__(
        self,
        inclusions: Sequence[Inclusion],
        role_supers: Mapping[str, tuple[str, ...]],
        transitive: frozenset[str],
        individuals: Mapping[str, tuple[tuple[Concept, ...], tuple[tuple[str, str], ...]]],
    ) -> None:
        self._direct: dict[str, list[Concept]] = {}
        self._general: list[Inclusion] = []
        for left, right in inclusions:
            (atom, *more) = left.atoms or (None,)
            if isinstance(atom, Named) and not more:
                self._direct.setdefault(atom.name, []).append(right)
            else:
                self._general.append((left, right))
        self._supers = {role: _closure(role, role_supers) for role in role_supers}
        self._transitive = transitive
        self._individuals = individuals
        self._shared = _Model(self, None)
        self._shared.add_individuals()
        self._shared.fix()
        self._nodes: dict[Concept, Node] = {}

    def node(self, concept: Concept) -> Node:
        """The element that stands for the concept, with all that follows."""
        node = self._nodes.get(concept)
        if node is None:
            node = self._nodes[concept] = self._new_node(concept)
        return node

    def _new_node(self, concept: Concept) -> Node:
        try:
            return _Model(self, self._shared).root(concept)
        except _FixedError:
            model = _Model(self, None)
            model.add_individuals()
            return model.root(concept)

    def directly_above(self, name: str) -> Iterable[Concept]:
        """The concepts that a class is directly part of."""
        return self._direct.get(name, ())

    def roles(self, role: str) -> Iterable[str]:
        """The role and all that it is a special case of."""
        return self._supers.get(role, (role,))

    @property
    def general(self) -> Sequence[Inclusion]:
        """The inclusions whose left side is more than a class."""
        return self._general

    @property
    def transitive(self) -> frozenset[str]:
        """The transitive roles."""
        return self._transitive

    @property
    def individuals(self) -> Mapping[str, tuple[tuple[Concept, ...], tuple[tuple[str, str], ...]]]:
        """Types and links of each individual."""
        return self._individuals


class _Model:
    """One canonical model while it is built, on top of the shared one if that is given."""

    def __init__(self, saturation: Saturation, below: _Model | None) -> None:
        self._saturation = saturation
        self._below = below
        self._ones: dict[str, Node] = {}
        self._fillers: dict[Concept, Node] = {}
        self._nodes: list[Node] = []
        self._work: list[tuple[Node, Atom]] = []

    def add_individuals(self) -> None:
        for name, (types, links) in self._saturation.individuals.items():
            node = self._one(name)
            self._queue(node, types)
            for role, other in links:
                self._link(node, role, self._one(other))
        self._saturate()

    def root(self, concept: Concept) -> Node:
        node = self._new()
        self._queue(node, (concept,))
        self._saturate()
        return found(node)

    def fix(self) -> None:
        for node in self._nodes:
            node.fixed = True

    def _new(self) -> Node:
        node = Node()
        self._nodes.append(node)
        # What follows from everything (⊤ ⊑ D) is found by the general inclusions.
        return node

    def _one(self, name: str) -> Node:
        node = self._ones.get(name) or (self._below._ones.get(name) if self._below else None)
        if node is None:
            node = self._ones[name] = self._new()
            node.ones.add(name)
        return found(node)

    def _filler(self, concept: Concept) -> Node:
        if len(concept.atoms) == 1:
            (atom,) = concept.atoms
            if isinstance(atom, One):
                return self._one(atom.individual)
        node = self._fillers.get(concept) or (self._below._fillers.get(concept) if self._below else None)
        if node is None:
            node = self._fillers[concept] = self._new()
            self._queue(node, (concept,))
        return found(node)

    def _queue(self, node: Node, concepts: Iterable[Concept]) -> None:
        self._work.extend((node, atom) for concept in concepts for atom in concept.atoms)

    def _saturate(self) -> None:
        self._drain()
        while self._apply_general() | self._apply_transitivity():
            self._drain()

    def _drain(self) -> None:
        while self._work:
            node, atom = self._work.pop()
            self._add(found(node), atom)

    def _add(self, node: Node, atom: Atom) -> None:
        if isinstance(atom, One):
            self._merge(node, self._one(atom.individual))
        elif isinstance(atom, Some):
            self._link(node, atom.role, self._filler(atom.filler))
        else:
            name = str(atom) if isinstance(atom, Predicate) else atom.name
            if name not in node.names:
                _may_change(node)
                node.names.add(name)
                if isinstance(atom, Named):
                    self._queue(node, self._saturation.directly_above(name))

    def _link(self, node: Node, role: str, other: Node) -> None:
        for each in self._saturation.roles(role):
            others = node.successors.get(each, [])
            if not any(found(known) is other for known in others):
                _may_change(node)
                node.successors.setdefault(each, []).append(other)

    def _merge(self, node: Node, into: Node) -> None:
        if node is into:
            return
        if node.fixed and not into.fixed:
            raise _FixedError
        if not (node.names <= into.names and node.ones <= into.ones):
            _may_change(into)
        into.names |= node.names
        into.ones |= node.ones
        for role, others in node.successors.items():
            for other in others:
                self._link(into, role, found(other))
        _may_change(node)
        node.merged_into = into

    def _apply_general(self) -> bool:
        changed = False
        for left, right in self._saturation.general:
            for node in self._nodes:
                if node.merged_into is None and node.satisfies(left) and not node.satisfies(right):
                    self._queue(node, (right,))
                    changed = True
        return changed

    def _apply_transitivity(self) -> bool:
        changed = False
        for role in self._saturation.transitive:
            for node in self._nodes:
                if node.merged_into is not None:
                    continue
                for near in list(node.successors.get(role, ())):
                    for far in list(found(near).successors.get(role, ())):
                        before = len(node.successors[role])
                        self._link(node, role, found(far))
                        changed |= len(node.successors[role]) > before
        return changed


def _may_change(node: Node) -> None:
    if node.fixed:
        raise _FixedError


def _closure(role: str, supers: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    closed = {role: None}
    work = [role]
    while work:
        for above in supers.get(work.pop(), ()):
            if above not in closed:
                closed[above] = None
                work.append(above)
    return tuple(closed)
