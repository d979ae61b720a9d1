"""The one writer of a campaign's results. Whatever has been added stays, however the process ends."""

from __future__ import annotations

import json
import sqlite3
import zlib
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from datetime import UTC, datetime
from os import PathLike
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from rosa_core.clock import Clock, WallClock
from rosa_core.errors import Location, Problem
from rosa_core.sqlite_file import SqliteWriter
from rosa_evaluation.campaign.plan import CampaignPlan, PlannedRun
from rosa_evaluation.campaign.schema import FILE_NAME, RESULTS, ResultsError, RunState
from rosa_simulation.run_record import RunRecord


class ResultsWriter:
    """``runs.sqlite`` in a directory, opened for writing; both are made if they are not there. A context manager.

    While it is open no other process can write the same results; reading is possible at any time.

    Args:
        directory: where results are kept.
        clock: what the dates of runs are taken from.

    Raises:
        ResultsError: if the file there is something else, damaged, or being written by another campaign.
    """

    def __init__(self, directory: str | PathLike[str], clock: Clock | None = None) -> None:
        self.path = Path(directory).absolute() / FILE_NAME
        self._clock = clock or WallClock()
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            what, hint = f"cannot write here: {error.strerror}", "name another directory with --out"
            raise ResultsError(Problem(what, Location(str(directory)), hint)) from None
        self._file = SqliteWriter(self.path, RESULTS)
        self._connection = self._file.connection
        try:
            with RESULTS.accessing(self.path):
                self._open()
        except BaseException:
            self._file.release()
            raise

    def close(self) -> None:
        """Let go of the file; nothing but ``runs.sqlite`` itself is then needed to read it."""
        with closing(self._connection), RESULTS.accessing(self.path):
            # A reader that is there just now keeps the write-ahead log; then it goes at the next opportunity.
            self._connection.execute("PRAGMA busy_timeout = 0")
            try:
                self._connection.execute("PRAGMA journal_mode = DELETE")
            except sqlite3.OperationalError as error:
                if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY:
                    raise
        self._file.release()

    def __enter__(self) -> ResultsWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def begin(self, plan: CampaignPlan) -> dict[str, RunState]:
        """Record what is planned, if it is not recorded yet.

        Args:
            plan: the campaign; it may be recorded already, in part or as a whole.

        Returns:
            the states of those of its runs that are recorded already, by run id.

        Raises:
            ResultsError: if it cannot be written.
        """
        campaign, first = plan.campaign_id, plan.seeds.start
        managers = {spec.name: [spec.manager, spec.task_layer] for spec in plan.managers}
        texts = (_json(managers), first, len(plan.seeds), plan.experiment.name, _json(plan.experiment.document))
        with self._transaction():
            self._connection.execute(
                "INSERT OR IGNORE INTO campaigns VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
                (campaign, plan.scenario.name, *texts, _json(plan.versions), self._date()),
            )
            self._connection.executemany(
                "INSERT OR IGNORE INTO planned VALUES (?, ?, ?, ?)",
                ((campaign, position, run.run_id, run.manager.name) for position, run in enumerate(plan.runs)),
            )
            rows = self._connection.execute(
                "SELECT run_id, state FROM planned JOIN runs USING (run_id) WHERE campaign_id = ?", (campaign,)
            )
            return {run_id: RunState(state) for run_id, state in rows}

    def add(self, run: PlannedRun, record: RunRecord) -> None:
        """Record a run that was carried out, in one transaction. One that is done already stays as it is.

        Args:
            run: as it was planned.
            record: what came of it.

        Raises:
            ResultsError: if it cannot be written.
        """
        outcome = (record.completed, record.ended_by, record.duration_s, _json(record.inputs), _json(record.metrics))
        costs = (_json(list(record.reactions)), record.wall_clock_s, record.managing_s)
        with self._transaction():
            if not self._insert(run, record.scenario, record.versions, RunState.DONE, (None, *outcome, *costs)):
                return
            self._connection.executemany(
                "INSERT INTO reactions VALUES (?, ?, ?, ?, ?, ?)",
                (
                    (run.run_id, name, position, reaction.cause_s, reaction.delay_s, reaction.compute_s)
                    for name, reactions in record.reactions.items()
                    for position, reaction in enumerate(reactions)
                ),
            )
            self._connection.executemany(
                "INSERT INTO events VALUES (?, ?, ?, ?, ?)",
                (
                    (run.run_id, position, event.time_s, event.text, _json([dict(fact) for fact in event.facts]))
                    for position, event in enumerate(record.events)
                ),
            )
            data = zlib.compress(np.asarray(record.trajectory, dtype="<f8").tobytes())
            columns = _json(list(record.trajectory_columns))
            self._connection.execute(
                "INSERT INTO trajectories VALUES (?, ?, ?, ?)", (run.run_id, columns, len(record.trajectory), data)
            )

    def add_failure(self, run: PlannedRun, plan: CampaignPlan, error: str) -> None:
        """Record that a run failed.

        Args:
            run: as it was planned.
            plan: that it is part of.
            error: why, such as a traceback.

        Raises:
            ResultsError: if it cannot be written.
        """
        with self._transaction():
            self._insert(run, plan.scenario.name, plan.versions, RunState.FAILED, (error, *[None] * 8))

    def _insert(
        self, run: PlannedRun, scenario: str, versions: Mapping[str, str], state: RunState, rest: tuple[Any, ...]
    ) -> bool:
        request = run.request
        identity = (run.run_id, scenario, request.manager, request.task_layer, request.seed)
        inputs = (_json(dict(request.parameters)), _json(versions))
        self._connection.execute("DELETE FROM runs WHERE run_id = ? AND state = 'failed'", (run.run_id,))
        inserted = self._connection.execute(
            f"INSERT OR IGNORE INTO runs VALUES ({', '.join('?' * 18)})",  # noqa: S608
            (*identity, *inputs, state, self._date(), *rest),
        )
        return inserted.rowcount == 1

    def _date(self) -> str:
        return datetime.fromtimestamp(self._clock.now(), UTC).isoformat(timespec="seconds")

    def _open(self) -> None:
        self._connection.execute("PRAGMA foreign_keys = ON")
        if self._file.is_new:
            with self._transaction():
                RESULTS.create(self._connection)

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        with RESULTS.accessing(self.path), self._file.transaction():
            yield


def _json(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))
