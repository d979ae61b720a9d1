"""Reads the run records that ``rosa run --out`` writes."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from rosa_core.formats.text_source import read_text
from rosa_simulation.run_record import MissionEvent, Reaction, RecordedPlan, RunRecord

RUN_FILE = "run.json"
_TIMED_FILE = "wall_clock.json"
_MEND = "name a directory that was given to rosa run --out"


def read_run(directory: str | PathLike[str]) -> RunRecord:
    """The run whose record is in a directory, as it was when it ended.

    Raises:
        InputError: if there is none, or it is not as it was written; with the file and, where it has lines, the line.
    """
    path = Path(directory)
    if not (path / RUN_FILE).is_file():
        raise InputError(Problem("there is no run record here", Location(str(directory)), _MEND))
    run, timed = _object(path / RUN_FILE), _object(path / _TIMED_FILE)
    columns, trajectory = _trajectory(path / "trajectory.csv")
    try:
        return RunRecord(
            scenario=_text(run["scenario"]),
            manager=_text(run["manager"]),
            task_layer=_text(run["task_layer"]),
            seed=int(run["seed"]),
            completed=bool(run["completed"]),
            ended_by=_text(run["ended_by"]),
            duration_s=_number(run["duration_s"]),
            inputs=dict(run["inputs"]),
            metrics={**run["metrics"], **timed["metrics"]},
            reactions={name: tuple(_reactions(run, timed, name)) for name in run["reactions"]},
            events=tuple(_events(path / "events.jsonl")),
            trajectory_columns=columns,
            trajectory=trajectory,
            wall_clock_s=_number(timed["wall_clock_s"]),
            managing_s=_number(timed["managing_s"]),
            versions={str(name): str(version) for name, version in run["versions"].items()},
            plans=tuple(_plans(run, timed)),
        )
    except KeyError as error:
        raise _damaged(path, f"{RUN_FILE} or {_TIMED_FILE} has no {error}") from None
    except (TypeError, ValueError, AttributeError) as error:
        raise _damaged(path, f"{RUN_FILE} or {_TIMED_FILE}: {error}") from None


def _reactions(run: Mapping[str, Any], timed: Mapping[str, Any], name: str) -> Iterator[Reaction]:
    for reaction, compute in zip(run["reactions"][name], timed["compute_s"][name], strict=True):
        yield Reaction(_number(reaction["cause_s"]), _number(reaction["delay_s"]), _number(compute))


def _plans(run: Mapping[str, Any], timed: Mapping[str, Any]) -> Iterator[RecordedPlan]:
    for plan, cost in zip(run.get("plans", ()), timed.get("planning_s", ()), strict=True):
        yield RecordedPlan(**{**plan, "steps": tuple(plan["steps"])}, cost_s=_number(cost))


def _events(path: Path) -> Iterator[MissionEvent]:
    for number, line in enumerate(read_text(path).splitlines(), 1):
        try:
            event = json.loads(line)
            yield MissionEvent(_number(event["time_s"]), _text(event["text"]), tuple(map(dict, event["facts"])))
        except (KeyError, TypeError, ValueError, RecursionError):
            raise _damaged(path, "this is not an event", number) from None


def _trajectory(path: Path) -> tuple[tuple[str, ...], tuple[tuple[float, ...], ...]]:
    reader = csv.reader(read_text(path).splitlines(), strict=True)
    try:
        columns = tuple(next(reader, ()))
        rows = tuple(tuple(map(_number, cells)) for cells in reader)
    except (csv.Error, ValueError) as error:
        raise _damaged(path, str(error), reader.line_num) from None
    if any(len(row) != len(columns) for row in rows):
        raise _damaged(path, f"not every row has {len(columns)} values")
    return columns, rows


def _object(path: Path) -> dict[str, Any]:
    try:
        document = json.loads(read_text(path))
    except (ValueError, RecursionError) as error:
        raise _damaged(path, f"not valid JSON: {error}") from None
    if not isinstance(document, dict):
        raise _damaged(path, "not a JSON object")
    return document


def _number(value: Any) -> float:
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"'{value}' is not a finite number")
    return number


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{value!r} is not text")
    return value


def _damaged(path: Path, what: str, line: int | None = None) -> InputError:
    return InputError(Problem(f"the run record is damaged: {what}", Location(str(path), line), _MEND))
