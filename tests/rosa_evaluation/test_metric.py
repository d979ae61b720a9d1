"""A metric is declared once; what is not declared is said to be of an unknown unit."""

from __future__ import annotations

from rosa_simulation.metric import Better, Metric, MetricKind, find_metric

_TIME = Metric("search_time_s", "s", "time of the search", MetricKind.DURATION, Better.LESS)
_GRAMS = Metric("grams", "", "a number whose name ends like a unit", MetricKind.NUMBER, Better.NEITHER)


def test_title_and_heading_go_by_the_declared_unit_and_not_by_the_name() -> None:
    assert (_TIME.title, _TIME.heading) == ("search time", "search time s")
    unitless = Metric("laps_s", "", "laps of the robot s", MetricKind.COUNT, Better.MORE)
    assert (unitless.title, unitless.heading) == ("laps s", "laps s")
    assert _GRAMS.heading == "grams"


def test_a_declared_metric_is_found_by_its_name() -> None:
    assert find_metric("search_time_s", (_GRAMS, _TIME)) is _TIME


def test_the_unit_of_a_metric_that_nobody_declares_is_unknown_and_said_to_be() -> None:
    metric = find_metric("distance_m", (_TIME,), 3.5)
    assert (metric.unit, metric.kind) == (None, MetricKind.NUMBER)
    assert metric.heading == "distance m (unit unknown)"


def test_only_a_value_of_type_bool_makes_an_undeclared_metric_a_truth_value() -> None:
    assert find_metric("found", (), True).kind is MetricKind.TRUTH
    assert find_metric("found", (), 1).kind is MetricKind.NUMBER
