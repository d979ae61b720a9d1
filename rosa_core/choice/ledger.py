"""Estimations as whole numbers, so that sums of them are exact and ties are ties.

An estimation of 0.1 means the decimal number 0.1, not the binary fraction nearest to it: 0.1 and 0.2 make 0.3, and
satisfy ``<= 0.3``. Each measure is counted in the largest unit in which all its numbers are whole.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal

from rosa_core.choice.alternatives import Alternatives
from rosa_core.model.elements import ConstraintOperator, ElementKind, ElementRef, EstimationType
from rosa_core.model.utility import Utility


@dataclass(frozen=True, slots=True)
class Entry:
    """An estimation of a measure (by number): what it adds, or, if absolute, what it replaces the sum by."""

    measure: int
    value: int
    absolute: bool
    order: int


@dataclass(frozen=True, slots=True)
class WholeLimit:
    """``sign * value <= most`` must hold for the value of a measure (by number), in whole units."""

    measure: int
    sign: int
    most: int


def decimal_ratio(number: float) -> tuple[int, int]:
    """Numerator and denominator of the decimal number that a float is written as.

    Example:
        >>> decimal_ratio(0.1), (0.1).as_integer_ratio()
        ((1, 10), (3602879701896397, 36028797018963968))
    """
    return Decimal(repr(float(number))).as_integer_ratio()


class Ledger:
    """The estimations of some alternatives, and a utility, in whole units.

    Attributes:
        measures: the names of all measures that are estimated, limited or weighted.
        entries: the estimations of each causer.
        weights: what one unit of each measure is worth, in units of utility.
        limits: the limits of the utility.
    """

    def __init__(self, alternatives: Alternatives, utility: Utility) -> None:
        named = dict.fromkeys(e.measure for e in alternatives.estimations)
        self.measures = tuple({**named, **dict.fromkeys(utility.measures)})
        number = {name: index for index, name in enumerate(self.measures)}
        ratios = [decimal_ratio(e.value) for e in alternatives.estimations]
        limited = [decimal_ratio(limit.value) for limit in utility.limits]
        self._scales = [1] * len(self.measures)
        subjects = [*(e.measure for e in alternatives.estimations), *(limit.measure for limit in utility.limits)]
        for measure, (_, denominator) in zip(subjects, (*ratios, *limited), strict=True):
            index = number[measure]
            self._scales[index] = math.lcm(self._scales[index], denominator)
        self.entries: dict[ElementRef, list[Entry]] = {}
        for order, (estimation, (numerator, denominator)) in enumerate(
            zip(alternatives.estimations, ratios, strict=True)
        ):
            index = number[estimation.measure]
            value = numerator * (self._scales[index] // denominator)
            if estimation.type is EstimationType.NEGATIVE:
                value = -value
            entry = Entry(index, value, estimation.type is EstimationType.ABSOLUTE, order)
            self.entries.setdefault(estimation.causer, []).append(entry)
        self._weigh(utility, number)
        self.limits = tuple(
            _whole_limit(number[limit.measure], limit.operator, n * (self._scales[number[limit.measure]] // d))
            for limit, (n, d) in zip(utility.limits, limited, strict=True)
        )

    def _weigh(self, utility: Utility, number: Mapping[str, int]) -> None:
        ratios = {number[measure]: decimal_ratio(weight) for measure, weight in utility.weights.items()}
        unit = math.lcm(*(denominator * self._scales[index] for index, (_, denominator) in ratios.items()))
        self._unit = unit
        self.weights = [0] * len(self.measures)
        for index, (numerator, denominator) in ratios.items():
            self.weights[index] = numerator * (unit // (denominator * self._scales[index]))

    @property
    def decisive(self) -> list[int]:
        """The measures (by number) that the utility or a limit looks at."""
        limited = {limit.measure for limit in self.limits}
        return [index for index, weight in enumerate(self.weights) if weight or index in limited]

    def totals(self, causers: Iterable[ElementRef]) -> list[int]:
        """The estimate of every measure: the sum, or the absolute estimation that was declared last, if any."""
        sums = [0] * len(self.measures)
        replaced: dict[int, Entry] = {}
        for causer in causers:
            for entry in self.entries.get(causer, ()):
                if not entry.absolute:
                    sums[entry.measure] += entry.value
                elif entry.measure not in replaced or replaced[entry.measure].order < entry.order:
                    replaced[entry.measure] = entry
        for index, entry in replaced.items():
            sums[index] = entry.value
        return sums

    def estimates(self, totals: list[int]) -> dict[str, float]:
        """Totals by name of measure, in its own unit."""
        values = map(_quotient, totals, self._scales)
        return dict(zip(self.measures, values, strict=True))

    def utility(self, totals: list[int]) -> float:
        """The sum of weight times estimate."""
        return _quotient(sum(map(int.__mul__, self.weights, totals)), self._unit)


def chosen_causers(
    alternatives: Alternatives, designs: Mapping[str, str], configurations: Mapping[str, str]
) -> list[ElementRef]:
    """What is in a complete configuration: designs, their components once each, and the configurations of these.

    Args:
        alternatives: what could be chosen, for the components of each design.
        designs: the name of the chosen design by function.
        configurations: the name of the chosen configuration by component.

    Returns:
        references in the order designs with their components, then configurations; none twice.
    """
    chosen: dict[ElementRef, None] = {}
    for function, name in designs.items():
        design = next(option for option in alternatives.functions[function] if option.name == name)
        chosen[ElementRef(ElementKind.FUNCTION_DESIGN, name)] = None
        for component in design.components:
            chosen[ElementRef(ElementKind.COMPONENT, component)] = None
    for configuration in configurations.values():
        chosen[ElementRef(ElementKind.COMPONENT_CONFIGURATION, configuration)] = None
    return list(chosen)


def _quotient(numerator: int, denominator: int) -> float:
    try:
        return numerator / denominator
    except OverflowError:
        return math.inf if numerator > 0 else -math.inf


def _whole_limit(measure: int, operator: ConstraintOperator, value: int) -> WholeLimit:
    """Among whole numbers ``x < 3`` is ``x <= 2``."""
    if operator is ConstraintOperator.LESS_OR_EQUAL:
        return WholeLimit(measure, 1, value)
    if operator is ConstraintOperator.LESS:
        return WholeLimit(measure, 1, value - 1)
    return WholeLimit(measure, -1, -value if operator is ConstraintOperator.GREATER_OR_EQUAL else -value - 1)
