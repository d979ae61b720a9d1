"""What is feasible when measures lie in certain regions."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise, product

from rosa_core.model.elements import ElementRef
from rosa_verification.causes import GREATEST, LEAST, Cause, Region
from rosa_verification.structure import Combination, Gate, Structure

Values = Mapping[str, Region | None]
"""In which region each measure lies; None: it has not been measured. Measures that are absent have not been either."""


class Feasibility:
    """Which elements are feasible by the values of measures while every component that they use works.

    Args:
        structure: of the model.
    """

    def __init__(self, structure: Structure) -> None:
        self._structure = structure
        self._measures: dict[ElementRef, tuple[str, ...]] = {}
        self._known: dict[tuple[ElementRef | Region | None, ...], bool] = {}

    def holds(self, element: ElementRef, values: Values) -> bool:
        """Whether an element is feasible.

        Args:
            element: one of the structure's.
            values: regions in which each constraint on what the element is made of is either violated or not.
        """
        measures = self._measures.get(element)
        if measures is None:
            measures = self._measures[element] = tuple(limits_below(self._structure, [element]))
        key = (element, *(values.get(measure) for measure in measures))
        known = self._known.get(key)
        if known is None:
            known = self._known[key] = not self._is_bad(self._structure.unfeasible(element), values)
        return known

    def _is_bad(self, item: Cause | ElementRef | Gate, values: Values) -> bool:
        if isinstance(item, Gate):
            bad = (self._is_bad(part, values) for part in item.inputs)
            return any(bad) if item.combination is Combination.ANY else all(bad)
        if isinstance(item, ElementRef):
            return not self.holds(item, values)
        if isinstance(item, Region):
            value = values.get(item.measure)
            return value is not None and item.contains(value)
        return False


@dataclass(frozen=True, slots=True)
class SituationView:
    """Which elements are feasible in one situation, as :class:`Feasibility` has it."""

    feasibility: Feasibility
    values: Values

    def is_feasible(self, element: ElementRef) -> bool:
        """Whether an element is feasible while every component that it uses works."""
        return self.feasibility.holds(element, self.values)


def limits_below(structure: Structure, elements: Iterable[ElementRef]) -> dict[str, list[float]]:
    """The limits of each measure that constrains elements or what they are made of, in ascending order.

    Args:
        structure: of the model.
        elements: some of its elements.
    """
    limits: dict[str, set[float]] = {}
    seen: set[ElementRef] = set()
    waiting = list(elements)
    while waiting:
        element = waiting.pop()
        if element in seen:
            continue
        seen.add(element)
        waiting += structure.parts[element]
        for region in structure.violations.get(element, ()):
            ends = (end for end in (region.above, region.below) if end is not None)
            limits.setdefault(region.measure, set()).update(ends)
    return {measure: sorted(found) for measure, found in sorted(limits.items())}


def smallest_regions(measure: str, limits: Iterable[float]) -> list[Region]:
    """The regions into which limits cut the values of a measure, in ascending order; each limit is one.

    >>> [str(region) for region in smallest_regions("m", [1.0])]
    ['m < 1', 'm = 1', 'm > 1']

    Args:
        measure: its name.
        limits: in ascending order.
    """
    positions = [LEAST, *((limit, side) for limit in limits for side in (0, 1)), GREATEST]
    return [Region(measure, low, high) for low, high in pairwise(positions)]


def count_values(limits: Mapping[str, Collection[float]]) -> int:
    """How many combinations of regions :func:`all_values` gives."""
    count = 1
    for found in limits.values():
        count *= 2 * len(found) + 2
    return count


def all_values(limits: Mapping[str, Collection[float]]) -> Iterator[dict[str, Region | None]]:
    """Every combination of the regions of measures, also of those that have not been measured.

    Args:
        limits: of each measure, in ascending order.
    """
    choices = [[None, *smallest_regions(measure, found)] for measure, found in limits.items()]
    for chosen in product(*choices):
        yield dict(zip(limits, chosen, strict=True))
