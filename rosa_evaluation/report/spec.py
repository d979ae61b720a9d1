"""How a scenario wants its runs to be shown: published results, what is under a trajectory, what happened on it.

A scenario may have a method ``report_spec() -> ReportSpec``; without one, everything that its runs measured is shown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from rosa_core import InputError
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import find_scenario, scenario_names

Point = tuple[float, float]

_CHANGES = ("activated", "deactivated", "parameters", "reconfiguration plan")


@dataclass(frozen=True, slots=True)
class PublishedRow:
    """What somebody published for a managing system.

    Attributes:
        manager: the managing system, by its name here.
        source: where it was published, such as a table of a paper.
        runs: over how many runs.
        conditions: how it was measured.
        values: mean and standard deviation (None if it was not given) by metric (such as ``search_time_s``, in the
            metric's unit) or uncertainty (such as ``U1``, in s).
    """

    manager: str
    source: str
    runs: int
    conditions: str
    values: Mapping[str, tuple[float, float | None]]


@dataclass(frozen=True, slots=True)
class Landmark:
    """Something in the world, seen from above.

    Attributes:
        name: shown beside it.
        points: (x, y) in m; a line through them, or a place if there is only one.
    """

    name: str
    points: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Mark:
    """Something that happened in a run.

    Attributes:
        time_s: mission time, s.
        kind: what the legend calls it.
        text: what happened, in words.
    """

    time_s: float
    kind: str
    text: str


def adaptations(record: RunRecord) -> list[Mark]:
    """A mark for every event in which the architecture changed.

    Args:
        record: of the run.
    """
    return [
        Mark(event.time_s, "adaptation", event.text)
        for event in record.events
        if any(fact.get("fact") in _CHANGES for fact in event.facts)
    ]


def _nothing(_: RunRecord) -> Iterable[Landmark]:
    return ()


@dataclass(frozen=True, slots=True)
class ReportSpec:
    """How a scenario's runs are shown.

    Attributes:
        metrics: which ones, in this order; all that are numbers, if there are none here.
        uncertainties: what the names of reactions stand for.
        conditions: how our figures were obtained, for who compares them with published ones.
        published: rows to be shown below ours.
        landmarks: what is drawn under a run's trajectory; x to the right, y upwards.
        marks: what is drawn upon it.
        draw: a picture of a run from above as an SVG document, where the scenario draws its own.
    """

    metrics: tuple[str, ...] = ()
    uncertainties: Mapping[str, str] = field(default_factory=dict)
    conditions: str = ""
    published: tuple[PublishedRow, ...] = ()
    landmarks: Callable[[RunRecord], Iterable[Landmark]] = _nothing
    marks: Callable[[RunRecord], Iterable[Mark]] = adaptations
    draw: Callable[[RunRecord], str] | None = None


def report_spec_of(scenario: str) -> ReportSpec:
    """How an installed scenario wants its runs to be shown; an empty specification for every other."""
    if scenario not in scenario_names():
        return ReportSpec()
    try:
        spec: ReportSpec | None = find_scenario(scenario).report_spec()
    except InputError:
        return ReportSpec()
    return spec or ReportSpec()
