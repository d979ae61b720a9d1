"""The best configuration, and all in order: the search against trying everything, over random alternatives."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core.choice import (
    Alternatives,
    CompleteConfiguration,
    ConfigurationOption,
    DesignOption,
    best_configuration,
    complete_configurations,
    estimates,
    unmet_limits,
)
from rosa_core.model.elements import ConstraintOperator, ElementKind, ElementRef, Estimation, EstimationType
from rosa_core.model.utility import Limit, Utility

MEASURES = ("energy", "safety", "accuracy")
NUMBERS = st.sampled_from([0.0, 0.1, 0.2, 0.3, 0.25, 1.0, 1.5, 2.0, 3.0, -0.3, -1.0])
PRIORITIES = st.sampled_from([None, 1.0, 2.0, 2.5])


def causers(functions, components):
    for options in functions.values():
        yield from (ElementRef(ElementKind.FUNCTION_DESIGN, option.name) for option in options)
    names = dict.fromkeys(name for options in functions.values() for o in options for name in o.components)
    yield from (ElementRef(ElementKind.COMPONENT, name) for name in names)
    for options in components.values():
        yield from (ElementRef(ElementKind.COMPONENT_CONFIGURATION, option.name) for option in options)


@st.composite
def alternatives(draw, absolutes=True, shared=True):
    """Up to 3 functions x 3 designs over 5 components, some with configurations, some shared by several functions."""
    pool = [f"c{number}" for number in range(5)]
    functions = {}
    for number in range(draw(st.integers(0, 3))):
        own = pool if shared else [f"c{number}.{part}" for part in range(2)]
        options = [
            DesignOption(f"d{number}.{which}", tuple(parts), draw(PRIORITIES))
            for which, parts in enumerate(
                draw(
                    st.lists(
                        st.lists(st.sampled_from(own), min_size=1, max_size=2, unique=True), max_size=3, min_size=1
                    )
                )
            )
        ]
        functions[f"f{number}"] = tuple(options)
    names = sorted({name for options in functions.values() for o in options for name in o.components})
    components = {}
    for name in draw(st.permutations(names)):
        count = draw(st.sampled_from([0, 0, 1, 2, 3]))
        if count:
            components[name] = tuple(ConfigurationOption(f"{name}/{which}", draw(PRIORITIES)) for which in range(count))
    kinds = st.sampled_from(list(EstimationType) if absolutes else [EstimationType.POSITIVE, EstimationType.NEGATIVE])
    estimations = [
        Estimation(causer, measure, draw(NUMBERS), draw(kinds))
        for causer in causers(functions, components)
        for measure in draw(st.sets(st.sampled_from(MEASURES)))
    ]
    return Alternatives(functions, components, tuple(draw(st.permutations(estimations))))


utilities = st.builds(
    Utility,
    st.dictionaries(st.sampled_from(MEASURES), NUMBERS, max_size=3),
    st.lists(st.builds(Limit, st.sampled_from(MEASURES), st.sampled_from(ConstraintOperator), NUMBERS), max_size=3).map(
        tuple
    ),
)

COMPARE = {
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
}


def decimal(number):
    return Fraction(repr(number))


def exact_estimates(given_alternatives, designs, configurations):
    """The definition, word by word, in rational numbers."""
    chosen = set()
    for function, name in designs.items():
        (design,) = [option for option in given_alternatives.functions[function] if option.name == name]
        chosen.add(ElementRef(ElementKind.FUNCTION_DESIGN, name))
        chosen.update(ElementRef(ElementKind.COMPONENT, component) for component in design.components)
    chosen.update(ElementRef(ElementKind.COMPONENT_CONFIGURATION, name) for name in configurations.values())
    values = dict.fromkeys(MEASURES, Fraction(0))
    for estimation in given_alternatives.estimations:
        if estimation.causer in chosen and estimation.type is not EstimationType.ABSOLUTE:
            sign = 1 if estimation.type is EstimationType.POSITIVE else -1
            values[estimation.measure] += sign * decimal(estimation.value)
    for estimation in given_alternatives.estimations:
        if estimation.causer in chosen and estimation.type is EstimationType.ABSOLUTE:
            values[estimation.measure] = decimal(estimation.value)
    return values


def rank(options, name):
    """How many better priorities there are."""
    numbers = {option.name: float("inf") if option.priority is None else option.priority for option in options}
    return len({number for number in numbers.values() if number < numbers[name]})


def everything(given_alternatives, utility) -> Iterator[tuple[tuple, dict, dict]]:
    """Every complete configuration that meets the limits, with the key that orders it: least is best."""
    functions, components = given_alternatives.functions, given_alternatives.components
    for designs in itertools.product(*functions.values()):
        used = {component for design in designs for component in design.components}
        configured = [name for name in components if name in used]
        for options in itertools.product(*(components[name] for name in configured)):
            chosen = dict(zip(functions, (design.name for design in designs), strict=True))
            running = dict(zip(configured, (option.name for option in options), strict=True))
            values = exact_estimates(given_alternatives, chosen, running)
            if all(COMPARE[limit.operator](values[limit.measure], decimal(limit.value)) for limit in utility.limits):
                value = sum((decimal(w) * values[m] for m, w in utility.weights.items()), Fraction(0))
                key = (
                    -value,
                    sum(rank(functions[f], name) for f, name in chosen.items()),
                    sum(rank(components[c], name) for c, name in running.items()),
                    [options.index(design) for options, design in zip(functions.values(), designs, strict=True)],
                    [next((i for i, o in enumerate(components[c]) if o.name == running.get(c)), 0) for c in components],
                )
                yield key, chosen, running


def in_order(given_alternatives, utility):
    return [(d, c) for _, d, c in sorted(everything(given_alternatives, utility), key=lambda found: found[0])]


def chosen(configuration: CompleteConfiguration):
    return configuration.function_designs, configuration.component_configurations


@settings(deadline=None, max_examples=200)
@given(alternatives(), utilities)
def test_the_best_is_the_best_of_all(given_alternatives, utility):
    best = best_configuration(given_alternatives, utility)
    ranked = in_order(given_alternatives, utility)
    assert (None if best is None else chosen(best)) == (ranked[0] if ranked else None)


@settings(deadline=None, max_examples=200)
@given(alternatives(), utilities)
def test_all_come_once_and_in_order(given_alternatives, utility):
    found = [chosen(one) for one in itertools.islice(complete_configurations(given_alternatives, utility), 400)]
    assert found == in_order(given_alternatives, utility)[:400]


@settings(deadline=None, max_examples=100)
@given(alternatives(absolutes=False, shared=False), utilities)
def test_functions_that_share_nothing(given_alternatives, utility):
    found = [chosen(one) for one in itertools.islice(complete_configurations(given_alternatives, utility), 50)]
    assert found == in_order(given_alternatives, utility)[:50]


@settings(deadline=None, max_examples=100)
@given(alternatives(absolutes=False), utilities)
def test_components_that_functions_share_count_once(given_alternatives, utility):
    best = best_configuration(given_alternatives, utility)
    ranked = in_order(given_alternatives, utility)
    assert (None if best is None else chosen(best)) == (ranked[0] if ranked else None)


@settings(deadline=None, max_examples=100)
@given(alternatives(), utilities)
def test_estimates_and_utility_are_those_of_the_definition(given_alternatives, utility):
    for one in itertools.islice(complete_configurations(given_alternatives, utility), 5):
        exact = exact_estimates(given_alternatives, *chosen(one))
        assert one.estimates == {measure: float(exact[measure]) for measure in one.estimates}
        assert one.utility == float(sum(decimal(w) * exact[m] for m, w in utility.weights.items()))
        apart = estimates(given_alternatives, *chosen(one))
        assert apart == {measure: one.estimates[measure] for measure in apart}


@settings(deadline=None, max_examples=100)
@given(alternatives(), utilities)
def test_unmet_limits_are_reported_exactly_when_nothing_meets_them(given_alternatives, utility):
    met = best_configuration(given_alternatives, utility) is not None
    possible = best_configuration(given_alternatives) is not None
    assert (unmet_limits(given_alternatives, utility) is None) == (met or not possible)


def estimate(kind, name, measure, value, how="positive"):
    return Estimation(ElementRef(ElementKind(kind), name), measure, value, EstimationType(how))


def one_function(*names, **more):
    return Alternatives({"f": tuple(DesignOption(name, (f"c_{name}",)) for name in names)}, **more)


def test_decimal_numbers_tie_as_they_are_written():
    """0.1 + 0.2 is 0.3, so that the two tie and the first declared wins; and it is within <= 0.3."""
    given_alternatives = one_function(
        "sum",
        "whole",
        estimations=(
            estimate("function_design", "sum", "energy", 0.1),
            estimate("component", "c_sum", "energy", 0.2),
            estimate("function_design", "whole", "energy", 0.3),
        ),
    )
    best = best_configuration(given_alternatives, Utility({"energy": 1.0}, (("energy", "<=", 0.3),)))
    assert best is not None
    assert best.function_designs == {"f": "sum"}
    assert best.utility == 0.3


def test_the_absolute_estimation_that_was_declared_last_replaces_the_sum():
    given_alternatives = one_function(
        "d",
        estimations=(
            estimate("function_design", "d", "safety", 5.0, "absolute"),
            estimate("component", "c_d", "safety", 2.0, "absolute"),
        ),
    )
    assert estimates(given_alternatives, {"f": "d"}, {}) == {"safety": 2.0}


def test_an_absolute_estimation_of_what_is_not_kept_changes_nothing():
    given_alternatives = one_function(
        "kept",
        "other",
        estimations=(
            estimate("function_design", "other", "safety", 5.0, "absolute"),
            estimate("component", "c_kept", "safety", 1.0),
        ),
    ).keeping({"f": "kept"}, {})
    (only,) = complete_configurations(given_alternatives, Utility({"safety": 1.0}))
    assert (only.function_designs, only.utility) == ({"f": "kept"}, 1.0)


def test_a_function_without_designs_leaves_no_complete_configuration():
    given_alternatives = Alternatives({"f": (DesignOption("d", ("c",)),), "g": ()})
    assert best_configuration(given_alternatives) is None
    assert list(complete_configurations(given_alternatives)) == []
    assert unmet_limits(given_alternatives, Utility({}, (("energy", "<", -1.0),))) is None
    assert best_configuration(given_alternatives.solvable()) is not None


def test_an_action_without_functions_has_the_empty_configuration():
    (only,) = complete_configurations(Alternatives({}))
    assert only == CompleteConfiguration({}, {}, {}, 0.0)
    assert list(complete_configurations(Alternatives({}), Utility({}, (("safety", ">", 0.0),)))) == []


def test_priorities_decide_without_a_utility_and_none_comes_last():
    given_alternatives = Alternatives(
        {"f": (DesignOption("none", ("a",)), DesignOption("two", ("a",), 2.0), DesignOption("one", ("a",), 1.0))},
        {"a": (ConfigurationOption("slow", 7.0), ConfigurationOption("fast", 3.0))},
    )
    assert [tuple(c.values()) for d in complete_configurations(given_alternatives) for c in chosen(d)] == [
        ("one",), ("fast",), ("one",), ("slow",), ("two",), ("fast",),
        ("two",), ("slow",), ("none",), ("fast",), ("none",), ("slow",),
    ]  # fmt: skip


def test_what_is_preferred_wins_ties_and_what_is_kept_is_all_there_is():
    given_alternatives = one_function("a", "b", "c")
    best = best_configuration(given_alternatives.preferring(["b"], []))
    assert best is not None
    assert best.function_designs == {"f": "b"}
    kept = given_alternatives.keeping({"f": "c"}, {})
    assert [one.function_designs["f"] for one in complete_configurations(kept)] == ["c"]
    assert given_alternatives.keeping({"f": "gone"}, {}) == given_alternatives


def test_all_of_a_million_come_lazily():
    functions = {f"f{n}": tuple(DesignOption(f"d{n}.{k}", (f"c{n}.{k}",)) for k in range(10)) for n in range(6)}
    ordered = complete_configurations(Alternatives(functions))
    assert len(list(itertools.islice(ordered, 100))) == 100


@pytest.mark.parametrize("huge", [1e308, 5e-324, -1e300])
def test_numbers_of_any_size_are_compared_exactly(huge):
    given_alternatives = one_function(
        "a",
        "b",
        estimations=(
            estimate("function_design", "a", "energy", huge),
            estimate("component", "c_a", "energy", huge),
            estimate("function_design", "b", "energy", 0.1),
        ),
    )
    best = best_configuration(given_alternatives, Utility({"energy": 1e-300}))
    assert best is not None
    assert best.function_designs["f"] == ("a" if huge > 1 else "b")


def test_words_for_limits_that_cannot_be_met():
    given_alternatives = one_function(
        "a",
        "b",
        estimations=(
            estimate("function_design", "a", "energy", 1.5),
            estimate("function_design", "a", "safety", 3.0),
            estimate("function_design", "b", "energy", 2.5),
            estimate("function_design", "b", "safety", 4.0),
        ),
    )

    def unmet(*limits):
        return unmet_limits(given_alternatives, Utility({}, limits))

    assert unmet(("energy", "<=", 1.0)) == "no feasible configuration meets energy <= 1 (the least is 1.5)"
    assert unmet(("safety", ">", 4.0)) == "no feasible configuration meets safety > 4 (the most is 4)"
    together = unmet(("energy", "<", 2.0), ("safety", ">", 3.5))
    assert together == "no feasible configuration meets energy < 2 and safety > 3.5 together"
    assert unmet(("energy", "<", 2.0)) is None
