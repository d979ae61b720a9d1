"""The CSV files of the SUAVE exemplar: its analysis scripts read ours, and a report shows its results with ours.

A file of missions has a row for each run; three files beside it, with its name and a suffix, have a row for each
reaction: to a failed thruster (U1), to the visibility of the water (U2), to a low battery (U3).
"""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from os import PathLike
from pathlib import Path
from statistics import fmean
from typing import Any, TypeVar

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest, unwritable
from rosa_core.formats.text_source import read_text
from rosa_simulation.metric import Better, Metric, MetricKind
from rosa_simulation.run_record import RunRecord

MISSION_COLUMNS = (
    "mission name",
    "datetime",
    "initial pos (x,y)",
    "mission duration (s)",
    "pipeline found",
    "time searching pipeline (s)",
    "distance inspected (m)",
    "mean reaction time (s)",
)
REACTION_COLUMNS = ("mission_name", "datetime", "reaction time (s)")
REACTION_SUFFIXES: Mapping[str, str] = {
    "U1": "_component_recovery_time",
    "U2": "_wv_reaction_time",
    "U3": "_battery_reaction_time",
}
"""What the files of reactions are called, by the paper's name of the uncertainty."""
MISSION_METRICS = (
    Metric("pipeline_found", "", "whether the pipeline was found", MetricKind.TRUTH, Better.MORE),
    Metric("search_time_s", "s", "time until the pipeline was found", MetricKind.DURATION, Better.LESS),
    Metric("distance_inspected_m", "m", "length of pipeline that was inspected", MetricKind.DISTANCE, Better.MORE),
)
"""The metrics that a file of missions has, by their names in run records."""

_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
_DATE = re.compile(r"(\d{1,2})-([A-Z][a-z]{2})-(\d{4})-(\d{2})-(\d{2})-(\d{2})")
_DATE_MONTH_FIRST = re.compile(r"([A-Z][a-z]{2})-(\d{1,2})-(\d{4})-(\d{2})-(\d{2})-(\d{2})")
_POSITION = re.compile(r"\(?\s*([^,\s]+)\s*,\s*([^,\s)]+)\s*\)?")

_Row = TypeVar("_Row")


@dataclass(frozen=True, slots=True)
class ExemplarMission:
    """A row of a file of missions: times in s, distances in m.

    ``mission_name`` is mission and manager with a space between. ``search_time_s`` is the duration if nothing was
    found. ``mean_reaction_time_s`` is over all reactions; None stands for no reaction, which the exemplar writes as 0.
    """

    mission_name: str
    date: datetime
    initial_position: tuple[float, float]
    duration_s: float
    pipeline_found: bool
    search_time_s: float
    distance_inspected_m: float
    mean_reaction_time_s: float | None


@dataclass(frozen=True, slots=True)
class ExemplarReaction:
    """A row of a file of reactions."""

    mission_name: str
    date: datetime
    reaction_time_s: float


def read_missions(path: str | PathLike[str]) -> list[ExemplarMission]:
    """Read a file of missions. Columns may come in any order, and others among them.

    Raises:
        InputError: for what cannot be read, with file and line; every line that is wrong is named.
    """
    return _read(path, MISSION_COLUMNS, _mission)


def read_reactions(path: str | PathLike[str]) -> list[ExemplarReaction]:
    """Read a file of reactions.

    Raises:
        InputError: for what cannot be read, with file and line; every line that is wrong is named.
    """
    return _read(path, REACTION_COLUMNS, _reaction)


def mission_of(record: RunRecord, date: datetime) -> ExemplarMission:
    """The row for a run of ours.

    Args:
        record: of a SUAVE mission.
        date: when it ended.

    Returns:
        the row; its mean reaction time is over all reactions, as the exemplar counts it.

    Raises:
        KeyError: if the run has no search time, distance and found pipeline among its metrics, or no trajectory in
            x and y: it is none of the exemplar's missions.
    """
    total = [reaction.total_s for reactions in record.reactions.values() for reaction in reactions]
    start = dict(zip(record.trajectory_columns, record.trajectory[0], strict=True)) if record.trajectory else {}
    return ExemplarMission(
        mission_name=_mission_name(record),
        date=date,
        initial_position=(round(start["x_m"], 2), round(start["y_m"], 2)),
        duration_s=record.duration_s,
        pipeline_found=record.metrics["pipeline_found"],
        search_time_s=record.metrics["search_time_s"],
        distance_inspected_m=record.metrics["distance_inspected_m"],
        mean_reaction_time_s=fmean(total) if total else None,
    )


def reactions_of(record: RunRecord, date: datetime) -> dict[str, list[ExemplarReaction]]:
    """The rows for the reactions in a run of ours.

    Args:
        record: of a SUAVE mission.
        date: when it ended.

    Returns:
        rows by uncertainty (U1, U2, U3), in the order in which the reactions happened.
    """
    name = _mission_name(record)
    return {
        uncertainty: [ExemplarReaction(name, date, reaction.total_s) for reaction in reactions]
        for uncertainty, reactions in record.reactions.items()
    }


def _mission_name(record: RunRecord) -> str:
    layer = "" if record.task_layer == "bt" else f"-{record.task_layer}"
    return f"{record.scenario} {record.manager}{layer}"


def reaction_file(missions: str | PathLike[str], uncertainty: str) -> Path:
    """The file of reactions that belongs to a file of missions.

    Args:
        missions: the file of missions.
        uncertainty: U1, U2 or U3.

    Example:
        >>> reaction_file("theirs.csv", "U2").name
        'theirs_wv_reaction_time.csv'
    """
    path = Path(missions)
    return path.with_name(f"{path.stem}{REACTION_SUFFIXES[uncertainty]}{path.suffix}")


