"""The file of a journal: its tables, and reading them while nobody, or another process, writes.

A journal is a SQLite database. ``writes`` has one row for every write that changed something: the facts that it changed
and the status changes that followed. ``snapshots`` has all facts at some writes, so that reopening starts there, and
``models`` the model at the beginning and wherever a snapshot found it changed. Every row has a checksum.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import TracebackType

from rosa_core.errors import JournalError, KnowledgeModelError, Location, Problem
from rosa_core.journal.codec import changes_from_text, checksum, facts_from_text
from rosa_core.model.canonical import model_from_text
from rosa_core.model.facts import Fact, PlanEnded
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.records import (
    TOPICS,
    EndedPlan,
    HistoryEntry,
    Measurement,
    RequiredAction,
    StatusChange,
    TimedStatusChange,
    concerns,
)
from rosa_core.sqlite_file import SqliteFormat

# With these the writes about one topic are found without decoding the others. An index on it would double what
# a write costs, to spare a scan that takes a tenth of a second for a million writes.
TOPIC_BITS = {topic: 1 << position for position, topic in enumerate(TOPICS)}

JOURNAL = SqliteFormat(
    noun="journal",
    application_id=0x524F5341,  # ROSA
    version=1,
    tables=(
        "CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL, checksum INTEGER NOT NULL) WITHOUT ROWID",
        "CREATE TABLE models (sequence INTEGER PRIMARY KEY, model TEXT NOT NULL, checksum INTEGER NOT NULL)",
        "CREATE TABLE snapshots (sequence INTEGER PRIMARY KEY, revision INTEGER NOT NULL, time REAL NOT NULL,"
        " facts TEXT NOT NULL, checksum INTEGER NOT NULL)",
        "CREATE TABLE writes (sequence INTEGER PRIMARY KEY, revision INTEGER NOT NULL, time REAL NOT NULL,"
        " topics INTEGER NOT NULL, facts TEXT NOT NULL, statuses TEXT, checksum INTEGER NOT NULL)",
    ),
    error=JournalError,
    writer="another knowledge base",
    use_hint="close that one first, or use another file",
    foreign_hint="name the file that was given as journal=...",
    damage_hint="restore the file from a copy, or start a new journal",
)


def topics_of(facts: Sequence[Fact], changes: Sequence[StatusChange]) -> int:
    """Which topics of history a write adds to, as bits."""
    bits = TOPIC_BITS["statuses"] if changes else 0
    for fact in facts:
        match fact:
            case Measurement():
                bits |= TOPIC_BITS["measurements"]
            case RequiredAction(result=result) if result is not None:
                bits |= TOPIC_BITS["required_actions"]
            case PlanEnded():
                bits |= TOPIC_BITS["reconfiguration_plans"]
    return bits


@dataclass(frozen=True, slots=True)
class JournalledWrite:
    """One write: ``sequence`` counts from 1; ``time`` is in seconds, from the knowledge base's clock.

    A write that changed facts without anything to announce has the revision of the one before.
    """

    sequence: int
    revision: int
    time: float
    facts: tuple[Fact, ...]
    statuses: tuple[StatusChange, ...]

    def entries(self, topic: str) -> Iterator[HistoryEntry]:
        """What the write adds to the history of a topic."""
        if topic == "statuses":
            yield from (TimedStatusChange(change, self.time) for change in self.statuses)
            return
        for fact in self.facts:
            match fact:
                case Measurement() if topic == "measurements":
                    yield fact
                case RequiredAction(result=result) if topic == "required_actions" and result is not None:
                    yield fact
                case PlanEnded(plan, result) if topic == "reconfiguration_plans":
                    yield EndedPlan(plan, self.time, result)


@dataclass(frozen=True, slots=True)
class Snapshot:
    """All facts after a write."""

    sequence: int
    revision: int
    time: float
    facts: tuple[Fact, ...]


class JournalTables:
    """Typed reading of an open journal's tables. Errors of SQLite are not turned into others here."""

    def __init__(self, connection: sqlite3.Connection, path: Path) -> None:
        self.connection = connection
        self.path = path

    def meta(self, key: str) -> str:
        """A property of the whole journal."""
        row = self.connection.execute("SELECT value, checksum FROM meta WHERE key = ?", (key,)).fetchone()
        if row is None or checksum(key, row[0]) != row[1]:
            raise JOURNAL.damaged(self.path, f"its property '{key}' is missing or altered")
        return str(row[0])

    def model(self, sequence: int | None = None) -> tuple[int, KnowledgeModel]:
        """The latest model that was stored up to a write (the first one if None), and at which write."""
        query = "SELECT sequence, model, checksum FROM models "
        query += (
            "ORDER BY sequence LIMIT 1" if sequence is None else "WHERE sequence <= ? ORDER BY sequence DESC LIMIT 1"
        )
        row = self.connection.execute(query, () if sequence is None else (sequence,)).fetchone()
        if row is None or checksum(row[0], row[1]) != row[2]:
            raise JOURNAL.damaged(self.path, "its model is missing or altered")
        try:
            return row[0], model_from_text(row[1])
        except (ValueError, KnowledgeModelError) as error:
            raise JOURNAL.damaged(self.path, f"its model does not hold together: {error}") from None

    def last_snapshot(self) -> Snapshot:
        """The latest snapshot."""
        row = self.connection.execute("SELECT * FROM snapshots ORDER BY sequence DESC LIMIT 1").fetchone()
        if row is None or checksum(*row[:-1]) != row[-1]:
            raise JOURNAL.damaged(self.path, "its last snapshot is missing or altered")
        sequence, revision, time, facts, _ = row
        return Snapshot(sequence, revision, time, facts_from_text(facts))

    def writes(self, after: int = 0) -> Iterator[JournalledWrite]:
        """The writes after one, in order; a gap among them is an error."""
        expected: int | None = None
        with closing(
            self.connection.execute("SELECT * FROM writes WHERE sequence > ? ORDER BY sequence", (after,))
        ) as rows:
            for row in rows:
                if row[0] != (expected or row[0]):
                    raise JOURNAL.damaged(self.path, f"write {expected} is missing")
                expected = row[0] + 1
                yield self._write(row)

    def range(self) -> tuple[int, int]:
        """The first and last write that is kept; (n + 1, n) when none of the n writes that there were is kept."""
        first, last = self.connection.execute("SELECT min(sequence), max(sequence) FROM writes").fetchone()
        snapshot = self.connection.execute("SELECT max(sequence) FROM snapshots").fetchone()[0] or 0
        return (snapshot + 1, snapshot) if first is None else (first, last)

    def entries(self, topic: str, name: str | None, limit: int) -> list[HistoryEntry]:
        """The latest entries of a topic, oldest first; about one measure, element or action if ``name`` is given."""
        bit = TOPIC_BITS[topic]
        latest_first: list[HistoryEntry] = []
        query = "SELECT * FROM writes WHERE topics & ? ORDER BY sequence DESC"
        with closing(self.connection.execute(query, (bit,))) as rows:
            for row in rows:
                if len(latest_first) >= limit:
                    break
                # Decoding is most of the work, and a topic needs either the facts or the statuses.
                write = self._write(row, facts=topic != "statuses", statuses=topic == "statuses")
                entries = [entry for entry in write.entries(topic) if concerns(entry, name)]
                latest_first.extend(reversed(entries))
        return latest_first[:limit][::-1]

    def _write(
        self, row: tuple[int, int, float, int, str, str | None, int], *, facts: bool = True, statuses: bool = True
    ) -> JournalledWrite:
        """The write of a row, or as much of it as is wanted."""
        sequence, revision, time = row[:3]
        if checksum(*row[:-1]) != row[-1]:
            raise JOURNAL.damaged(self.path, f"write {sequence} is altered")
        return JournalledWrite(
            sequence,
            revision,
            time,
            facts_from_text(row[4]) if facts else (),
            changes_from_text(row[5]) if statuses else (),
        )


class JournalReader(JournalTables):
    """A journal opened for reading only; another process may be writing it. Use it as a context manager.

    Raises:
        JournalError: if there is no such file, or it is not a journal.
    """

    def __init__(self, path: str | PathLike[str]) -> None:
        file = Path(path).absolute()
        if not file.is_file():
            raise JournalError(Problem("there is no such journal", Location(str(path)), "check the name"))
        super().__init__(JOURNAL.open_to_read(file), file)

    def close(self) -> None:
        """Close the file."""
        self.connection.close()

    def __enter__(self) -> JournalReader:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()
