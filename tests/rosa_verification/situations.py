"""All situations of a small model, tried out one by one in a real knowledge base: what the findings are held to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise, product

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock, Situation
from rosa_core.inference.rules import is_selectable
from rosa_core.model.elements import ElementKind, ElementRef
from rosa_verification.causes import GREATEST, LEAST, Cause, Region

KINDS = [kind for kind in ElementKind if kind not in (ElementKind.MEASURE, ElementKind.CONSTRAINT)]


def values_of(model: KnowledgeModel) -> dict[str, list[float]]:
    """For each measure a value below, at, between and above its limits, in order."""
    values: dict[str, list[float]] = {}
    for measure in model.names[ElementKind.MEASURE]:
        limits = sorted({c.value for c in model.constraints if c.measure == measure and c.value is not None})
        if limits:
            between = [value for low, high in pairwise(limits) for value in (low, (low + high) / 2)]
            values[measure] = [limits[0] - 1, *between, limits[-1], limits[-1] + 1]
    return values


def situations_of(model: KnowledgeModel, *, unmeasured: bool = True) -> list[Situation]:
    """Every combination of failed components and values."""
    components = model.names[ElementKind.COMPONENT]
    values = values_of(model)
    measured = [[*([None] if unmeasured else []), *choices] for choices in values.values()]
    return [
        Situation({m: v for m, v in zip(values, chosen, strict=True) if v is not None}, failed)
        for size in range(len(components) + 1)
        for failed in combinations(components, size)
        for chosen in product(*measured)
    ]


@dataclass(frozen=True)
class Tried:
    """Which situations make which element unfeasible: one bit each."""

    model: KnowledgeModel
    situations: list[Situation]
    unfeasible: dict[ElementRef, int]

    @property
    def everything(self) -> int:
        return (1 << len(self.situations)) - 1

    def failed(self, component: str) -> int:
        return sum(1 << i for i, s in enumerate(self.situations) if component in s.failed_components)

    def within(self, region: Region) -> int:
        def lies(value: float | None) -> bool:
            return value is not None and region.low < (value, 1) and (value, 0) < region.high

        return sum(1 << i for i, s in enumerate(self.situations) if lies(s.measurements.get(region.measure)))


def tried(model: KnowledgeModel, *, unmeasured: bool = True) -> Tried:
    """Suppose every situation, and take down what is not selectable in it."""
    kb = KnowledgeBase(model, clock=SimulationClock())
    situations = situations_of(model, unmeasured=unmeasured)
    unfeasible = {ElementRef(kind, name): 0 for kind in KINDS for name in model.names[kind]}
    for index, situation in enumerate(situations):
        with kb.supposing(situation):
            for kind in KINDS:
                for name, status in kb.statuses(kind).items():
                    if not is_selectable(status):
                        unfeasible[ElementRef(kind, name)] |= 1 << index
    return Tried(model, situations, unfeasible)


def regions_of(measure: str, limits: list[float]) -> list[Region]:
    """Every region between two positions next to limits."""
    positions = [LEAST, *((limit, side) for limit in limits for side in (0, 1)), GREATEST]
    return [Region(measure, low, high) for low, high in combinations(positions, 2)]


def all_regions(model: KnowledgeModel) -> dict[str, list[Region]]:
    """For each measure with limits every region that they mark off."""
    found: dict[str, list[Region]] = {}
    for measure in values_of(model):
        limits = sorted({c.value for c in model.constraints if c.measure == measure and c.value is not None})
        found[measure] = regions_of(measure, limits)
    return found


def candidates(model: KnowledgeModel, order: int, regions: dict[str, list[Region]]) -> Iterator[frozenset[Cause]]:
    """Every consistent set of so many causes, smaller ones first."""
    components = model.names[ElementKind.COMPONENT]
    for size in range(order + 1):
        for measured in range(min(size, len(regions)) + 1):
            for measures in combinations(regions, measured):
                for chosen in product(*(regions[m] for m in measures)):
                    for failed in combinations(components, size - measured):
                        yield frozenset((*failed, *chosen))


def weaker(one: frozenset[Cause], other: frozenset[Cause]) -> bool:
    """Whether ``one`` asks for nothing that ``other`` does not ask for."""
    return all(
        any(
            c == o or (isinstance(c, Region) and isinstance(o, Region) and c[0] == o[0] and c.contains(o))
            for o in other
        )
        for c in one
    )


def least(sets: list[frozenset[Cause]]) -> set[frozenset[Cause]]:
    """Those than which no other is weaker."""
    return {one for one in sets if not any(other != one and weaker(other, one) for other in sets)}
