"""Reading a campaign's results, while it runs as well."""

from __future__ import annotations

import json
import sqlite3
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from rosa_core.errors import Location, Problem
from rosa_evaluation.campaign.schema import FILE_NAME, RESULTS, ResultsError, RunState
from rosa_simulation.run_record import MissionEvent, Reaction, RunRecord


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


class Results:
    """The results in a directory, for reading only. A context manager.

    Args:
        directory: that a campaign writes or has written.

    Raises:
        ResultsError: if there are none, or they cannot be read.
    """

    def __init__(self, directory: str | PathLike[str]) -> None:
        self.path = Path(directory).absolute() / FILE_NAME
        if not self.path.is_file():
            what, hint = "there are no results here", "name a directory that was given to rosa campaign --out"
            raise ResultsError(Problem(what, Location(str(directory)), hint))
        self._connection = RESULTS.open_to_read(self.path)
        self._connection.row_factory = sqlite3.Row
        try:
            with RESULTS.accessing(self.path):
                RESULTS.check_pages(self._connection, self.path)
        except BaseException:
            self._connection.close()
            raise

    def close(self) -> None:
        """Let go of the file."""
        self._connection.close()

    def __enter__(self) -> Results:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def campaigns(self) -> list[StoredCampaign]:
        """All campaigns, in the order in which they were begun.

        Raises:
            ResultsError: if the file is damaged.
        """
        query = (
            "SELECT *, (SELECT count(*) FROM planned LEFT JOIN runs USING (run_id)"
            " WHERE planned.campaign_id = campaigns.campaign_id AND runs.run_id IS NULL) AS missing"
            " FROM campaigns ORDER BY begun_at, campaign_id"
        )
        with RESULTS.accessing(self.path):
            return [_campaign(row) for row in self._connection.execute(query)]

    def runs(self, campaign_id: str) -> list[StoredRun]:
        """The runs of a campaign that are done or have failed.

        Args:
            campaign_id: of a :class:`StoredCampaign`.

        Returns:
            the runs in the order of the plan; nothing if there is no such campaign.

        Raises:
            ResultsError: if the file is damaged.
        """
        query = (
            "SELECT runs.*, manager_name FROM planned JOIN runs USING (run_id) WHERE campaign_id = ? ORDER BY position"
        )
        with self._consistent():
            reactions = self._reactions(campaign_id)
            rows = self._connection.execute(query, (campaign_id,)).fetchall()
            return [_run(row, reactions.get(row["run_id"], {})) for row in rows]

    def record(self, run_id: str) -> RunRecord:
        """Everything about one run that is done, as it was when it ended.

        Args:
            run_id: as in :class:`StoredRun`.

        Raises:
            ResultsError: if there is no such run, or it failed.
        """
        with self._consistent():
            query = "SELECT runs.*, manager AS manager_name FROM runs WHERE run_id = ? AND state = 'done'"
            row = self._connection.execute(query, (run_id,)).fetchone()
            if row is None:
                raise ResultsError(Problem(f"there is no run '{run_id}' that is done", Location(str(self.path))))
            run = _run(row, self._reactions(run_id=run_id).get(run_id, {}))
            columns, trajectory = self._trajectory(run_id)
            return RunRecord(
                scenario=run.scenario,
                manager=run.manager,
                task_layer=run.task_layer,
                seed=run.seed,
                completed=run.completed,
                ended_by=run.ended_by,
                duration_s=run.duration_s,
                inputs=run.inputs,
                metrics=run.metrics,
                reactions=run.reactions,
                events=tuple(self._events(run_id)),
                trajectory_columns=columns,
                trajectory=tuple(tuple(sample) for sample in trajectory.tolist()),
                wall_clock_s=run.wall_clock_s,
                managing_s=run.managing_s,
                versions=run.versions,
            )

    def trajectory(self, run_id: str) -> tuple[tuple[str, ...], np.ndarray[tuple[int, int], np.dtype[np.float64]]]:
        """The trajectory of a run.

        Args:
            run_id: of a run that is done.

        Returns:
            the names of the columns (with their units, such as ``x_m``), and the samples, of shape (samples, columns).

        Raises:
            ResultsError: if there is no such run, or it failed.
        """
        with RESULTS.accessing(self.path):
            return self._trajectory(run_id)

    def _trajectory(self, run_id: str) -> tuple[tuple[str, ...], np.ndarray[tuple[int, int], np.dtype[np.float64]]]:
        query = "SELECT columns, samples, data FROM trajectories WHERE run_id = ?"
        row = self._connection.execute(query, (run_id,)).fetchone()
        if row is None:
            raise ResultsError(Problem(f"there is no trajectory of run '{run_id}'", Location(str(self.path))))
        columns = tuple(map(str, json.loads(row["columns"])))
        size = 8 * row["samples"] * len(columns)
        decompressor = zlib.decompressobj()
        try:
            data = decompressor.decompress(row["data"], size + 1)
        except zlib.error as error:
            raise RESULTS.damaged(self.path, f"the trajectory of run '{run_id}': {error}") from None
        if len(data) != size:
            raise RESULTS.damaged(self.path, f"the trajectory of run '{run_id}' has another length")
        return columns, np.frombuffer(data, dtype="<f8").reshape(row["samples"], len(columns))

    def _events(self, run_id: str) -> Iterator[MissionEvent]:
        query = "SELECT time_s, text, facts FROM events WHERE run_id = ? ORDER BY position"
        for row in self._connection.execute(query, (run_id,)):
            yield MissionEvent(row["time_s"], row["text"], tuple(json.loads(row["facts"])))

    def _reactions(
        self, campaign_id: str | None = None, run_id: str | None = None
    ) -> dict[str, dict[str, tuple[Reaction, ...]]]:
        """Reactions by run and uncertainty, of one campaign or one run."""
        query = (
            "SELECT * FROM reactions WHERE run_id = ?1 OR run_id IN"
            " (SELECT run_id FROM planned WHERE campaign_id = ?2) ORDER BY run_id, uncertainty, position"
        )
        found: dict[str, dict[str, tuple[Reaction, ...]]] = {}
        for row in self._connection.execute(query, (run_id, campaign_id)):
            several = found.setdefault(row["run_id"], {})
            reaction = Reaction(row["cause_s"], row["delay_s"], row["compute_s"])
            several[row["uncertainty"]] = (*several.get(row["uncertainty"], ()), reaction)
        return found

    @contextmanager
    def _consistent(self) -> Iterator[None]:
        """Several queries see the same state, whatever is written meanwhile."""
        with RESULTS.accessing(self.path):
            self._connection.execute("BEGIN")
            try:
                yield
            finally:
                self._connection.execute("ROLLBACK")


