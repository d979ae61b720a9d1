"""The best configuration of an action, and all of them in order: pure functions over frozen alternatives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from rosa_core.choice.additive import cases
from rosa_core.choice.alternatives import Alternatives, CompleteConfiguration
from rosa_core.choice.best_first import search
from rosa_core.choice.ledger import Ledger, chosen_causers
from rosa_core.model.elements import ConstraintOperator
from rosa_core.model.utility import Limit, Utility

_NO_UTILITY = Utility()


def complete_configurations(
    alternatives: Alternatives, utility: Utility | None = None
) -> Iterator[CompleteConfiguration]:
    """Every complete configuration that meets the limits, best first, found one by one as they are asked for.

    Better is, in this order: more utility; a lower sum of the priority ranks of the designs (0 for the lowest number
    among the options of its function, 1 for the next, last those without); a lower sum of those of the configurations;
    the earlier option of the first function in which two differ, then of the first component. The order is exact:
    estimations, weights and limits count as the decimal numbers that they are written as.

    Args:
        alternatives: what there is to choose from.
        utility: weights and limits; by default there are none, and priorities decide.
    """
    return _configurations(alternatives, utility or _NO_UTILITY, only_best=False)


def best_configuration(alternatives: Alternatives, utility: Utility | None = None) -> CompleteConfiguration | None:
    """The first of :func:`complete_configurations`, found faster.

    >>> from rosa_core.choice import Alternatives, DesignOption
    >>> from rosa_core.model import ElementKind, ElementRef, Estimation, Utility
    >>> accurate = Estimation(ElementRef(ElementKind.FUNCTION_DESIGN, "laser"), "accuracy", 2.0)
    >>> options = (DesignOption("camera", ("cam",), priority=1), DesignOption("laser", ("lidar",), priority=2))
    >>> alternatives = Alternatives({"localise": options}, estimations=(accurate,))
    >>> best_configuration(alternatives).function_designs
    {'localise': 'camera'}
    >>> best_configuration(alternatives, Utility({"accuracy": 1.0})).function_designs
    {'localise': 'laser'}

    Args:
        alternatives: what there is to choose from.
        utility: weights and limits; by default priorities decide.

    Returns:
        the best one, or None if nothing meets the limits or a function has no option.
    """
    return next(_configurations(alternatives, utility or _NO_UTILITY, only_best=True), None)


def estimates(
    alternatives: Alternatives, function_designs: Mapping[str, str], component_configurations: Mapping[str, str]
) -> dict[str, float]:
    """The estimated value of each measure for a complete configuration, in the measure's unit.

    It is the sum over the designs, their components (each once, also if designs share it) and the configurations:
    positive estimations add, negative ones subtract. An absolute estimation replaces the sum; of several, the one that
    was declared last counts. What nothing is known about is 0.

    Args:
        alternatives: what was chosen from.
        function_designs: the design chosen for each function.
        component_configurations: the configuration chosen for each component.

    Returns:
        by measure, for every measure that any alternative is expected to affect.
    """
    ledger = Ledger(alternatives, _NO_UTILITY)
    return ledger.estimates(ledger.totals(chosen_causers(alternatives, function_designs, component_configurations)))


def unmet_limits(alternatives: Alternatives, utility: Utility) -> str | None:
    """Why no complete configuration meets the limits.

    Args:
        alternatives: what there is to choose from.
        utility: its limits count, not its weights.

    Returns:
        the limits that cannot be met, in words; None if some configuration meets them all, or if there is none at all.
    """
    if not utility.limits or best_configuration(alternatives, Utility({}, utility.limits)) is not None:
        return None
    if best_configuration(alternatives) is None:
        return None
    alone = [text for limit in utility.limits if (text := _out_of_reach(alternatives, limit))]
    together = " and ".join(map(str, utility.limits))
    return f"no feasible configuration meets {' or '.join(alone) or f'{together} together'}"


def _out_of_reach(alternatives: Alternatives, limit: Limit) -> str | None:
    if best_configuration(alternatives, Utility({}, (limit,))) is not None:
        return None
    at_most = limit.operator in (ConstraintOperator.LESS, ConstraintOperator.LESS_OR_EQUAL)
    nearest = best_configuration(alternatives, Utility({limit.measure: -1.0 if at_most else 1.0}))
    if nearest is None:
        return None
    return f"{limit} (the {'least' if at_most else 'most'} is {nearest.estimates[limit.measure]:g})"


def _configurations(
    alternatives: Alternatives, utility: Utility, *, only_best: bool
) -> Iterator[CompleteConfiguration]:
    ledger = Ledger(alternatives, utility)
    problems = list(cases(alternatives, ledger))
    for found in search(problems, only_best=only_best):
        settled = problems[found.problem].settled
        designs = dict(zip(alternatives.functions, found.designs, strict=True))
        configurations = _named_configurations(alternatives, designs, set(found.configurations), settled)
        totals = ledger.totals(chosen_causers(alternatives, designs, configurations))
        yield CompleteConfiguration(designs, configurations, ledger.estimates(totals), ledger.utility(totals))


def _named_configurations(
    alternatives: Alternatives, designs: Mapping[str, str], decided: set[str], settled: Mapping[str, str]
) -> dict[str, str]:
    """The configuration of each component that is used: the one decided on, or the only one that there can be."""
    used = {
        component
        for function, name in designs.items()
        for option in alternatives.functions[function]
        if option.name == name
        for component in option.components
    }
    named: dict[str, str] = {}
    for component, options in alternatives.components.items():
        if component in used and options:
            named[component] = next((o.name for o in options if o.name in decided), settled.get(component, ""))
    return named
