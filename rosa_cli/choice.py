"""The configuration that a preference or utility chooses for a required action, and why (``rosa status``)."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from rosa_cli.named_number import named_number
from rosa_cli.options import UtilityOptions
from rosa_core import InputError, KnowledgeBase
from rosa_core.choice import CompleteConfiguration, unmet_limits
from rosa_core.errors import Problem
from rosa_core.model.utility import Limit, Utility


@dataclass(frozen=True, slots=True)
class Choice:
    """The best configuration of an action and the next best; ``note`` says what else has a part in it."""

    action: str
    utility: Utility
    best: CompleteConfiguration | None
    runner_up: CompleteConfiguration | None
    meets_limits: bool
    note: str | None


def requested_utility(options: UtilityOptions) -> Utility | None:
    """What the options ask for; None if they ask for nothing.

    Raises:
        InputError: if both a preference and weights are given, or one of them cannot be read.
    """
    preference = options.preference
    if preference is None and not options.weight and not options.limit:
        return None
    if preference is not None and options.weight:
        hint = f"write --weight {preference}=1 instead of --preference {preference}"
        raise InputError(Problem("--preference and --weight exclude each other", hint=hint))
    given = (
        {preference: 1.0}
        if preference is not None
        else dict(named_number("--weight", text, "energy=-0.5") for text in options.weight or [])
    )
    return Utility(given, tuple(map(Limit.parse, options.limit or [])))


def choose(kb: KnowledgeBase, utility: Utility) -> Choice:
    """What the utility chooses for the one required action.

    Raises:
        InputError: if not exactly one action is required.
    """
    required = [action.action for action in kb.required_actions()]
    if len(required) != 1:
        what = "a preference is for one required action" + (f", not for {len(required)}" if required else "")
        hint = "give --require once, such as --require navigate"
        raise InputError(Problem(what, hint=hint))
    (action,) = required
    alternatives = kb.alternatives(action)
    ordered = list(itertools.islice(kb.configurations(action, utility), 2))
    unmet = None if ordered or not kb.is_action_feasible(action) else unmet_limits(alternatives, utility)
    note = None
    if unmet is not None:
        ordered = list(itertools.islice(kb.configurations(action), 2))
        note = f"{unmet}; so priorities decide"
    elif not ordered:
        explanation = kb.explain("action", action)
        note = f"there is none: {explanation.summary}"
    elif len(ordered) == 2 and ordered[0].utility == ordered[1].utility:
        note = "the utility is the same; priorities and the order of declaration decide"
    best, runner_up, *_ = (*ordered, None, None)
    return Choice(action, utility, best, runner_up, unmet is None and best is not None, note)


def choice_document(choice: Choice) -> dict[str, Any]:
    """The choice as JSON."""
    best, other = choice.best, choice.runner_up
    return {
        "action": choice.action,
        "weights": dict(choice.utility.weights),
        "limits": [
            {"measure": limit.measure, "operator": limit.operator, "value": limit.value}
            for limit in choice.utility.limits
        ],
        "meets_limits": choice.meets_limits,
        **(_configuration(best) if best else dict.fromkeys(_configuration(_NONE))),
        "runner_up": {**_configuration(other), "difference": _difference(best, other)} if best and other else None,
        "note": choice.note,
    }


_NONE = CompleteConfiguration({}, {}, {})


def _configuration(configuration: CompleteConfiguration) -> dict[str, Any]:
    return {
        "function_designs": dict(configuration.function_designs),
        "component_configurations": dict(configuration.component_configurations),
        "estimates": dict(configuration.estimates),
        "utility": configuration.utility,
    }


def _difference(best: CompleteConfiguration, other: CompleteConfiguration) -> float:
    """How much better the best is; rounded to the digits that were put in, not to those that subtraction leaves."""
    return float(f"{best.utility - other.utility:.12g}")


def choice_lines(choice: Choice) -> Iterator[str]:
    """The choice for people, line by line."""
    yield f"choice for {choice.action} by {choice.utility}"
    best, other = choice.best, choice.runner_up
    if best is not None:
        for function, design in best.function_designs.items():
            yield f"  {function}: {design}"
        for component, configuration in best.component_configurations.items():
            yield f"  {component}: {configuration}"
        estimates = ", ".join(f"{measure} {value:g}" for measure, value in best.estimates.items())
        yield f"  estimated: {estimates or 'nothing'}"
        if choice.meets_limits:
            yield f"  utility: {best.utility:g}"
    if best is not None and other is not None:
        instead = ", ".join(_changes(best, other))
        less = f"utility {other.utility:g}, {_difference(best, other):g} less" if choice.meets_limits else "next"
        yield f"  runner-up: {instead} ({less})"
    if choice.note:
        yield f"  {choice.note}"


def _changes(best: CompleteConfiguration, other: CompleteConfiguration) -> Iterator[str]:
    """What is different in the other."""
    for function, design in other.function_designs.items():
        if best.function_designs[function] != design:
            yield f"{function}: {design}"
    for component, configuration in other.component_configurations.items():
        if best.component_configurations.get(component) != configuration:
            yield f"{component}: {configuration}"
    unused = [c for c in best.component_configurations if c not in other.component_configurations]
    if unused:
        yield f"without {', '.join(unused)}"
