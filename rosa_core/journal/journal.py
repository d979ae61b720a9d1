"""The journal: every write to a knowledge base, durable before it is announced; opening it again restores the state.

A write is one row, inserted by one statement, so that it is there whole or not at all, whenever the process ends. See
:mod:`rosa_core.journal.tables` for the tables.
"""

from __future__ import annotations

import json
import logging
import sqlite3
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Protocol

from rosa_core.errors import InputError, JournalError, JournalWriteError, Location, Problem
from rosa_core.journal.codec import changes_to_text, checksum, facts_to_text
from rosa_core.journal.options import JournalOptions, Retention
from rosa_core.journal.tables import JOURNAL, JournalReader, JournalTables, topics_of
from rosa_core.model.canonical import fingerprint, model_to_text, plain
from rosa_core.model.changes import difference
from rosa_core.model.facts import Fact
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.records import HistoryEntry, StatusChange
from rosa_core.sqlite_file import SqliteWriter

logger = logging.getLogger(__name__)


class Knowledge(Protocol):
    """What a journal makes snapshots of."""

    @property
    def model(self) -> KnowledgeModel:
        """The model as it is now."""
        ...

    def facts(self) -> Iterable[Fact]:
        """The facts that hold now, given the model; the same facts in this order give the same state."""
        ...


@dataclass(frozen=True, slots=True)
class JournalledState:
    """What a journal restores: all facts in order, the model that the first of them is about, and the revision."""

    model: KnowledgeModel
    revision: int
    facts: tuple[Fact, ...]


