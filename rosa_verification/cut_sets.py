"""Minimal cut sets, which make an element unfeasible, and minimal path sets, which make it possible."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rosa_core.model.elements import ElementRef
from rosa_verification.cause_sets import NEVER, Sets, TooManySetsError, all_of, any_of
from rosa_verification.causes import GREATEST, LEAST, Cause, Region, cause_key, sorted_causes
from rosa_verification.structure import Combination, Gate, Structure

CutSet = tuple[Cause, ...]


@dataclass(frozen=True, slots=True)
class MinimalSets:
    """The minimal sets of an element, smallest first, then by name.

    Args:
        sets: each with its causes by name.
        order: up to so many causes they are complete; None: there are no others.
    """

    sets: tuple[CutSet, ...]
    order: int | None


class CutSets:
    """The minimal cut sets of a model's elements, found when they are asked for. They are exact.

    A cut set is failures of components, and regions of measures, that together make an element unfeasible, whatever
    else holds; none of its causes can be left out, and none of its regions be wider. The empty set is the one of an
    element that is never feasible.

    >>> from rosa_core.model import Action, Component, ElementKind, Function, FunctionalRequirement, FunctionDesign
    >>> from rosa_core import KnowledgeModel
    >>> model = KnowledgeModel(
    ...     actions=(Action("fly"),),
    ...     functions=(Function("lift"),),
    ...     components=(Component("left"), Component("right"), Component("wing")),
    ...     requirements=(FunctionalRequirement("fly", ("lift",)),),
    ...     function_designs=(
    ...         FunctionDesign("rotors", "lift", ("left", "right")),
    ...         FunctionDesign("gliding", "lift", ("wing",)),
    ...     ),
    ... )
    >>> CutSets(Structure(model)).of(ElementRef(ElementKind.ACTION, "fly")).sets
    (('left', 'wing'), ('right', 'wing'))

    Args:
        structure: of the model.
        order: the most causes of a set that is looked for; None finds all.
        limit: if an element has more sets, only those of a lower order are listed.
    """

    def __init__(self, structure: Structure, order: int | None = 3, limit: int = 10_000) -> None:
        self._structure = structure
        self._order = order
        self._limit = limit
        self._known: dict[ElementRef, tuple[Sets, int | None]] = {}

    def of(self, element: ElementRef) -> MinimalSets:
        """The minimal cut sets of an element.

        Args:
            element: one of the structure's.
        """
        sets, order = self.unsorted(element)
        return MinimalSets(in_order(sets), order)

    def unsorted(self, element: ElementRef) -> tuple[Sets, int | None]:
        """The minimal cut sets of an element in no order, and up to how many causes they are complete."""
        known = self._known.get(element)
        if known is None:
            known = self._known[element] = self._found(element)
        return known

    def _found(self, element: ElementRef) -> tuple[Sets, int | None]:
        gate = self._structure.unfeasible(element)
        orders = [order for part in self._structure.parts[element] if (order := self.unsorted(part)[1]) is not None]
        order = min((*orders, *(() if self._order is None else (self._order,))), default=None)
        while True:
            try:
                return _sets_of(gate, lambda part: self.unsorted(part)[0], order, self._limit), order
            except TooManySetsError:
                order = 3 if order is None else order - 1
                if order <= 0:
                    return NEVER, 0


def _sets_of(gate: Gate, of_part: Callable[[ElementRef], Sets], order: int | None, limit: int) -> Sets:
    families: list[Sets] = []
    for item in gate.inputs:
        if isinstance(item, Gate):
            families.append(_sets_of(item, of_part, order, limit))
        elif isinstance(item, ElementRef):
            sets = of_part(item)
            families.append(sets if order is None else frozenset(one for one in sets if len(one) <= order))
        else:
            families.append(frozenset({frozenset({item})}))
    return (any_of if gate.combination is Combination.ANY else all_of)(families, order, limit)


class PathSets:
    """The minimal path sets of a model's elements, found when they are asked for. They are exact.

    A path set is components that work, and regions of measures, with which an element is feasible, whatever else has
    failed or is measured. A name in it is that of a component that works. It takes for granted that everything has been
    measured. The empty set is the one of an element that is always feasible.

    Args:
        structure: of the model.
        limit: of an element with more sets none are listed.
    """

    def __init__(self, structure: Structure, limit: int = 1_000) -> None:
        self._structure = structure
        self._limit = limit
        self._known: dict[ElementRef, Sets | None] = {}

    def of(self, element: ElementRef) -> tuple[CutSet, ...] | None:
        """The minimal path sets of an element, smallest first, then by name; None if there are more than the limit.

        Args:
            element: one of the structure's.
        """
        sets = self._unsorted(element)
        return None if sets is None else in_order(sets)

    def _unsorted(self, element: ElementRef) -> Sets | None:
        if element not in self._known:
            try:
                self._known[element] = self._sets_of(self._structure.unfeasible(element))
            except TooManySetsError:
                self._known[element] = None
        return self._known[element]

    def _sets_of(self, gate: Gate) -> Sets:
        families: list[Sets] = []
        for item in gate.inputs:
            if isinstance(item, Gate):
                families.append(self._sets_of(item))
            elif isinstance(item, ElementRef):
                sets = self._unsorted(item)
                if sets is None:
                    raise TooManySetsError
                families.append(sets)
            else:
                families.append(frozenset({frozenset({_remedied(item)})}))
        # Feasible is the opposite: all inputs of what any makes unfeasible must be good, and one of what all do.
        if gate.combination is Combination.ANY:
            return all_of(families, None, self._limit)
        return any_of(families, None, self._limit, measured=True)


def in_order(sets: Sets) -> tuple[CutSet, ...]:
    """Smallest first, then by name."""
    sorted_sets = (sorted_causes(one) for one in sets)
    return tuple(sorted(sorted_sets, key=lambda one: (len(one), [cause_key(cause) for cause in one])))


def _remedied(cause: Cause) -> Cause:
    if not isinstance(cause, Region):
        return cause
    return (
        Region(cause.measure, LEAST, cause.low) if cause.low != LEAST else Region(cause.measure, cause.high, GREATEST)
    )
