"""Axes cover their values, keep their order, and have round ticks, not too many."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_evaluation.report.scale import Scale

VALUES = st.lists(st.floats(-1e6, 1e6).map(lambda value: round(value, 3)), min_size=1, max_size=20)
POSITIVE = st.lists(st.floats(1e-6, 1e6), min_size=1, max_size=20)


@given(VALUES)
def test_a_linear_axis_covers_its_values_in_their_order(values: list[float]) -> None:
    scale = Scale.over(values, 10.0, 110.0)
    assert scale.low <= min(values)
    assert scale.high >= max(values)
    placed = [scale(value) for value in sorted(values)]
    assert placed == sorted(placed)
    assert all(10.0 <= pixel <= 110.0 for pixel in placed)


@given(VALUES)
def test_a_linear_axis_has_some_ticks_at_equal_distances(values: list[float]) -> None:
    scale = Scale.over(values, 0.0, 100.0)
    ticks = scale.ticks()
    assert 2 <= len(ticks) <= 11
    assert 0.0 in ticks
    tolerance = 1e-9 * (scale.high - scale.low)
    assert scale.low - tolerance <= ticks[0]
    assert ticks[-1] <= scale.high + tolerance
    steps = [after - before for before, after in pairwise(ticks)]
    assert steps == pytest.approx([steps[0]] * len(steps))


@given(POSITIVE)
def test_a_logarithmic_axis_has_a_tick_at_each_decade_around_its_values(values: list[float]) -> None:
    scale = Scale.over_decades(values, 0.0, 100.0)
    ticks = scale.ticks()
    assert ticks[0] <= min(values) * (1 + 1e-9)
    assert ticks[-1] >= max(values) * (1 - 1e-9)
    assert ticks[1:] == pytest.approx([10.0 * tick for tick in ticks[:-1]])


def test_what_is_beyond_an_end_lies_at_the_end() -> None:
    scale = Scale(0.0, 10.0, 0.0, 100.0)
    assert (scale(-5.0), scale(50.0)) == (0.0, 100.0)