def _campaign(row: sqlite3.Row) -> StoredCampaign:
    managers = {name: (manager, layer) for name, (manager, layer) in json.loads(row["managers"]).items()}
    return StoredCampaign(
        campaign_id=row["campaign_id"],
        scenario=row["scenario"],
        managers=managers,
        seeds=range(row["first_seed"], row["first_seed"] + row["runs"]),
        experiment_name=row["experiment_name"],
        experiment=json.loads(row["experiment"]),
        versions=json.loads(row["versions"]),
        begun_at=row["begun_at"],
        missing=row["missing"],
    )


def _run(row: sqlite3.Row, reactions: Mapping[str, tuple[Reaction, ...]]) -> StoredRun:
    state = RunState(row["state"])
    done = state is RunState.DONE
    uncertainties = json.loads(row["uncertainties"]) if done else []
    return StoredRun(
        run_id=row["run_id"],
        scenario=row["scenario"],
        manager=row["manager"],
        task_layer=row["task_layer"],
        manager_name=row["manager_name"],
        seed=row["seed"],
        parameters=json.loads(row["parameters"]),
        versions=json.loads(row["versions"]),
        state=state,
        finished_at=row["finished_at"],
        error=row["error"],
        completed=bool(row["completed"]),
        ended_by=row["ended_by"] or "",
        duration_s=row["duration_s"] or 0.0,
        inputs=json.loads(row["inputs"]) if done else {},
        metrics=json.loads(row["metrics"]) if done else {},
        reactions={name: reactions.get(name, ()) for name in uncertainties},
        wall_clock_s=row["wall_clock_s"] or 0.0,
        managing_s=row["managing_s"] or 0.0,
    )
