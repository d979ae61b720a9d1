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

from enum import StrEnum

from rosa_core import InputError
from rosa_core.sqlite_file import SqliteFormat

FILE_NAME = "runs.sqlite"


class ResultsError(InputError):
    """Results that cannot be used: none, another program's, damaged, or written by another campaign just now."""


class RunState(StrEnum):
    """What became of a run that is recorded."""

    DONE = "done"
    FAILED = "failed"


RESULTS = SqliteFormat(
    noun="results file",
    application_id=0x524F5352,  # ROSR
    version=1,
    tables=(
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
    ),
    error=ResultsError,
    writer="another campaign",
    use_hint="wait for it, or name another directory with --out",
    foreign_hint="name another directory with --out, or move the file away",
    damage_hint="restore the file from a copy, or move it away and run the campaign again",
)
