"""The CSV files of the SUAVE exemplar: its analysis scripts read ours, and a report shows its results with ours.

A file of missions has a row for each run; three files beside it, with its name and a suffix, have a row for each
reaction: to a failed thruster (U1), to the visibility of the water (U2), to a low battery (U3).
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import datetime
from os import PathLike
from pathlib import Path
from statistics import fmean
from typing import Annotated, TypeVar, get_type_hints

from pydantic import BeforeValidator, Field

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest, unwritable
from rosa_core.formats.checked_file import Flag, checked, value_reader, within
from rosa_core.formats.text_source import read_text
from rosa_simulation.metric import Better, Metric, MetricKind
from rosa_simulation.run_record import RunRecord

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
_MONTH = f"(?P<month>{'|'.join(_MONTHS)})"
_TIME = r"(?P<year>\d{4})-(?P<hour>\d{2})-(?P<minute>\d{2})-(?P<second>\d{2})"
_DATE = re.compile(rf"(?P<day>\d{{1,2}})-{_MONTH}-{_TIME}")
_DATE_MONTH_FIRST = re.compile(rf"{_MONTH}-(?P<day>\d{{1,2}})-{_TIME}")
_POSITION = re.compile(r"\(?\s*([^,\s]+)\s*,\s*([^,\s)]+)\s*\)?")

Row = TypeVar("Row")


def _truth(text: str) -> object:
    return {"true": True, "false": False}.get(text.lower(), text)


def _position(text: str) -> tuple[str, ...]:
    match = _POSITION.fullmatch(text)
    if match is None:
        raise ValueError("it is not like (-17.0, 2.57)")
    return match.groups()


def _date(text: str) -> datetime:
    """A date as the exemplar writes it; whoever ran it knows in which time zone."""
    match = _DATE.fullmatch(text) or _DATE_MONTH_FIRST.fullmatch(text)
    if match is not None:
        year, day, hour, minute, second = map(int, match.group("year", "day", "hour", "minute", "second"))
        with suppress(ValueError):
            return datetime(year, _MONTHS.index(match["month"]) + 1, day, hour, minute, second)  # noqa: DTZ001
    raise ValueError("it is not like 04-Feb-2023-13-42-32")


# The numbers of a table are text.
_Finite = Annotated[float, Field(allow_inf_nan=False)]
_FromZero = Annotated[_Finite, within(0.0)]
_from_zero = value_reader(_FromZero)


@dataclass(frozen=True, slots=True)
class ExemplarMission:
    """A row of a file of missions: times in s, distances in m.

    ``mission_name`` is mission and manager with a space between. ``search_time_s`` is the duration if nothing was
    found. ``mean_reaction_time_s`` is over all reactions; None stands for no reaction, which the exemplar writes as 0.
    """

    mission_name: Annotated[str, Field(alias="mission name")]
    date: Annotated[datetime, BeforeValidator(_date), Field(alias="datetime")]
    initial_position: Annotated[tuple[_Finite, _Finite], BeforeValidator(_position), Field(alias="initial pos (x,y)")]
    duration_s: Annotated[_FromZero, Field(alias="mission duration (s)")]
    pipeline_found: Annotated[Flag, BeforeValidator(_truth), Field(alias="pipeline found")]
    search_time_s: Annotated[_FromZero, Field(alias="time searching pipeline (s)")]
    distance_inspected_m: Annotated[_FromZero, Field(alias="distance inspected (m)")]
    mean_reaction_time_s: Annotated[
        float | None, BeforeValidator(lambda text: _from_zero(text) or None), Field(alias="mean reaction time (s)")
    ]


@dataclass(frozen=True, slots=True)
class ExemplarReaction:
    """A row of a file of reactions."""

    mission_name: Annotated[str, Field(alias="mission_name")]
    date: Annotated[datetime, BeforeValidator(_date), Field(alias="datetime")]
    reaction_time_s: Annotated[_FromZero, Field(alias="reaction time (s)")]


def _columns(row: type) -> tuple[str, ...]:
    hints = get_type_hints(row, include_extras=True).values()
    return tuple(next(m.alias for m in hint.__metadata__ if getattr(m, "alias", None)) for hint in hints)


MISSION_COLUMNS = _columns(ExemplarMission)
REACTION_COLUMNS = _columns(ExemplarReaction)


def read_missions(path: str | PathLike[str]) -> list[ExemplarMission]:
    """Read a file of missions. Columns may come in any order, and others among them.

    Raises:
        InputError: for what cannot be read, with file and line; every line that is wrong is named.
    """
    return _read(path, MISSION_COLUMNS, ExemplarMission)


def read_reactions(path: str | PathLike[str]) -> list[ExemplarReaction]:
    """Read a file of reactions.

    Raises:
        InputError: for what cannot be read, with file and line; every line that is wrong is named.
    """
    return _read(path, REACTION_COLUMNS, ExemplarReaction)


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


def _read(path: str | PathLike[str], columns: Sequence[str], row: type[Row]) -> list[Row]:
    file = str(path)
    reader = csv.reader(io.StringIO(read_text(path).removeprefix("\ufeff"), newline=""), strict=True)
    rows: list[Row] = []
    problems: list[Problem] = []
    try:
        header = [name.strip() for name in next(reader, [])]
        _check_header(header, columns, Location(file, 1))
        for cells in reader:
            where = Location(file, reader.line_num)
            if not any(cell.strip() for cell in cells):
                continue
            if len(cells) != len(header):
                problems.append(Problem(f"{len(cells)} values for {len(header)} columns", where))
                continue
            try:
                rows.append(checked({name: cell.strip() for name, cell in zip(header, cells, strict=True)}, row, where))
            except InputError as error:
                problems += error.problems
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
