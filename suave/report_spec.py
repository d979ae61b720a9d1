"""What a report shows of SUAVE missions: published results beside ours, the pipeline, and what happened on the way."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain

from rosa_evaluation.report import Landmark, Mark, PublishedRow, ReportSpec
from rosa_simulation.run_record import MissionEvent, RunRecord
from suave.world.environment import PIPELINE, RECHARGE_STATION

_METRICS = ("search_time_s", "distance_inspected_m", "distance_inspected_total_m", "pipeline_found")
_UNCERTAINTIES = {"U1": "a thruster fails", "U2": "the visibility of the water changes"}
_U3 = {"U3": "the battery is low"}

_CONDITIONS = (
    "Here: MuJoCo in simulated time, each managing system with the same seeds. Where the vehicle starts and how its "
    "position is known and controlled was fitted to the published means with other seeds, so that order and size of "
    "effects can be compared, not spreads. A reaction time is simulated delay plus wall-clock time of computing, "
    "without the transport of messages between processes."
)
_TABLE_6 = "ROSA paper, table 6"
_TABLE_6_CONDITIONS = (
    "SUAVE in Gazebo with ArduSub and ROS 2, in real time; reaction times are measured by the wall clock, with the "
    "transport of messages and, for ROSA and Metacontrol, a reasoner in a process of its own."
)
_SUAVE_2023 = "SUAVE, runs of 2023"
_SUAVE_2023_CONDITIONS = "The exemplar's own runs, in Gazebo with ArduSub and ROS 2, in real time."

_Values = tuple[float, float | None]


def plain_report() -> ReportSpec:
    """What a report shows of the plain mission."""
    return _report(_UNCERTAINTIES, _published())


def extended_report() -> ReportSpec:
    """What a report shows of the extended mission."""
    return _report(_UNCERTAINTIES | _U3, _published_extended())


def _report(uncertainties: Mapping[str, str], published: Iterator[PublishedRow]) -> ReportSpec:
    return ReportSpec(
        metrics=_METRICS,
        uncertainties=uncertainties,
        conditions=_CONDITIONS,
        published=tuple(published),
        landmarks=landmarks,
        marks=marks,
    )


def _published() -> Iterator[PublishedRow]:
    yield _table_6("none", (174.75, 36.0), (33.2, 13.49))
    yield _table_6("bt", (84.09, 26.41), (62.7, 7.78), U1=0.08, U2=0.10)
    yield _table_6("metacontrol", (89.24, 35.57), (60.57, 11.17), U1=1.55, U2=0.82)
    yield _table_6("rosa", (85.11, 32.48), (60.76, 10.29), U1=1.24, U2=1.57)
    yield _suave_2023("none", (187.9, 42.4), (31.4, 13.0))
    yield _suave_2023("metacontrol", (107.0, 39.5), (51.2, 12.0))
    yield _suave_2023("random", (180.2, 82.1), (3.9, 3.2))


def _published_extended() -> Iterator[PublishedRow]:
    yield _table_6("bt", (94.37, 34.92), (20.88, 3.81), U1=0.07, U2=0.10, U3=1.09)
    yield _table_6("rosa", (92.75, 35.92), (18.97, 3.38), U1=1.39, U2=1.67, U3=2.50)


def _table_6(manager: str, search: _Values, distance: _Values, **reactions: float) -> PublishedRow:
    values: Mapping[str, _Values] = {
        "search_time_s": search,
        "distance_inspected_m": distance,
        **{name: (mean, None) for name, mean in reactions.items()},
    }
    return PublishedRow(manager, _TABLE_6, 100, _TABLE_6_CONDITIONS, values)


def _suave_2023(manager: str, search: _Values, distance: _Values) -> PublishedRow:
    values = {"search_time_s": search, "distance_inspected_m": distance}
    return PublishedRow(manager, _SUAVE_2023, 20, _SUAVE_2023_CONDITIONS, values)


def landmarks(record: RunRecord) -> Iterator[Landmark]:
    """The pipeline, and where the battery is recharged if there is one."""
    yield Landmark("pipeline", PIPELINE)
    if record.scenario == "suave-extended":
        yield Landmark("recharge station", (RECHARGE_STATION[:2],))


def marks(record: RunRecord) -> list[Mark]:
    """The pipeline found, thrusters that failed, and every change of the architecture, by what changed."""
    return list(chain.from_iterable(map(_marks_of, record.events)))


def _marks_of(event: MissionEvent) -> Iterator[Mark]:
    facts = {fact["fact"]: fact for fact in event.facts}
    for fact, kind in _HAPPENED.items():
        if fact in facts:
            yield Mark(event.time_s, kind, event.text)
            return
    if "parameters" in facts:
        yield Mark(event.time_s, "altitude adapted", event.text)
    elif "activated" in facts or "deactivated" in facts:
        yield Mark(event.time_s, "nodes switched", event.text)


_HAPPENED = {"pipeline found": "pipeline found", "thruster failed": "thruster failed", "recharged": "battery recharged"}
