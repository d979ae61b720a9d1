"""The rows of ``runs.sqlite`` as Python has them, checked: SQLite keeps any value in any column.

Each function raises a ValueError that says which cell is not as it was written.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, BaseModel, BeforeValidator, Field, ValidationError

from rosa_core.formats.checked_file import Number, Text
from rosa_evaluation.campaign.schema import RunState
from rosa_simulation.run_record import MissionEvent, Reaction

Row = TypeVar("Row", bound=BaseModel)


@dataclass(frozen=True, slots=True)
class StoredCampaign:
    """A campaign that was begun.

    Attributes:
        managers: names on the command line, with manager and task layer.
        experiment_name: empty if nothing was set.
        experiment: the content of the experiment file.
        begun_at: the date and time, in ISO 8601.
        missing: how many of its runs have not been carried out.
    """

    campaign_id: str
    scenario: str
    managers: Mapping[str, tuple[str, str]]
    seeds: range
    experiment_name: str
    experiment: Mapping[str, Any]
    versions: Mapping[str, str]
    begun_at: str
    missing: int


@dataclass(frozen=True, slots=True)
class StoredRun:
    """A run without its events and trajectory. Of a failed one only the fields up to ``error`` mean something.

    Attributes:
        manager_name: what the manager was called on the command line, such as ``rosa-pddl``.
        parameters: what the experiment set.
        finished_at: date in UTC, ISO 8601.
        error: the traceback of a failed run.
        reactions: by uncertainty, in the order in which they happened.
    """

    run_id: str
    scenario: str
    manager: str
    task_layer: str
    manager_name: str
    seed: int
    parameters: Mapping[str, Any]
    versions: Mapping[str, str]
    state: RunState
    finished_at: str
    error: str | None
    completed: bool
    ended_by: str
    duration_s: float
    inputs: Mapping[str, Any]
    metrics: Mapping[str, Any]
    reactions: Mapping[str, tuple[Reaction, ...]]
    wall_clock_s: float
    managing_s: float


def stored_campaign(row: sqlite3.Row) -> StoredCampaign:
    """A campaign of its row in ``campaigns``, with the number of runs that are ``missing``."""
    cells = _checked(row, _CampaignRow)
    seeds = range(cells.first_seed, cells.first_seed + cells.runs)
    return StoredCampaign(**cells.model_dump(exclude={"first_seed", "runs"}), seeds=seeds)


def stored_run(row: sqlite3.Row, reactions: Mapping[str, tuple[Reaction, ...]]) -> StoredRun:
    """A run of its row in ``runs``, with the ``manager_name`` that it was planned with."""
    done = row["state"] == RunState.DONE
    cells: _DoneRow | _FailedRow = _checked(row, _DoneRow) if done else _checked(row, _FailedRow)
    values = cells.model_dump(exclude={"uncertainties"})
    return StoredRun(**values, reactions={name: reactions.get(name, ()) for name in cells.uncertainties})


def stored_reaction(row: sqlite3.Row) -> tuple[str, str, Reaction]:
    """The run, the uncertainty and the times of a row in ``reactions``."""
    cells = _checked(row, _ReactionRow)
    return cells.run_id, cells.uncertainty, Reaction(cells.cause_s, cells.delay_s, cells.compute_s)


def stored_event(row: sqlite3.Row) -> MissionEvent:
    """An event of its row in ``events``."""
    cells = _checked(row, _EventRow)
    return MissionEvent(cells.time_s, cells.text, cells.facts)


def trajectory_shape(row: sqlite3.Row) -> tuple[tuple[str, ...], int, bytes]:
    """Columns, number of samples and compressed data of a row in ``trajectories``."""
    cells = _checked(row, _TrajectoryRow)
    return cells.columns, cells.samples, cells.data


def _date(text: str) -> str:
    datetime.fromisoformat(text)
    return text


def _json(text: object) -> object:
    if not isinstance(text, str):
        raise ValueError("text is expected")
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("it is nested too deeply") from None


_JSON = BeforeValidator(_json)
_Int = Annotated[int, Field(strict=True)]
_Count = Annotated[int, Field(strict=True, ge=0, le=2**53)]
_Str = Annotated[str, Field(strict=True)]
_Date = Annotated[str, Field(strict=True), AfterValidator(_date)]
_Table = Annotated[dict[str, Any], _JSON]
_Versions = Annotated[dict[str, str], _JSON]


class _CampaignRow(BaseModel):
    campaign_id: Text
    scenario: Text
    managers: Annotated[dict[str, tuple[str, str]], _JSON]
    first_seed: _Count
    runs: _Count
    experiment_name: _Str
    experiment: _Table
    versions: _Versions
    begun_at: _Str
    missing: _Count


class _RecordedRow(BaseModel):
    run_id: Text
    scenario: Text
    manager: Text
    task_layer: Text
    manager_name: Text
    seed: _Int
    parameters: _Table
    versions: _Versions
    state: RunState
    finished_at: _Date
    error: _Str | None


class _DoneRow(_RecordedRow):
    completed: Annotated[int, Field(strict=True, ge=0, le=1), AfterValidator(bool)]
    ended_by: _Str
    duration_s: Number
    inputs: _Table
    metrics: _Table
    uncertainties: Annotated[tuple[str, ...], _JSON]
    wall_clock_s: Number
    managing_s: Number


class _FailedRow(_RecordedRow):
    # The columns after the error hold nothing, and are not read.
    completed: bool = False
    ended_by: str = ""
    duration_s: float = 0.0
    inputs: dict[str, Any] = Field(default_factory=dict)
    metrics: dict[str, Any] = Field(default_factory=dict)
    uncertainties: tuple[str, ...] = ()
    wall_clock_s: float = 0.0
    managing_s: float = 0.0


_IDENTITIES = (("run", "run_id"), ("campaign", "campaign_id"))
_FAILED_COLUMNS = frozenset(_RecordedRow.model_fields)


class _ReactionRow(BaseModel):
    run_id: _Str
    uncertainty: _Str
    cause_s: Number
    delay_s: Number
    compute_s: Number


class _EventRow(BaseModel):
    time_s: Number
    text: _Str
    facts: Annotated[tuple[dict[str, Any], ...], _JSON]


class _TrajectoryRow(BaseModel):
    columns: Annotated[tuple[str, ...], _JSON]
    samples: _Count
    data: Annotated[bytes, Field(strict=True)]


def _checked(row: sqlite3.Row, model: type[Row]) -> Row:
    names = _FAILED_COLUMNS if model is _FailedRow else row.keys()
    try:
        return model.model_validate({name: row[name] for name in names})
    except ValidationError as error:
        details = error.errors(include_url=False, include_input=False)[0]
        column, reason = details["loc"][0], details.get("ctx", {}).get("error", "it is not as it was written")
        cells = dict(zip(row.keys(), row, strict=True))
        of = next((f" of {noun} '{cells[key]}'" for noun, key in _IDENTITIES if isinstance(cells.get(key), str)), "")
        raise ValueError(f"{reason}, in the cell '{column}'{of}") from None
