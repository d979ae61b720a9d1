"""The statistics, against scipy on fixed data, against naive definitions, and against published examples."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from rosa_evaluation.statistics import (
    Comparison,
    Interval,
    Magnitude,
    compare,
    compare_all,
    corrected,
    describe_comparison,
    holm,
    share_interval,
    summarise,
)

# Search times published with the SUAVE exemplar (2023): no manager, metacontrol, random.
NONE = [204, 202, 211, 177, 127, 185, 224, 222, 190, 124, 151, 300, 191, 225, 127, 200, 191, 128, 188, 190]
METACONTROL = [237, 124, 83, 125, 77, 125, 90, 125, 73, 125, 128, 74, 69, 126, 127, 77, 83, 128, 71, 72]
RANDOM = [83, 61, 63, 300, 212, 161, 230, 221, 300, 300, 98, 211, 138, 145, 156, 66, 300, 175, 230, 153]

samples = st.lists(st.integers(-20, 20).map(float), min_size=1, max_size=12)


def test_the_published_means_and_deviations_are_found() -> None:
    for values, mean, sd in ((NONE, 187.85, 42.397), (METACONTROL, 106.95, 39.456), (RANDOM, 180.15, 82.054)):
        summary = summarise(values)
        assert (summary.n, summary.mean) == (20, pytest.approx(mean))
        assert summary.sd == pytest.approx(sd, abs=1e-3)


def test_a_summary_agrees_with_numpy_and_scipy() -> None:
    summary = summarise(METACONTROL)
    assert (summary.lower_quartile, summary.median, summary.upper_quartile) == tuple(
        np.percentile(METACONTROL, (25, 50, 75))
    )
    assert (summary.lowest, summary.highest) == (69, 237)
    assert summary.normality_p == stats.shapiro(METACONTROL).pvalue


def test_the_interval_of_the_mean_is_that_of_student_where_values_are_normal() -> None:
    values = np.random.default_rng(2).normal(50, 10, 200)
    interval = summarise(values.tolist()).mean_interval
    student = stats.t.interval(0.95, 199, np.mean(values), stats.sem(values))
    assert (interval.low, interval.high) == pytest.approx(student, abs=0.15)


def test_the_interval_of_the_median_is_the_textbook_one() -> None:
    # For n = 20 the 6th and 15th smallest values: coverage 0.9586 (Conover, Practical Nonparametric Statistics).
    assert summarise(range(1, 21)).median_interval == Interval(6, 15)
    assert summarise(range(1, 7)).median_interval == Interval(1, 6)
    assert summarise(range(1, 6)).median_interval == Interval(-math.inf, math.inf)


@pytest.mark.parametrize("n", [6, 7, 11, 20, 33, 100, 101])
def test_the_interval_of_the_median_covers_what_it_says_and_no_narrower_one_does(n: int) -> None:
    interval = summarise(range(1, n + 1)).median_interval
    below = int(interval.low) - 1
    assert interval.high == n - below
    assert 1 - 2 * stats.binom.cdf(below, n, 0.5) >= 0.95
    assert 1 - 2 * stats.binom.cdf(below + 1, n, 0.5) < 0.95


def test_small_and_constant_samples_have_what_can_be_said_of_them() -> None:
    one = summarise([3.0])
    assert (one.n, one.mean, one.sd, one.normality_p) == (1, 3.0, None, None)
    assert one.mean_interval == Interval(-math.inf, math.inf)
    same = summarise([2.0] * 5)
    assert (same.sd, same.normality_p, same.mean_interval) == (0.0, None, Interval(2.0, 2.0))


@pytest.mark.parametrize("values", [[], [1.0, math.nan], [math.inf]])
def test_samples_that_are_none_are_refused(values: list[float]) -> None:
    with pytest.raises(ValueError, match="a sample"):
        summarise(values)
    with pytest.raises(ValueError, match="a sample"):
        compare(("a", values), ("b", [1.0]))


def test_shares_have_the_exact_interval() -> None:
    assert share_interval(0, 10) == Interval(0.0, pytest.approx(0.3085, abs=1e-4))
    assert share_interval(19, 20).low == pytest.approx(0.7513, abs=1e-4)
    with pytest.raises(ValueError, match="k"):
        share_interval(3, 2)


def test_a_comparison_agrees_with_scipy_with_ties_and_without() -> None:
    for first, second in ((NONE, METACONTROL), (NONE, RANDOM), ([1.5, 2.5, 9.0], [0.5, 3.5, 4.5, 5.5])):
        expected = stats.mannwhitneyu(first, second, alternative="two-sided")
        found = compare(("a", first), ("b", second))
        assert (found.u, found.p) == (expected.statistic, expected.pvalue)
        assert found.p_corrected == found.p


def test_without_ties_small_samples_are_tested_exactly() -> None:
    # All of three below all of three: 1 of the 20 arrangements on either side.
    assert compare(("a", [1, 2, 3]), ("b", [4, 5, 6])).p == pytest.approx(0.1)


def test_ties_are_corrected_for() -> None:
    a, b = [1, 1, 2, 2, 2, 3, 3, 3, 3, 4], [2, 2, 3, 3, 4, 4, 4, 5, 5, 5]
    ranks = stats.rankdata([*a, *b])
    u = ranks[:10].sum() - 55
    ties = sum(count**3 - count for count in np.unique(ranks, return_counts=True)[1])
    deviation = math.sqrt(100 / 12 * (21 - ties / (20 * 19)))
    z = (abs(u - 50) - 0.5) / deviation
    found = compare(("a", a), ("b", b))
    assert (found.u, found.p) == (u, pytest.approx(2 * stats.norm.sf(z)))


@given(samples, samples)
def test_the_effect_size_is_the_share_of_pairs_in_which_the_first_is_above(a: list[float], b: list[float]) -> None:
    found = compare(("a", a), ("b", b))
    above = sum((x > y) + 0.5 * (x == y) for x in a for y in b)
    assert found.superiority == pytest.approx(above / (len(a) * len(b)))
    assert found.rank_biserial == pytest.approx(2 * above / (len(a) * len(b)) - 1)
    assert found.superiority_interval.low <= found.superiority_interval.high
    assert found.shift == pytest.approx(float(np.median([x - y for x in a for y in b])))
    assert 0 <= found.p <= 1


def test_turned_round_a_comparison_says_the_same() -> None:
    one, other = compare(("a", NONE), ("b", RANDOM)), compare(("b", RANDOM), ("a", NONE))
    assert one.p == pytest.approx(other.p)
    assert one.superiority == pytest.approx(1 - other.superiority)
    assert one.shift == -other.shift


def test_values_that_are_all_the_same_show_no_difference() -> None:
    found = compare(("a", [5.0] * 4), ("b", [5.0] * 3))
    assert (found.p, found.superiority, found.superiority_interval) == (1.0, 0.5, Interval(0.5, 0.5))
    assert found.magnitude is Magnitude.NEGLIGIBLE


def test_the_interval_of_the_effect_size_covers_what_it_says() -> None:
    rng = np.random.default_rng(1)
    truth = stats.norm.cdf(1 / math.sqrt(2))
    covered = 0
    for _ in range(40):
        interval = compare(("a", rng.normal(1, 1, 30)), ("b", rng.normal(0, 1, 30))).superiority_interval
        covered += interval.low <= truth <= interval.high
    assert covered >= 34


def test_the_same_data_give_the_same_numbers() -> None:
    assert compare(("a", NONE), ("b", RANDOM)) == compare(("a", NONE), ("b", RANDOM))
    assert summarise(NONE) == summarise(NONE)


@pytest.mark.parametrize(
    ("superiority", "magnitude"),
    [
        (0.5, "negligible"),
        (0.559, "negligible"),
        (0.56, "small"),
        (0.44, "small"),
        (0.64, "medium"),
        (0.71, "large"),
        (0.29, "large"),
        (0.0, "large"),
    ],
)
def test_effects_are_called_as_vargha_and_delaney_call_them(superiority: float, magnitude: str) -> None:
    some = Comparison("a", "b", 1, 1, 0, 0, 0, 1, 1, superiority, Interval(0, 1), 0)
    assert some.magnitude == magnitude


def test_holm_on_the_textbook_example() -> None:
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([]) == []


@given(st.lists(st.floats(0, 1), min_size=1, max_size=8))
def test_holm_rejects_what_the_stepwise_procedure_rejects(ps: list[float]) -> None:
    adjusted = holm(ps)
    for level in (0.01, 0.05, 0.2, 0.9):
        rejected = set()
        for step, index in enumerate(sorted(range(len(ps)), key=lambda i: ps[i])):
            if (len(ps) - step) * ps[index] > level:
                break
            rejected.add(index)
        assert {index for index, p in enumerate(adjusted) if p <= level} == rejected


def test_all_pairs_are_compared_and_corrected_as_one_family() -> None:
    found = compare_all({"none": NONE, "metacontrol": METACONTROL, "nobody": [], "random": RANDOM})
    assert [(c.first, c.second) for c in found] == [
        ("none", "metacontrol"),
        ("none", "random"),
        ("metacontrol", "random"),
    ]
    assert [c.p_corrected for c in found] == holm([c.p for c in found])
    assert [c.significant() for c in found] == [True, False, True]
    assert corrected(found[:1])[0].p_corrected == found[0].p


def test_it_is_said_in_words() -> None:
    apart, *_ = compare_all({"metacontrol": METACONTROL, "none": NONE, "random": RANDOM})
    said = describe_comparison(apart, "search time", "s", comparisons=3)
    for words in (
        "The search time of metacontrol is lower than that of none (medians 107 s against 190 s;",
        "n = 20 and 20, p < 0.001 after Holm's correction for 3 comparisons)",
        "The effect is large: of two runs, one of each, that of metacontrol is the lower in 9",
        "in 92% (95% interval 80% to 100%), typically by 79 s.",
    ):
        assert words in said
    none_random = compare(("none", NONE), ("random", RANDOM))
    said = describe_comparison(none_random, "search time")
    assert said.startswith("No difference in search time between none and random")


def test_turned_round_the_words_keep_their_sense() -> None:
    said = describe_comparison(compare(("none", NONE), ("metacontrol", METACONTROL)), "search time", "s")
    assert "The search time of none is higher than that of metacontrol (medians 190 s against 107 s" in said
