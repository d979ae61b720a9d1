"""What a scenario measures: each metric is declared once, and records, databases, tables and figures go by it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum


class MetricKind(StrEnum):
    """What sort of value a metric has."""

    TRUTH = "truth"
    """True or false; over several runs, the share of those in which it is true."""
    COUNT = "count"
    DURATION = "duration"
    DISTANCE = "distance"
    SHARE = "share"
    """From 0 to 1."""
    NUMBER = "number"


class Better(StrEnum):
    """Which values of a metric are wanted."""

    MORE = "more"
    LESS = "less"
    NEITHER = "neither"


@dataclass(frozen=True, slots=True)
class Metric:
    """One thing that a run measures.

    A value is a number or truth value, None if there was nothing to measure, or a mapping of these (such as a mean
    reaction time for each uncertainty).

    Attributes:
        name: the key of its value in run records, databases and JSON, such as ``search_time_s``.
        unit: such as ``s`` or ``m``; empty where there is none, None where it is not known.
        description: what is measured, in a line.
        kind: what sort of value it has.
        better: which values are wanted.

    Example:
        >>> search = Metric("search_time_s", "s", "time until the pipeline is found", MetricKind.DURATION, Better.LESS)
        >>> search.title, search.heading
        ('search time', 'search time s')
    """

    name: str
    unit: str | None
    description: str
    kind: MetricKind
    better: Better

    @property
    def title(self) -> str:
        """The name for people, without its unit."""
        name = self.name.removesuffix(f"_{self.unit}") if self.unit else self.name
        return name.replace("_", " ")

    @property
    def heading(self) -> str:
        """Name and unit, for the head of a column; an unknown unit is called so."""
        if self.unit is None:
            return f"{self.title} (unit unknown)"
        return f"{self.title} {self.unit}".rstrip()


MEAN_REACTION_TIME = Metric(
    "mean_reaction_time_s",
    "s",
    "mean time from an uncertainty to the adaptation to it, for each uncertainty",
    MetricKind.DURATION,
    Better.LESS,
)
"""What every scenario with reaction times measures; part of it is wall-clock time."""


def find_metric(name: str, declared: Iterable[Metric], value: object = None) -> Metric:
    """The declaration of a metric; a makeshift one for results whose scenario is not installed or did not have it.

    Args:
        name: of the metric.
        declared: by the scenario.
        value: one of its values, if there is one: that a value is of type bool is known without a declaration.

    Returns:
        the declaration; with unit None if there is none.
    """
    for metric in declared:
        if metric.name == name:
            return metric
    if isinstance(value, bool):
        return Metric(name, "", "not declared by an installed scenario", MetricKind.TRUTH, Better.NEITHER)
    return Metric(name, None, "not declared by an installed scenario", MetricKind.NUMBER, Better.NEITHER)
