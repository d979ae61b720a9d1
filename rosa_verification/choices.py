"""What is never chosen, and what is chosen back and forth: questions to the planner's order of preference.

Among what is selectable the planner takes the lowest priority number, none comes last, and ties go by declaration
(:class:`~rosa_core.mape.ConfigurationPlanner`). More failures never make anything feasible. So to see whether a design
is ever chosen it is enough to look at the situations in which all components that it does not use have failed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import TypeVar

from rosa_core.model.elements import ComponentConfiguration, ElementKind, ElementRef, FunctionDesign
from rosa_verification.causes import Region
from rosa_verification.cut_sets import CutSets
from rosa_verification.gaps import contradicting
from rosa_verification.situations import (
    Feasibility,
    SituationView,
    all_values,
    count_values,
    limits_below,
    smallest_regions,
)
from rosa_verification.structure import Structure

_MOST_SITUATIONS = 20_000
"""For one element; with more the answer is left open."""


@dataclass(frozen=True, slots=True)
class NeverSelected:
    """An element that no situation makes the planner select, or a task layer request.

    Args:
        element: a function design, component configuration, action, function or component.
        reason: why not, in words.
        winners: what is always preferred to it, if that is the reason.
        has_estimations: it, or what it uses, is expected to affect measures: a preference or utility may select it.
        is_unused: nothing asks for it: no action requires the function, no design uses the component.
    """

    element: ElementRef
    reason: str
    winners: tuple[str, ...] = ()
    has_estimations: bool = False
    is_unused: bool = False

    @property
    def is_defect(self) -> bool:
        """Whether it cannot be meant so: a robot may have parts that nothing uses yet, and choose by preferences."""
        return not self.is_unused and not self.has_estimations

    def __str__(self) -> str:
        unless = " (by priorities; a preference may select it)" if self.has_estimations else ""
        return f"{self.element}: {self.reason}{unless}"

    def document(self) -> dict[str, object]:
        """The finding as JSON has it."""
        return {
            "kind": self.element.kind,
            "name": self.element.name,
            "reason": self.reason,
            "winners": list(self.winners),
            "unless_preferred": self.has_estimations,
            "unused": self.is_unused,
            "text": str(self),
        }


@dataclass(frozen=True, slots=True)
class Flapping:
    """A choice that changes back and forth while a measure varies around a limit: the model has no hysteresis.

    Args:
        element: the function or component that is chosen for.
        measure: which one varies.
        limit: around which value, in the measure's unit.
        low: what is selected on the lower side.
        high: what is selected on the upper side.
        always_improve: it happens since the element always improves; else since neither is feasible on both sides.
    """

    element: ElementRef
    measure: str
    limit: float
    low: str
    high: str
    always_improve: bool

    def __str__(self) -> str:
        cause = "always_improve" if self.always_improve else "neither is feasible on both sides"
        change = f"changes between '{self.low}' and '{self.high}'"
        return f"{self.measure} around {self.limit:g}: {self.element} {change} ({cause})"

    def document(self) -> dict[str, object]:
        """The finding as JSON has it."""
        return {
            "kind": self.element.kind,
            "name": self.element.name,
            "measure": self.measure,
            "limit": self.limit,
            "low": self.low,
            "high": self.high,
            "always_improve": self.always_improve,
            "text": str(self),
        }


class Choices:
    """The planner's choices in all situations of a model.

    Args:
        structure: of the model.
        cut_sets: of the same.
    """

    def __init__(self, structure: Structure, cut_sets: CutSets) -> None:
        self._structure = structure
        self._cut_sets = cut_sets
        model = structure.model
        self._designs = _ranked(model.function_designs, lambda design: design.function)
        self._configurations = _ranked(model.component_configurations, lambda configuration: configuration.component)
        self._design = {design.name: design for design in model.function_designs}
        self._required = frozenset(f for requirement in model.requirements for f in requirement.functions)
        self._estimated = frozenset(estimation.causer for estimation in model.estimations)
        self._feasibility = Feasibility(structure)
        self._winners: dict[ElementRef, dict[str, None]] = {}
        self.undecided: dict[ElementRef, None] = {}
        """What has too many situations for all of them to be looked at."""

    @cached_property
    def _selected(self) -> tuple[dict[str, bool], frozenset[str]]:
        """Of each design whether it is ever selected, and the configurations that are."""
        selected: dict[str, bool] = {}
        configurations: set[str] = set()
        for function in self._designs:
            for design in self._designs[function] if function in self._required else ():
                selected[design.name], found = self._selected_with(design)
                configurations |= found
        return selected, frozenset(configurations)

    def never_selected(self) -> list[NeverSelected]:
        """Everything that is never selected or required, by kind, in order of declaration."""
        used = {c for design, is_selected in self._selected[0].items() if is_selected for c in self._parts(design)}
        model = self._structure.model
        found = [self._never_feasible(ElementRef(ElementKind.ACTION, name)) for name in model.names[ElementKind.ACTION]]
        for name in model.names[ElementKind.FUNCTION]:
            if name not in self._required:
                found.append(
                    NeverSelected(ElementRef(ElementKind.FUNCTION, name), "no action requires it", is_unused=True)
                )
        found += [self._never(design) for design in model.function_designs if not self._selected[0].get(design.name)]
        in_design = {name for design in model.function_designs for name in design.components}
        for name in model.names[ElementKind.COMPONENT]:
            if name not in used:
                reason = "no design that is ever selected uses it" if name in in_design else "no design uses it"
                found.append(NeverSelected(ElementRef(ElementKind.COMPONENT, name), reason, is_unused=True))
        configurations = model.component_configurations
        found += [self._never_configured(k, used) for k in configurations if k.name not in self._selected[1]]
        return [one for one in found if one is not None]

    def flapping(self) -> list[Flapping]:
        """Every choice that flaps; those of functions first, by declaration, then by measure and limit."""
        model = self._structure.model
        functions = {function.name: function.always_improve for function in model.functions}
        components = {component.name: component.always_improve for component in model.components}
        found: dict[Flapping, None] = {}
        for function, designs in self._designs.items():
            if function in self._required:
                found.update(dict.fromkeys(self._flapping_designs(function, designs, functions[function])))
        for function, designs in self._designs.items():
            for design in designs if function in self._required else ():
                for component in design.components:
                    # What the planner chooses a design for, it configures anew, even if it chooses the same one again.
                    improves = functions[function] or components[component]
                    found.update(dict.fromkeys(self._flapping_configurations(design, component, improves)))
        return list(found)

    # -- selecting --

    def _parts(self, design: str) -> tuple[str, ...]:
        return self._design[design].components

    def _better(self, design: FunctionDesign) -> list[ElementRef]:
        """The designs that come before one and use no other components than it does."""
        parts = frozenset(design.components)
        ranked = self._designs[design.function]
        before = ranked[: ranked.index(design)]
        return [_design(other.name) for other in before if parts.issuperset(other.components)]

    def _selected_with(self, design: FunctionDesign) -> tuple[bool, set[str]]:
        """Whether a design is ever selected, and the configurations that are then; all, if it cannot be decided."""
        ref, better = _design(design.name), self._better(design)
        limits = limits_below(self._structure, [ref, *better])
        if count_values(limits) > _MOST_SITUATIONS:
            self.undecided[ref] = None
            return True, {k.name for c in design.components for k in self._configurations.get(c, ())}
        found: set[str] = set()
        is_selected = False
        for values in all_values(limits):
            view = SituationView(self._feasibility, values)
            if not view.is_feasible(ref):
                continue
            winner = next(filter(view.is_feasible, better), None)
            if winner is not None:
                self._winners.setdefault(ref, {})[winner.name] = None
                continue
            is_selected = True
            for component in design.components:
                found |= self._configured(view, component)
        return is_selected, found

    def _configured(self, view: SituationView, component: str) -> set[str]:
        """The configuration that is the best one for a component, if any is feasible."""
        refs = (_configuration(option.name) for option in self._configurations.get(component, ()))
        feasible = list(filter(view.is_feasible, refs))
        for ref in feasible[1:]:
            self._winners.setdefault(ref, {})[feasible[0].name] = None
        return {ref.name for ref in feasible[:1]}

    # -- why not --

    def _never_feasible(self, element: ElementRef) -> NeverSelected | None:
        if self._cut_sets.of(element).sets == ((),):
            return NeverSelected(element, "it is never feasible: what it needs has no design")
        if measures := contradicting(self._cut_sets, element):
            return NeverSelected(
                element, f"constraints contradict each other at any value of {' and '.join(measures[0])}"
            )
        return None

    def _never(self, design: FunctionDesign) -> NeverSelected | None:
        ref = _design(design.name)
        estimates = any(map(self._estimates, design.components)) or ref in self._estimated
        if design.function not in self._required:
            return NeverSelected(ref, f"no action requires function '{design.function}'", is_unused=True)
        if (unfeasible := self._never_feasible(ref)) is not None:
            return unfeasible
        winners = tuple(self._winners.get(ref, ()))
        return NeverSelected(ref, f"{_quoted(winners)} always wins", winners, estimates)

    def _never_configured(self, configuration: ComponentConfiguration, used: set[str]) -> NeverSelected | None:
        ref = _configuration(configuration.name)
        if configuration.component not in used:
            return NeverSelected(ref, f"component '{configuration.component}' is never used", is_unused=True)
        if (unfeasible := self._never_feasible(ref)) is not None:
            return unfeasible
        winners = tuple(self._winners.get(ref, ()))
        if not winners:
            return NeverSelected(
                ref, f"where it is feasible, no design that uses '{configuration.component}' is selected"
            )
        return NeverSelected(ref, f"{_quoted(winners)} always wins", winners, ref in self._estimated)

    def _estimates(self, component: str) -> bool:
        refs = [ElementRef(ElementKind.COMPONENT, component)]
        refs += (_configuration(k.name) for k in self._configurations.get(component, ()))
        return not self._estimated.isdisjoint(refs)

    # -- flapping --

    def _flapping_designs(self, function: str, designs: list[FunctionDesign], improves: bool) -> Iterator[Flapping]:
        for pair in combinations(designs, 2):
            working = frozenset(component for design in pair for component in design.components)
            options = [(_design(o.name), _rank(o)) for o in designs if working.issuperset(o.components)]
            element = ElementRef(ElementKind.FUNCTION, function)
            among = _Among(tuple(options), improves)
            for found in self._around(element, [ref for ref, _ in options], among):
                if {found.low, found.high} == {design.name for design in pair}:
                    yield found

    def _flapping_configurations(self, design: FunctionDesign, component: str, improves: bool) -> Iterator[Flapping]:
        configurations = self._configurations.get(component, [])
        if len(configurations) < 2:
            return
        better = self._better(design)
        options = [(_configuration(k.name), _rank(k)) for k in configurations]
        among = _Among(tuple(options), improves, _design(design.name), tuple(better))
        element = ElementRef(ElementKind.COMPONENT, component)
        refs = [_design(design.name), *better]
        yield from self._around(element, refs, among)

    def _around(self, element: ElementRef, cone: Iterable[ElementRef], among: _Among) -> Iterator[Flapping]:
        """Where two neighbouring regions of a measure make the choice change for ever."""
        limits = limits_below(self._structure, cone)
        if count_values(limits) > _MOST_SITUATIONS:
            self.undecided[element] = None
            return
        for measure in limits:
            others = {name: found for name, found in limits.items() if name != measure}
            regions = smallest_regions(measure, limits[measure])
            for values in all_values(others):
                views = (SituationView(self._feasibility, {**values, measure: region}) for region in regions)
                feasible = [among.feasible(view) for view in views]
                for n in range(len(regions) - 1):
                    names = among.alternation(feasible[n], feasible[n + 1])
                    if names is not None:
                        yield Flapping(element, measure, _between(*regions[n : n + 2]), *names, among.improves)


@dataclass(frozen=True, slots=True)
class _Among:
    """A choice among options, best first, with their ranks; made only where ``needed`` is feasible and nothing of
    ``better`` is. What is chosen stays while it is feasible, unless the choice ``improves``."""

    options: tuple[tuple[ElementRef, float], ...]
    improves: bool
    needed: ElementRef | None = None
    better: tuple[ElementRef, ...] = ()

    def feasible(self, view: SituationView) -> tuple[tuple[ElementRef, float], ...]:
        """The options that there are in a situation, best first; none where nothing is chosen."""
        if self.needed is not None and not view.is_feasible(self.needed):
            return ()
        if any(map(view.is_feasible, self.better)):
            return ()
        return tuple(option for option in self.options if view.is_feasible(option[0]))

    def alternation(
        self, low: tuple[tuple[ElementRef, float], ...], high: tuple[tuple[ElementRef, float], ...]
    ) -> tuple[str, str] | None:
        """What is chosen in two situations that alternate, by what is feasible in each, if it is not the same."""
        if not low or not high or low == high:
            return None
        below = above = low[0][0]
        for _ in range(2):  # the first time back and forth may depend on where it began
            above = self._chosen(high, below)
            below = self._chosen(low, above)
        above = self._chosen(high, below)
        return None if below == above else (below.name, above.name)

    def _chosen(self, feasible: tuple[tuple[ElementRef, float], ...], current: ElementRef) -> ElementRef:
        if not self.improves and any(ref == current for ref, _ in feasible):
            return current
        return min(feasible, key=lambda option: (option[1], option[0] != current))[0]


_Option = TypeVar("_Option", FunctionDesign, ComponentConfiguration)


def _ranked(options: Iterable[_Option], owner: Callable[[_Option], str]) -> dict[str, list[_Option]]:
    """The options of each owner, best first."""
    ranked: dict[str, list[_Option]] = {}
    for option in options:
        ranked.setdefault(owner(option), []).append(option)
    for several in ranked.values():
        several.sort(key=_rank)
    return ranked


def _rank(option: FunctionDesign | ComponentConfiguration) -> float:
    return math.inf if option.priority is None else option.priority


def _design(name: str) -> ElementRef:
    return ElementRef(ElementKind.FUNCTION_DESIGN, name)


def _configuration(name: str) -> ElementRef:
    return ElementRef(ElementKind.COMPONENT_CONFIGURATION, name)


def _between(region: Region, next_region: Region) -> float:
    return region.high[0] if region.below is not None else next_region.low[0]


def _quoted(names: tuple[str, ...]) -> str:
    return " or ".join(f"'{name}'" for name in names)
