"""Reads the run records that ``rosa run --out`` writes."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, Field

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_core.formats.checked_file import Flag, Number, Text, Whole, checked, parsed_json, read_json
from rosa_core.formats.text_source import read_text
from rosa_simulation.run_record import AwaitedAction, MissionEvent, Reaction, RecordedPlan, RunRecord

RUN_FILE = "run.json"
_TIMED_FILE = "wall_clock.json"
_HINT = "name a directory that was given to rosa run --out"


class _ReactionEntry(BaseModel):
    cause_s: Number
    delay_s: Number


class _PlanEntry(BaseModel):
    time_s: Number
    reason: str
    steps: tuple[str, ...]
    kept: Whole
    no_plan: str
    cached: Flag
    engine: str


class _AwaitedEntry(BaseModel):
    action: str
    reason: str
    remedies: tuple[str, ...]


class _RunEntry(BaseModel):
    scenario: Text
    manager: Text
    task_layer: Text
    seed: Whole
    completed: Flag
    ended_by: str
    duration_s: Number
    inputs: dict[str, Any]
    metrics: dict[str, Any]
    reactions: dict[str, tuple[_ReactionEntry, ...]]
    versions: dict[str, str]
    plans: tuple[_PlanEntry, ...] = ()
    waiting_for: tuple[_AwaitedEntry, ...] = ()


class _TimedEntry(BaseModel):
    wall_clock_s: Number
    managing_s: Number
    metrics: dict[str, Any]
    compute_s: dict[str, tuple[Number, ...]]
    planning_s: tuple[Number, ...] = ()


class _EventEntry(BaseModel):
    time_s: Number
    text: str
    facts: tuple[dict[str, Any], ...]


# The numbers of a table are text.
_Row = tuple[Annotated[float, Field(allow_inf_nan=False)], ...]


def read_run(directory: str | PathLike[str]) -> RunRecord:
    """The run whose record is in a directory, as it was when it ended.

    Args:
        directory: where the run was written to.

    Raises:
        InputError: if there is none, or it is not as it was written; with the file and, where it has lines, the line.
    """
    path = Path(directory)
    if not (path / RUN_FILE).is_file():
        raise InputError(Problem("there is no run record here", Location(str(directory)), _HINT))
    try:
        return _record(path)
    except InputError as error:
        problems = [Problem(f"the run record is damaged: {p.what}", p.where, p.hint or _HINT) for p in error.problems]
        raise InputError(problems) from None


def _record(path: Path) -> RunRecord:
    run, timed = read_json(path / RUN_FILE, _RunEntry), read_json(path / _TIMED_FILE, _TimedEntry)
    columns, trajectory = _trajectory(path / "trajectory.csv")
    try:
        reactions = {name: tuple(_timed(several, timed.compute_s[name])) for name, several in run.reactions.items()}
        costs = zip(run.plans, timed.planning_s, strict=True)
        plans = tuple(RecordedPlan(**plan.model_dump(), cost_s=cost) for plan, cost in costs)
    except (KeyError, ValueError):
        raise InputError(Problem(f"it is not of the run in {RUN_FILE}", Location(str(path / _TIMED_FILE)))) from None
    return RunRecord(
        **run.model_dump(exclude={"metrics", "reactions", "plans", "waiting_for"}),
        metrics={**run.metrics, **timed.metrics},
        reactions=reactions,
        events=tuple(_events(path / "events.jsonl")),
        trajectory_columns=columns,
        trajectory=trajectory,
        wall_clock_s=timed.wall_clock_s,
        managing_s=timed.managing_s,
        plans=plans,
        waiting_for=tuple(AwaitedAction(**awaited.model_dump()) for awaited in run.waiting_for),
    )


def _timed(several: tuple[_ReactionEntry, ...], costs: tuple[float, ...]) -> Iterator[Reaction]:
    for reaction, cost in zip(several, costs, strict=True):
        yield Reaction(reaction.cause_s, reaction.delay_s, cost)


def _events(path: Path) -> Iterator[MissionEvent]:
    for number, line in enumerate(read_text(path).splitlines(), 1):
        where = Location(str(path), number)
        event = checked(parsed_json(line, where), _EventEntry, where)
        yield MissionEvent(event.time_s, event.text, event.facts)


def _trajectory(path: Path) -> tuple[tuple[str, ...], tuple[tuple[float, ...], ...]]:
    reader = csv.reader(read_text(path).splitlines(), strict=True)
    rows: list[tuple[float, ...]] = []
    try:
        columns = tuple(next(reader, ()))
        for cells in reader:
            rows.append(checked(cells, _Row, Location(str(path), reader.line_num)))
            if len(cells) != len(columns):
                what = f"{len(cells)} values for {len(columns)} columns"
                raise InputError(Problem(what, Location(str(path), reader.line_num)))
    except csv.Error as error:
        raise InputError(Problem(f"not valid CSV: {error}", Location(str(path), reader.line_num))) from None
    return columns, tuple(rows)
