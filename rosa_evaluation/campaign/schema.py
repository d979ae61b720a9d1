"""The tables of ``runs.sqlite``, and what is said of a file that does not have them.

``campaigns``
    one row for each plan that was begun here. ``managers``, ``experiment`` and ``versions`` are JSON;
    ``experiment`` is the content of the experiment file, ``{}`` without one.
``planned``
    which run stands where in which campaign, and what its manager was called on the command line. A run that has no
    row in ``runs`` is still to be done. A run can be in several campaigns.
``runs``
    one row for each run that is done or has failed. ``inputs``, ``parameters`` (those that the experiment set),
    ``versions``, ``metrics`` and ``uncertainties`` (those that reactions were looked for) are JSON. A failed run has a
    traceback or another reason in ``error`` and nothing in the columns after it. ``finished_at`` is the date in UTC,
    ISO 8601; durations are in s.
``reactions``
    one row for each adaptation to an uncertainty, times in s; the reaction time is ``delay_s + compute_s``.
``events``
    what happened, as text and as JSON facts; ``time_s`` is mission time.
``trajectories``
    ``data`` holds ``samples`` rows of ``columns`` (JSON), as little-endian 64-bit floats, compressed with zlib.

All rows about a run are written in one transaction.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path

from rosa_core import InputError
from rosa_core.errors import Location, Problem

FILE_NAME = "runs.sqlite"
APPLICATION_ID = 0x524F5352
"""``ROSR``, in the header of the file: what tools such as file(1) know a SQLite database's purpose by."""
VERSION = 1

TABLES = (
    "CREATE TABLE campaigns (campaign_id TEXT PRIMARY KEY, scenario TEXT NOT NULL, managers TEXT NOT NULL,"
    " first_seed INTEGER NOT NULL, runs INTEGER NOT NULL, experiment_name TEXT NOT NULL, experiment TEXT NOT NULL,"
    " versions TEXT NOT NULL, begun_at TEXT NOT NULL)",
    "CREATE TABLE planned (campaign_id TEXT NOT NULL REFERENCES campaigns, position INTEGER NOT NULL,"
    " run_id TEXT NOT NULL, manager_name TEXT NOT NULL, PRIMARY KEY (campaign_id, position)) WITHOUT ROWID",
    "CREATE TABLE runs (run_id TEXT PRIMARY KEY, scenario TEXT NOT NULL, manager TEXT NOT NULL,"
    " task_layer TEXT NOT NULL, seed INTEGER NOT NULL, parameters TEXT NOT NULL, versions TEXT NOT NULL,"
    " state TEXT NOT NULL CHECK (state IN ('done', 'failed')), finished_at TEXT NOT NULL, error TEXT,"
    " completed INTEGER, ended_by TEXT, duration_s REAL, inputs TEXT, metrics TEXT, uncertainties TEXT,"
    " wall_clock_s REAL, managing_s REAL)",
    "CREATE TABLE reactions (run_id TEXT NOT NULL REFERENCES runs ON DELETE CASCADE, uncertainty TEXT NOT NULL,"
    " position INTEGER NOT NULL, cause_s REAL NOT NULL, delay_s REAL NOT NULL, compute_s REAL NOT NULL,"
    " PRIMARY KEY (run_id, uncertainty, position)) WITHOUT ROWID",
    "CREATE TABLE events (run_id TEXT NOT NULL REFERENCES runs ON DELETE CASCADE, position INTEGER NOT NULL,"
    " time_s REAL NOT NULL, text TEXT NOT NULL, facts TEXT NOT NULL, PRIMARY KEY (run_id, position)) WITHOUT ROWID",
    "CREATE TABLE trajectories (run_id TEXT PRIMARY KEY REFERENCES runs ON DELETE CASCADE, columns TEXT NOT NULL,"
    " samples INTEGER NOT NULL, data BLOB NOT NULL)",
)


class ResultsError(InputError):
    """Results that cannot be used: none, another program's, damaged, or written by another campaign just now."""


class RunState(StrEnum):
    """What became of a run that is recorded."""

    DONE = "done"
    FAILED = "failed"


@contextmanager
def accessing(path: Path) -> Iterator[None]:
    """Turns what SQLite and the decoders find wrong into the error that says so.

    Raises:
        ResultsError: for every error of SQLite and every unreadable row.
    """
    try:
        yield
    except sqlite3.Error as error:
        raise _unusable(path, error) from None
    except (ValueError, TypeError, KeyError, IndexError) as error:
        raise damaged(path, f"{type(error).__name__}: {error}") from None


def check_format(connection: sqlite3.Connection, path: Path) -> None:
    """That the database is one of results, in this version's format.

    Raises:
        ResultsError: if it is not.
        sqlite3.Error: if it cannot be read.
    """
    if connection.execute("PRAGMA application_id").fetchone()[0] != APPLICATION_ID:
        raise _foreign(path, "this is a database, but not one of a campaign's results")
    version = connection.execute("PRAGMA user_version").fetchone()[0]
    if version != VERSION:
        what = f"these results have format {version}; this version reads format {VERSION}"
        raise ResultsError(Problem(what, Location(str(path)), "use the version that wrote them"))
    found = connection.execute("PRAGMA quick_check(1)").fetchone()[0]
    if found != "ok":
        raise damaged(path, str(found))


def damaged(path: Path, what: str) -> ResultsError:
    """The results are not as they were written."""
    hint = "restore the file from a copy, or move it away and run the campaign again"
    return ResultsError(Problem(f"the results are damaged: {what}", Location(str(path)), hint))


def in_use(path: Path) -> ResultsError:
    """Somebody else writes the results."""
    hint = "wait for it, or name another directory with --out"
    return ResultsError(Problem("another campaign writes here just now", Location(str(path)), hint))


def _foreign(path: Path, what: str) -> ResultsError:
    return ResultsError(Problem(what, Location(str(path)), "name another directory with --out, or move the file away"))


def _unusable(path: Path, error: sqlite3.Error) -> ResultsError:
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    if code == sqlite3.SQLITE_NOTADB:
        return _foreign(path, "this is not a database of a campaign's results")
    if code == sqlite3.SQLITE_BUSY:
        return in_use(path)
    if code in (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM):
        hint = "does the directory exist, and may you read and write in it?"
        return ResultsError(Problem("the results cannot be opened", Location(str(path)), hint))
    if code in (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR):
        hint = "make room; what was finished before is kept, and the same command goes on"
        return ResultsError(Problem(f"cannot write: {error}", Location(str(path)), hint))
    return damaged(path, str(error))
