"""How likely each action is to be unfeasible, and which components matter for it: exact, by decision diagrams."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from dd.autoref import BDD

from rosa_core.model.elements import ElementKind, ElementRef
from rosa_verification.cause_sets import minimal
from rosa_verification.causes import Cause, Region
from rosa_verification.cut_sets import CutSets
from rosa_verification.structure import Combination, Gate, Structure

_Node = Any
"""A node of a decision diagram: ``dd`` has no types."""


_DIGITS = 12
"""Importances that differ by less are the same but for rounding."""


@dataclass(frozen=True, slots=True)
class Importance:
    """How much a component matters for an action.

    Args:
        component: its name.
        birnbaum: by how much its failure makes it more probable that the action is unfeasible, from 0 to 1.
        fussell_vesely: the share of a minimal cut set with the component in the cases in which the action is
            unfeasible, from 0 to 1; None if there are too many cut sets.
    """

    component: str
    birnbaum: float
    fussell_vesely: float | None


@dataclass(frozen=True, slots=True)
class ActionReliability:
    """How likely an action is to be unfeasible.

    Args:
        action: its name.
        unfeasible: the probability, from 0 to 1.
        importances: of every component that may fail and matters; the largest Birnbaum importance first, then by name.
    """

    action: str
    unfeasible: float
    importances: tuple[Importance, ...]

    def document(self) -> dict[str, object]:
        """The figures as JSON has them."""
        return {
            "action": self.action,
            "unfeasible": self.unfeasible,
            "importances": [
                {"component": one.component, "birnbaum": one.birnbaum, "fussell_vesely": one.fussell_vesely}
                for one in self.importances
            ],
        }


def action_reliabilities(
    structure: Structure, probabilities: Mapping[str, float], measured: Mapping[str, float] | None = None
) -> list[ActionReliability]:
    """How likely each action is to be unfeasible, in order of declaration.

    >>> from rosa_core import KnowledgeModel
    >>> from rosa_core.model import Action, Component, Function, FunctionalRequirement, FunctionDesign
    >>> model = KnowledgeModel(
    ...     actions=(Action("fly"),),
    ...     functions=(Function("lift"),),
    ...     components=(Component("rotors"), Component("wing")),
    ...     requirements=(FunctionalRequirement("fly", ("lift",)),),
    ...     function_designs=(
    ...         FunctionDesign("hovering", "lift", ("rotors",)),
    ...         FunctionDesign("gliding", "lift", ("wing",)),
    ...     ),
    ... )
    >>> (fly,) = action_reliabilities(Structure(model), {"rotors": 0.5, "wing": 0.25})
    >>> fly.unfeasible, [(one.component, one.birnbaum, one.fussell_vesely) for one in fly.importances]
    (0.125, [('wing', 0.5, 1.0), ('rotors', 0.25, 1.0)])

    Args:
        structure: of the model.
        probabilities: that a component has failed, independently of the others; those that are absent never do.
        measured: values of measures, in their units; the others have not been measured and violate nothing.
    """
    diagrams = _Diagrams(structure, probabilities, measured or {})
    cut_sets = CutSets(structure, None, limit=1_000)
    with _deep_recursion(len(structure.model.components)):
        return [
            _reliability(diagrams, cut_sets, ElementRef(ElementKind.ACTION, name))
            for name in structure.model.names[ElementKind.ACTION]
        ]


def _reliability(diagrams: _Diagrams, cut_sets: CutSets, action: ElementRef) -> ActionReliability:
    unfeasible = diagrams.of(action)
    probability, derivatives = diagrams.probability(unfeasible), diagrams.derivatives(unfeasible)
    found = cut_sets.of(action)
    cuts = None if found.order is not None else diagrams.failures_only(found.sets)
    importances = [
        Importance(component, birnbaum, _fussell_vesely(diagrams, cuts, component, probability))
        for component, birnbaum in derivatives.items()
    ]
    importances.sort(key=lambda one: (-round(one.birnbaum, _DIGITS), one.component))
    return ActionReliability(action.name, probability, tuple(importances))


def _fussell_vesely(
    diagrams: _Diagrams, cuts: list[frozenset[str]] | None, component: str, probability: float
) -> float | None:
    if cuts is None or not probability:
        return None
    with_it = diagrams.any_cut(cut for cut in cuts if component in cut)
    return diagrams.probability(with_it) / probability


class _Diagrams:
    """Decision diagrams of when elements are unfeasible, over the failures of components that may fail."""

    def __init__(self, structure: Structure, probabilities: Mapping[str, float], measured: Mapping[str, float]) -> None:
        self._structure = structure
        self._probabilities = probabilities
        self._measured = measured
        self._bdd = BDD()
        self._known: dict[ElementRef, _Node] = {}

    def of(self, element: ElementRef) -> _Node:
        """When an element is unfeasible."""
        if element not in self._known:
            self._known[element] = self._node(self._structure.unfeasible(element))
        return self._known[element]

    def any_cut(self, cuts: Iterable[frozenset[str]]) -> _Node:
        """When all components of one of several sets have failed."""
        result = self._bdd.false
        for cut in cuts:
            result |= self._bdd.cube(dict.fromkeys(cut, True))
        return result

    def failures_only(self, sets: Iterable[tuple[Cause, ...]]) -> list[frozenset[str]]:
        """The failures in those cut sets that can come about: by measured values and failures that are possible."""
        found = []
        for causes in sets:
            regions = (cause for cause in causes if isinstance(cause, Region))
            failures = frozenset(cause for cause in causes if not isinstance(cause, Region))
            if all(map(self._holds, regions)) and all(map(self._may_fail, failures)):
                found.append(failures)
        least = minimal([frozenset[Cause](one) for one in found])
        return [one for one in dict.fromkeys(found) if one in least]

    def probability(self, node: _Node) -> float:
        """That a diagram is true."""
        return self._probabilities_below(node)[node]

    def derivatives(self, node: _Node) -> dict[str, float]:
        """By component: how much more probable it is that a diagram is true when it has failed than when it works."""
        true = self._probabilities_below(node)
        reached = dict.fromkeys(true, 0.0)
        reached[node] = 1.0
        found: dict[str, float] = {}
        for one in reversed(true):
            if one.var is None:
                continue
            low, high = _branches(one)
            failing = self._probabilities[one.var]
            reached[low] += reached[one] * (1 - failing)
            reached[high] += reached[one] * failing
            found[one.var] = found.get(one.var, 0.0) + reached[one] * (true[high] - true[low])
        return found

    def _probabilities_below(self, node: _Node) -> dict[_Node, float]:
        """That each node under one is true, lower ones first: every branch before what it is a branch of."""
        found: dict[_Node, float] = {}
        for one in sorted(_nodes_below(node), key=lambda n: (-self._level(n), int(n))):
            if one.var is None:
                found[one] = 1.0 if one == self._bdd.true else 0.0
            else:
                low, high = _branches(one)
                failing = self._probabilities[one.var]
                found[one] = (1 - failing) * found[low] + failing * found[high]
        return found

    def _level(self, node: _Node) -> int:
        return len(self._bdd.vars) if node.var is None else int(self._bdd.level_of_var(node.var))

    def _may_fail(self, component: str) -> bool:
        return self._probabilities.get(component, 0.0) > 0

    def _holds(self, region: Region) -> bool:
        return region.holds(self._measured.get(region.measure))

    def _node(self, item: Cause | ElementRef | Gate) -> _Node:
        if isinstance(item, ElementRef):
            return self.of(item)
        if isinstance(item, Region):
            return self._bdd.true if self._holds(item) else self._bdd.false
        if isinstance(item, Gate):
            return self._gate(item)
        if not self._may_fail(item):
            return self._bdd.false
        if item not in self._bdd.vars:
            self._bdd.declare(item)
        return self._bdd.var(item)

    def _gate(self, gate: Gate) -> _Node:
        is_any = gate.combination is Combination.ANY
        nodes = [self._node(part) for part in gate.inputs]
        result = self._bdd.false if is_any else self._bdd.true
        for node in reversed(nodes):  # the last variables are the lowest: small diagrams are put on top of one another
            result = (result | node) if is_any else (result & node)
        return result


def _branches(node: _Node) -> tuple[_Node, _Node]:
    """What a node is when its variable is false, and when it is true."""
    return (~node.low, ~node.high) if node.negated else (node.low, node.high)


def _nodes_below(node: _Node) -> set[_Node]:
    found, waiting = {node}, [node]
    while waiting:
        one = waiting.pop()
        if one.var is not None:
            for branch in _branches(one):
                if branch not in found:
                    found.add(branch)
                    waiting.append(branch)
    return found


@contextmanager
def _deep_recursion(variables: int) -> Iterator[None]:
    """``dd`` goes down the variables by recursion."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, 1_000 + 10 * variables))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)