class Journal:
    """A journal that is being written; only one process, and only one knowledge base in it, can have it.

    Args:
        path: the file; made if it is not there. Beside it are ``-wal`` and ``-shm`` while it is open, and an empty
            ``-lock`` that stays.
        model: the model that the knowledge base begins with, before anything is added at run time. None to maintain a
            journal without knowing its model.
        options: how to keep it.

    Raises:
        JournalError: if the file is no journal, damaged, of another model, in use, or cannot be opened.
    """

    def __init__(self, path: str | PathLike[str], model: KnowledgeModel | None, options: JournalOptions) -> None:
        self.path = Path(path).absolute()
        self._options = options
        self._broken: str | None = None
        self._since_snapshot = 0
        self._snapshot_size = 0
        if model is None and not self.path.is_file():
            raise JournalError(Problem("there is no such journal", Location(str(path)), "check the name"))
        self._file = SqliteWriter(self.path, JOURNAL, create=model is not None, synchronous=options.synchronous)
        self._connection = self._file.connection
        self.tables = JournalTables(self._connection, self.path)
        try:
            with JOURNAL.accessing(self.path):
                self._open(model)
        except BaseException:
            self.release()
            raise

    # -- opening --

    def _open(self, model: KnowledgeModel | None) -> None:
        if self._file.is_new and model is not None:
            self._create(model)
        if model is not None:
            self._check_model(model)
            self._set_meta("retention", json.dumps(plain(self._options.retention)))
        self._sequence = self.tables.range()[1]
        self._files = [self.path, self.path.with_name(self.path.name + "-wal")]
        self._identities = self._identify()

    def _create(self, model: KnowledgeModel) -> None:
        with self._file.transaction():
            JOURNAL.create(self._connection)
            self._set_meta("fingerprint", fingerprint(model))
            self._put_model(0, model)
            self._put_snapshot(0, 0, 0.0, ())

    def _check_model(self, model: KnowledgeModel) -> None:
        """That the journal began with this model."""
        if self.tables.meta("fingerprint") == fingerprint(model):
            return
        _, other = self.tables.model()
        hint = "open it with the model that it began with, or start a new journal"
        found = difference(other, model, ("the journal's model", "the model given"))
        what = f"the journal is of another model: {found}"
        raise JournalError(Problem(what, Location(str(self.path)), hint))

    def last_state(self, model: KnowledgeModel) -> JournalledState:
        """What holds after the last write.

        Args:
            model: the one that the journal began with.

        Raises:
            JournalError: if the journal is damaged.
        """
        with JOURNAL.accessing(self.path):
            snapshot = self.tables.last_snapshot()
            if self._connection.execute("SELECT count(*) FROM models WHERE sequence > 0").fetchone()[0]:
                _, model = self.tables.model(snapshot.sequence)
            facts = list(snapshot.facts)
            revision, sequence = snapshot.revision, snapshot.sequence
            for write in self.tables.writes(after=snapshot.sequence):
                facts.extend(write.facts)
                revision, sequence = write.revision, write.sequence
            self._stored_model = model
            self._snapshot_size = len(snapshot.facts)
            self._since_snapshot = sequence - snapshot.sequence
            if sequence != self._sequence or (self._since_snapshot and self.tables.range()[0] > snapshot.sequence + 1):
                raise JOURNAL.damaged(self.path, f"writes after {snapshot.sequence} are missing")
        return JournalledState(model, revision, tuple(facts))

    # -- writing --

    def append(self, revision: int, time: float, facts: Sequence[Fact], changes: Sequence[StatusChange]) -> None:
        """Make a write durable.

        Args:
            revision: the knowledge base's revision after it.
            time: when, in seconds.
            facts: what it changed, in order.
            changes: the statuses that changed by it.

        Raises:
            JournalWriteError: if that cannot be done; then the journal is as before.
        """
        if self._broken is not None:
            raise self._refusal(self._broken)
        if (missing := self._missing_file()) is not None:
            raise self._refusal(f"{missing} has been removed or replaced")
        sequence = self._sequence + 1
        # -0.0 would come back as 0.0, with another checksum.
        row = (
            sequence,
            revision,
            float(time) + 0.0,
            topics_of(facts, changes),
            facts_to_text(facts),
            changes_to_text(changes),
        )
        try:
            self._connection.execute("INSERT INTO writes VALUES (?, ?, ?, ?, ?, ?, ?)", (*row, checksum(*row)))
        except sqlite3.IntegrityError as error:
            # An interruption came between writing this row and counting it: the file is ahead of the process.
            self._broken = f"it does not match the knowledge base any more; open it again ({error})"
            raise self._refusal(self._broken) from None
        except sqlite3.Error as error:
            if not self._holds(sequence):
                raise self._refusal(str(error)) from None
        self._sequence = sequence
        self._since_snapshot += 1

    def keep_up(self, knowledge: Knowledge, revision: int, time: float) -> None:
        """Make a snapshot and drop old writes, when it is time for that; a failure is logged and tried again."""
        if self._since_snapshot >= max(self._options.snapshot_every, self._snapshot_size):
            try:
                self.snapshot(knowledge, revision, time)
            except sqlite3.Error as error:
                self._since_snapshot = 0
                logger.warning("no snapshot in the journal %s: %s", self.path, error)

    def snapshot(self, knowledge: Knowledge, revision: int, time: float) -> None:
        """Write all facts down, and drop the writes that need not be kept.

        Raises:
            sqlite3.Error: if that fails; then the journal is as before.
        """
        facts = tuple(knowledge.facts())
        with self._file.transaction():
            if knowledge.model is not self._stored_model:
                self._put_model(self._sequence, knowledge.model)
            self._put_snapshot(self._sequence, revision, time, facts)
            self._drop_writes(self._options.retention)
        self._snapshot_size = len(facts)
        if knowledge.model is not self._stored_model:
            self._snapshot_size += sum(map(len, knowledge.model.names.values()))
        self._stored_model = knowledge.model
        self._since_snapshot = 0

    def entries(self, topic: str, name: str | None, limit: int) -> list[HistoryEntry]:
        """The latest entries of a topic, oldest first, by a connection of its own: writers need not wait.

        Raises:
            JournalError: if the journal is damaged or has been removed.
        """
        with JournalReader(self.path) as reader, JOURNAL.accessing(self.path):
            return reader.entries(topic, name, limit)

    def close(self, knowledge: Knowledge, revision: int, time: float) -> None:
        """Make a last snapshot, if there is anything new, and release the file."""
        try:
            if self._since_snapshot and self._broken is None and self._missing_file() is None:
                self.snapshot(knowledge, revision, time)
        except sqlite3.Error as error:
            logger.warning("no snapshot at the end of the journal %s: %s", self.path, error)
        finally:
            self.release()

    # -- inside --

    def compact(self, retention: Retention | None) -> tuple[int, int]:
        """Drop old writes (None: by the retention that the journal was last opened with), and give their space back.

        Returns:
            how many writes were there, and how many are left.

        Raises:
            JournalError: if the journal is damaged, or the disk too full.
        """
        with JOURNAL.accessing(self.path):
            if retention is None:
                retention = Retention(**json.loads(self.tables.meta("retention")))
            before = self._count()
            with self._file.transaction():
                self._drop_writes(retention)
            self._connection.execute("VACUUM")
            return before, self._count()

    def _count(self) -> int:
        first, last = self.tables.range()
        return last - first + 1

    def _drop_writes(self, retention: Retention) -> None:
        """Delete writes up to the latest snapshot before those to keep: from there on, everything can be restored."""
        if retention.keeps_everything:
            return
        first_kept = self._sequence + 1
        if retention.writes is not None:
            first_kept = self._sequence - retention.writes + 1
        if retention.seconds is not None:
            first_kept = min(first_kept, self._first_within(retention.seconds))
        query = "SELECT max(sequence) FROM snapshots WHERE sequence < ?"
        base = self._connection.execute(query, (first_kept,)).fetchone()[0]
        if base is None:
            return
        self._connection.execute("DELETE FROM writes WHERE sequence <= ?", (base,))
        self._connection.execute("DELETE FROM snapshots WHERE sequence < ?", (base,))
        query = "SELECT max(sequence) FROM models WHERE sequence <= ?"
        model = self._connection.execute(query, (base,)).fetchone()[0]
        # The first one stays, for telling what another model has that this one has not.
        self._connection.execute("DELETE FROM models WHERE sequence < ? AND sequence > 0", (model,))

    def _first_within(self, seconds: float) -> int:
        last = self._connection.execute("SELECT time FROM writes WHERE sequence = ?", (self._sequence,)).fetchone()
        if last is None:
            return self._sequence + 1
        query = "SELECT sequence FROM writes WHERE time >= ? ORDER BY sequence LIMIT 1"
        return int(self._connection.execute(query, (last[0] - seconds,)).fetchone()[0])

    def _set_meta(self, key: str, value: str) -> None:
        self._connection.execute("INSERT OR REPLACE INTO meta VALUES (?, ?, ?)", (key, value, checksum(key, value)))

    def _put_model(self, sequence: int, model: KnowledgeModel) -> None:
        text = model_to_text(model)
        self._connection.execute("INSERT INTO models VALUES (?, ?, ?)", (sequence, text, checksum(sequence, text)))

    def _put_snapshot(self, sequence: int, revision: int, time: float, facts: Sequence[Fact]) -> None:
        row = (sequence, revision, float(time) + 0.0, facts_to_text(facts))
        self._connection.execute("INSERT INTO snapshots VALUES (?, ?, ?, ?, ?)", (*row, checksum(*row)))

    def _refusal(self, reason: str) -> JournalWriteError:
        return JournalWriteError(f"the write is refused: the journal {self.path} cannot take it: {reason}")

    def _holds(self, sequence: int) -> bool:
        """Whether a write is there after all, when SQLite has reported an error."""
        try:
            query = "SELECT count(*) FROM writes WHERE sequence = ?"
            return bool(self._connection.execute(query, (sequence,)).fetchone()[0])
        except sqlite3.Error as error:
            self._broken = f"it can be neither read nor written; open it again ({error})"
            return False

    def _identify(self) -> list[tuple[int, int] | None]:
        return [_identity(file) for file in self._files]

    def _missing_file(self) -> Path | None:
        """A file of the journal that is not the one any more that SQLite has open: SQLite would not notice."""
        for file, identity in zip(self._files, self._identities, strict=True):
            if _identity(file) != identity:
                return file
        return None

    def damaged(self, what: str) -> InputError:
        """The error that says in what way the journal is not as it was written."""
        return JOURNAL.damaged(self.path, what)

    def release(self) -> None:
        """Release the file as it is."""
        self._file.release()


def compact_journal(path: str | PathLike[str], retention: Retention | None = None) -> tuple[int, int]:
    """Drop a journal's old writes that its retention, or the one given, does not keep.

    Args:
        path: the file.
        retention: which writes to keep; by default as the journal was last opened with.

    Returns:
        how many writes were there, and how many are left.

    Raises:
        JournalError: if the file is no journal, damaged, or in use.
    """
    journal = Journal(path, None, JournalOptions())
    try:
        return journal.compact(retention)
    finally:
        journal.release()


def _identity(file: Path) -> tuple[int, int] | None:
    try:
        status = file.stat()
    except OSError:
        return None
    return (status.st_dev, status.st_ino)
