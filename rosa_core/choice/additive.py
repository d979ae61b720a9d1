"""The choice of a configuration as a problem in which everything adds up.

Absolute estimations do not add up, so that the choice is split into *cases*: for each measure that matters, either no
absolute estimation is chosen, or a certain one is the last that is. Every complete configuration belongs to exactly
one case, and within a case each measure is a sum or a constant.

The whole order of configurations is in one number, the score (more is better). From its largest to its smallest part:
utility; less the sum of the designs' priority ranks; less that of the configurations'; less the place in the order of
declaration. No two configurations have the same score.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from rosa_core.choice.alternatives import Alternatives, ConfigurationOption, DesignOption
from rosa_core.choice.ledger import Entry, Ledger
from rosa_core.model.elements import ElementKind, ElementRef


@dataclass(frozen=True, slots=True)
class Choice:
    """Something to choose: what it adds to the score and to each limited quantity.

    For a design, ``parts`` is the set of the problem's components in it, as bits; components that no decision depends
    on are part of the design's own numbers.
    """

    name: str
    score: int
    usage: tuple[int, ...]
    parts: int = 0


@dataclass(frozen=True, slots=True)
class AdditiveProblem:
    """Choose one design for each function, and one option for each component that is in a chosen design.

    The usages of all that is chosen must not be above ``limits``, and the components of ``required`` (bits) must be
    in a chosen design. ``components`` gives the options of each component that a decision depends on; a component
    without configurations has one nameless option. ``settled`` names the configuration of each component that can have
    only one.
    """

    functions: tuple[tuple[Choice, ...], ...]
    components: tuple[tuple[Choice, ...], ...]
    limits: tuple[int, ...]
    constant: int
    required: int
    settled: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class _Case:
    """``deciding`` gives for each measure of the case the absolute estimation that counts; None: there is none."""

    deciding: Mapping[int, tuple[ElementRef, Entry] | None]
    forbidden: frozenset[ElementRef]
    required: frozenset[ElementRef]


def _design(name: str) -> ElementRef:
    return ElementRef(ElementKind.FUNCTION_DESIGN, name)


def _component(name: str) -> ElementRef:
    return ElementRef(ElementKind.COMPONENT, name)


def _configuration(name: str) -> ElementRef:
    return ElementRef(ElementKind.COMPONENT_CONFIGURATION, name)


def _ranks(options: tuple[DesignOption | ConfigurationOption, ...]) -> dict[str, int]:
    """0 for the best priority among the options, 1 for the next, and so on; equal priorities have equal ranks."""
    numbers = sorted({option.priority for option in options if option.priority is not None})
    place = {number: rank for rank, number in enumerate(numbers)}
    return {o.name: len(numbers) if o.priority is None else place[o.priority] for o in options}


class _Order:
    """The parts of the score below utility: priorities, then declaration."""

    def __init__(self, alternatives: Alternatives) -> None:
        self.below: dict[ElementRef, int] = {}
        """What choosing a design or configuration costs."""
        places = 1
        groups: list[tuple[DesignOption | ConfigurationOption, ...]] = [
            *alternatives.functions.values(),
            *alternatives.components.values(),
        ]
        positions: list[int] = []
        for options in reversed(groups):
            positions.append(places)
            places *= max(1, len(options))
        positions.reverse()
        ranks = [_ranks(options) for options in groups]
        split = len(alternatives.functions)
        worst = [max(rank.values(), default=0) for rank in ranks]
        for_design = places * (1 + sum(worst[split:]))
        for index, (options, rank) in enumerate(zip(groups, ranks, strict=True)):
            step, ref = (for_design, _design) if index < split else (places, _configuration)
            for place, option in enumerate(options):
                self.below[ref(option.name)] = rank[option.name] * step + place * positions[index]
        self.per_utility = for_design * (1 + sum(worst[:split]))


def cases(alternatives: Alternatives, ledger: Ledger) -> Iterator[AdditiveProblem]:
    """The additive problems that the choice consists of; one, unless there are absolute estimations.

    Args:
        alternatives: what can be chosen; a function without any design makes the choice empty.
        ledger: the same alternatives' estimations in whole units, with the utility to maximise.

    Returns:
        one problem for each way to say which absolute estimations count; the best of their solutions is the best
        choice.
    """
    if not all(alternatives.functions.values()):
        return
    order = _Order(alternatives)
    for case in _absolute_cases(ledger, _possible_causers(alternatives)):
        problem = _CaseBuilder(alternatives, ledger, order, case).build()
        if problem is not None:
            yield problem


def _possible_causers(alternatives: Alternatives) -> set[ElementRef]:
    """What can be chosen: estimations may also be of options that were left out because others are kept."""
    designs = [option for options in alternatives.functions.values() for option in options]
    return {
        *(_design(design.name) for design in designs),
        *(_component(component) for design in designs for component in design.components),
        *(_configuration(option.name) for options in alternatives.components.values() for option in options),
    }


def _absolute_cases(ledger: Ledger, possible: set[ElementRef]) -> Iterator[_Case]:
    decisive = ledger.decisive
    absolutes: dict[int, list[tuple[ElementRef, Entry]]] = {}
    for causer, entries in ledger.entries.items():
        for entry in entries:
            if entry.absolute and entry.measure in decisive and causer in possible:
                absolutes.setdefault(entry.measure, []).append((causer, entry))
    for deciding in product(*([None, *found] for found in absolutes.values())):
        forbidden: set[ElementRef] = set()
        for last, found in zip(deciding, absolutes.values(), strict=True):
            forbidden.update(causer for causer, entry in found if last is None or entry.order > last[1].order)
        required = frozenset(last[0] for last in deciding if last is not None)
        if not required & forbidden:
            yield _Case(dict(zip(absolutes, deciding, strict=True)), frozenset(forbidden), required)


class _CaseBuilder:
    """Puts one case together as an additive problem."""

    def __init__(self, alternatives: Alternatives, ledger: Ledger, order: _Order, case: _Case) -> None:
        self._alternatives = alternatives
        self._ledger = ledger
        self._order = order
        self._case = case
        self._nothing = (0,) * len(ledger.limits)

    def build(self) -> AdditiveProblem | None:
        """The problem, or None if the case cannot occur."""
        options = {
            component: self._options(component)
            for component in dict.fromkeys(
                name for designs in self._alternatives.functions.values() for d in designs for name in d.components
            )
        }
        designs = [
            [design for design in choices if self._may_choose(design, options, choices)]
            for choices in self._alternatives.functions.values()
        ]
        if any(len(self._demanded(choices)) > 1 for choices in self._alternatives.functions.values()):
            return None
        required = self._required_components()
        tracked = self._tracked(designs, options, required)
        if not all(designs) or not required <= tracked.keys():
            return None
        constant, limits = self._constants()
        return AdditiveProblem(
            tuple(tuple(self._choice(d, options, tracked) for d in choices) for choices in designs),
            tuple(options[name] for name in tracked),
            limits,
            constant,
            sum(1 << tracked[name] for name in required),
            {name: found[0].name for name, found in options.items() if len(found) == 1 and found[0].name},
        )

    def _options(self, component: str) -> tuple[Choice, ...]:
        """What the component can add, one option per configuration that this case allows."""
        if _component(component) in self._case.forbidden:
            return ()
        own = self._numbers(_component(component))
        configurations = self._alternatives.components.get(component, ())
        if not configurations:
            return (Choice("", *own),)
        refs = [_configuration(option.name) for option in configurations]
        demanded = [ref for ref in refs if ref in self._case.required]
        if len(demanded) > 1:
            return ()
        allowed = demanded or [ref for ref in refs if ref not in self._case.forbidden]
        return tuple(Choice(ref.name, *_sum(own, self._numbers(ref))) for ref in allowed)

    def _may_choose(
        self, design: DesignOption, options: Mapping[str, tuple[Choice, ...]], choices: tuple[DesignOption, ...]
    ) -> bool:
        ref = _design(design.name)
        if ref in self._case.forbidden or not all(options[component] for component in design.components):
            return False
        return ref in self._case.required or not self._demanded(choices)

    def _demanded(self, choices: tuple[DesignOption, ...]) -> list[DesignOption]:
        return [design for design in choices if _design(design.name) in self._case.required]

    def _required_components(self) -> set[str]:
        required = {ref.name for ref in self._case.required if ref.kind is ElementKind.COMPONENT}
        for component, configurations in self._alternatives.components.items():
            if any(_configuration(option.name) in self._case.required for option in configurations):
                required.add(component)
        return required

    def _tracked(
        self, designs: list[list[DesignOption]], options: Mapping[str, tuple[Choice, ...]], required: set[str]
    ) -> dict[str, int]:
        """The components that a decision depends on, numbered in order of declaration of those with configurations."""
        users: Counter[str] = Counter()
        for choices in designs:
            users.update({name for design in choices for name in design.components})
        tracked = [name for name in users if users[name] > 1 or len(options[name]) > 1 or name in required]
        position = {name: index for index, name in enumerate(self._alternatives.components)}
        tracked.sort(key=lambda name: position.get(name, len(position)))
        return {name: number for number, name in enumerate(tracked)}

    def _choice(
        self, design: DesignOption, options: Mapping[str, tuple[Choice, ...]], tracked: Mapping[str, int]
    ) -> Choice:
        numbers = self._numbers(_design(design.name))
        parts = 0
        for component in design.components:
            if component in tracked:
                parts |= 1 << tracked[component]
            else:
                (only,) = options[component]
                numbers = _sum(numbers, (only.score, only.usage))
        return Choice(design.name, *numbers, parts)

    def _numbers(self, causer: ElementRef) -> tuple[int, tuple[int, ...]]:
        """What choosing the causer adds to the score and to the limited quantities."""
        score = -self._order.below.get(causer, 0)
        ledger, deciding = self._ledger, self._case.deciding
        added: dict[int, int] = {}
        for entry in ledger.entries.get(causer, ()):
            if not entry.absolute and deciding.get(entry.measure) is None:
                added[entry.measure] = added.get(entry.measure, 0) + entry.value
        if not added:
            return score, self._nothing
        score += self._order.per_utility * sum(ledger.weights[index] * value for index, value in added.items())
        return score, tuple(limit.sign * added.get(limit.measure, 0) for limit in ledger.limits)

    def _constants(self) -> tuple[int, tuple[int, ...]]:
        """What the absolute estimations give: a part of the score, and what is left of the limits."""
        ledger = self._ledger
        value = {measure: last[1].value for measure, last in self._case.deciding.items() if last is not None}
        utility = sum(ledger.weights[measure] * number for measure, number in value.items())
        limits = tuple(limit.most - limit.sign * value.get(limit.measure, 0) for limit in ledger.limits)
        return self._order.per_utility * utility, limits


def _sum(one: tuple[int, tuple[int, ...]], other: tuple[int, tuple[int, ...]]) -> tuple[int, tuple[int, ...]]:
    if not one[1]:
        return one[0] + other[0], one[1]
    return one[0] + other[0], tuple(map(int.__add__, one[1], other[1]))