def write_missions(path: str | PathLike[str], missions: Iterable[ExemplarMission]) -> None:
    """Write a file of missions as the exemplar does.

    Args:
        path: of the file; one that is there is replaced.
        missions: its rows, in order.

    Raises:
        InputError: if it cannot be written.
    """
    rows = (
        (
            mission.mission_name,
            _date_text(mission.date),
            str(tuple(mission.initial_position)),
            _number_text(mission.duration_s),
            str(mission.pipeline_found),
            _number_text(mission.search_time_s),
            _number_text(mission.distance_inspected_m),
            _number_text(mission.mean_reaction_time_s or 0.0),
        )
        for mission in missions
    )
    _write(path, MISSION_COLUMNS, rows)


def write_reactions(path: str | PathLike[str], reactions: Iterable[ExemplarReaction]) -> None:
    """Write a file of reactions as the exemplar does.

    Args:
        path: of the file; one that is there is replaced.
        reactions: its rows, in order.

    Raises:
        InputError: if it cannot be written.
    """
    rows = (
        (reaction.mission_name, _date_text(reaction.date), _number_text(reaction.reaction_time_s))
        for reaction in reactions
    )
    _write(path, REACTION_COLUMNS, rows)


def _read(path: str | PathLike[str], columns: Sequence[str], parse: Callable[[Mapping[str, str]], _Row]) -> list[_Row]:
    file = str(path)
    reader = csv.reader(io.StringIO(read_text(path).removeprefix("\ufeff"), newline=""), strict=True)
    rows: list[_Row] = []
    problems: list[Problem] = []
    try:
        header = [name.strip() for name in next(reader, [])]
        _check_header(header, columns, Location(file, 1))
        for cells in reader:
            if not any(cell.strip() for cell in cells):
                continue
            try:
                rows.append(parse(_named(header, cells)))
            except ValueError as error:
                problems.append(Problem(str(error), Location(file, reader.line_num)))
    except csv.Error as error:
        problems.append(Problem(f"not valid CSV: {error}", Location(file, reader.line_num)))
    if problems:
        raise InputError(problems)
    return rows


def _check_header(header: Sequence[str], columns: Sequence[str], where: Location) -> None:
    problems = [
        Problem(
            f"there is no column '{name}'", where, nearest(name, header) or f"the first line is {', '.join(columns)}"
        )
        for name in columns
        if name not in header
    ]
    problems += [Problem(f"the column '{name}' is there twice", where) for name in columns if header.count(name) > 1]
    if problems:
        raise InputError(problems)


def _named(header: Sequence[str], cells: Sequence[str]) -> dict[str, str]:
    if len(cells) != len(header):
        raise ValueError(f"{len(cells)} values for {len(header)} columns")
    return {name: cell.strip() for name, cell in zip(header, cells, strict=True)}


def _mission(cells: Mapping[str, str]) -> ExemplarMission:
    mean = _number(cells, "mean reaction time (s)")
    return ExemplarMission(
        mission_name=cells["mission name"],
        date=_date(cells["datetime"]),
        initial_position=_position(cells["initial pos (x,y)"]),
        duration_s=_number(cells, "mission duration (s)"),
        pipeline_found=_truth(cells, "pipeline found"),
        search_time_s=_number(cells, "time searching pipeline (s)"),
        distance_inspected_m=_number(cells, "distance inspected (m)"),
        mean_reaction_time_s=mean or None,
    )


def _reaction(cells: Mapping[str, str]) -> ExemplarReaction:
    return ExemplarReaction(cells["mission_name"], _date(cells["datetime"]), _number(cells, "reaction time (s)"))


def _finite(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan


def _number(cells: Mapping[str, str], column: str) -> float:
    value = _finite(cells[column])
    if not value >= 0.0:
        raise ValueError(f"{column} is '{cells[column][:40]}', not a number from 0 on")
    return value


def _truth(cells: Mapping[str, str], column: str) -> bool:
    known = {"true": True, "false": False}
    if cells[column].lower() not in known:
        raise ValueError(f"{column} is '{cells[column][:40]}', not True or False")
    return known[cells[column].lower()]


def _position(text: str) -> tuple[float, float]:
    match = _POSITION.fullmatch(text)
    x, y = (math.nan, math.nan) if match is None else map(_finite, match.groups())
    if math.isnan(x) or math.isnan(y):
        raise ValueError(f"initial pos (x,y) is '{text[:40]}', not like (-17.0, 2.57)")
    return x, y


def _date(text: str) -> datetime:
    """A date as the exemplar writes it; whoever ran it knows in which time zone."""
    fields: Sequence[Any] | None = None
    if match := _DATE.fullmatch(text):
        day, month, *rest = match.groups()
        fields = (month, day, *rest)
    elif match := _DATE_MONTH_FIRST.fullmatch(text):
        fields = match.groups()
    if fields is not None and fields[0] in _MONTHS:
        day, year, hour, minute, second = map(int, fields[1:])
        try:
            return datetime(year, _MONTHS.index(fields[0]) + 1, day, hour, minute, second)  # noqa: DTZ001
        except ValueError:
            pass
    raise ValueError(f"datetime is '{text[:40]}', not like 04-Feb-2023-13-42-32")


def _date_text(date: datetime) -> str:
    # Month names are English in the exemplar's files, wherever they are written.
    return f"{date.day:02d}-{_MONTHS[date.month - 1]}-{date.year:04d}-{date:%H-%M-%S}"


def _number_text(value: float) -> str:
    return str(int(value)) if value == int(value) else repr(value)


def _write(path: str | PathLike[str], columns: Sequence[str], rows: Iterator[tuple[str, ...]]) -> None:
    try:
        with Path(path).open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            writer.writerows(rows)
    except OSError as error:
        raise unwritable(path, error, "name another file") from None
