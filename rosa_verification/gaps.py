"""Gaps: regions of measures in which an action cannot be performed; and constraints that contradict each other."""

from __future__ import annotations

from dataclasses import dataclass

from rosa_core.model.elements import ElementKind, ElementRef
from rosa_verification.causes import Region, region_document
from rosa_verification.cut_sets import CutSets
from rosa_verification.structure import Structure


@dataclass(frozen=True, slots=True)
class Gap:
    """Where measures lie when an action has no configuration although every component works.

    Args:
        action: its name.
        regions: of one measure, or of several that lie so together.
        is_stated: a constraint on the action itself says so; else it follows from those on what the action needs.
    """

    action: str
    regions: tuple[Region, ...]
    is_stated: bool

    def __str__(self) -> str:
        return f"{' and '.join(map(str, self.regions))}: {self.action}"

    def document(self) -> dict[str, object]:
        """The gap as JSON has it."""
        regions = [region_document(region) for region in self.regions]
        return {"action": self.action, "regions": regions, "stated": self.is_stated, "text": str(self)}


@dataclass(frozen=True, slots=True)
class Contradiction:
    """Constraints that no values satisfy together: once the measures are known, the element is unfeasible.

    Args:
        element: the element that they are on, or that depends on all of those that they are on.
        measures: names.
    """

    element: ElementRef
    measures: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.element} is unfeasible at any value of {' and '.join(self.measures)}: constraints contradict"

    def document(self) -> dict[str, object]:
        """The contradiction as JSON has it."""
        return {
            "kind": self.element.kind,
            "name": self.element.name,
            "measures": list(self.measures),
            "text": str(self),
        }


def find_gaps(structure: Structure, cut_sets: CutSets) -> list[Gap]:
    """The gaps of every action, in order of declaration, then smallest first.

    Args:
        structure: of the model.
        cut_sets: of the same; a gap of more measures than their order is not found.
    """
    gaps: list[Gap] = []
    for name in structure.model.names[ElementKind.ACTION]:
        action = ElementRef(ElementKind.ACTION, name)
        stated = structure.violations.get(action, [])
        for causes in cut_sets.of(action).sets:
            regions = tuple(cause for cause in causes if isinstance(cause, Region))
            if regions and len(regions) == len(causes) and not all(region.is_whole for region in regions):
                is_stated = len(regions) == 1 and any(
                    limit.measure == regions[0].measure and limit.contains(regions[0]) for limit in stated
                )
                gaps.append(Gap(name, regions, is_stated))
    return gaps


def find_contradictions(structure: Structure, cut_sets: CutSets) -> list[Contradiction]:
    """Where constraints contradict each other; what merely depends on such an element is not named again.

    Args:
        structure: of the model.
        cut_sets: of the same.
    """
    found: list[Contradiction] = []
    for element in structure.elements():
        below = {measures for part in structure.parts[element] for measures in contradicting(cut_sets, part)}
        own = (measures for measures in contradicting(cut_sets, element) if measures not in below)
        found += (Contradiction(element, measures) for measures in own)
    return found


def contradicting(cut_sets: CutSets, element: ElementRef) -> list[tuple[str, ...]]:
    """For each way in which an element is unfeasible at any values of measures: which measures.

    Args:
        cut_sets: of the model.
        element: one of its elements.
    """
    found = []
    for causes in cut_sets.of(element).sets:
        measures = tuple(cause.measure for cause in causes if isinstance(cause, Region) and cause.is_whole)
        if measures and len(measures) == len(causes):
            found.append(measures)
    return found
