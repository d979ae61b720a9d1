"""The journal: every write to a knowledge base, durable before it is announced; opening it again restores the state.

A write is one row, inserted by one statement, so that it is there whole or not at all, whenever the process ends. See
:mod:`rosa_core.journal.tables` for the tables.
"""

from __future__ import annotations

import json
import logging
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

from rosa_core.clock import Clock
from rosa_core.errors import JournalError, JournalWriteError, KnowledgeModelError, Location, Problem
from rosa_core.journal.codec import changes_to_text, checksum, facts_to_text
from rosa_core.journal.options import JournalOptions, Retention
from rosa_core.journal.tables import (
    APPLICATION_ID,
    SCHEMA,
    VERSION,
    JournalReader,
    JournalTables,
    check_format,
    damaged,
    in_use,
    no_journal,
    reading,
    topics_of,
)
from rosa_core.kb.events import StatusChange
from rosa_core.kb.facts import Fact, apply, facts_of
from rosa_core.kb.history import TOPICS, History, HistoryEntry
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.transaction import Transaction
from rosa_core.model.canonical import fingerprint, model_to_text, plain
from rosa_core.model.changes import difference
from rosa_core.model.knowledge_model import KnowledgeModel

logger = logging.getLogger(__name__)


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
        with reading(self.path):
            self._connection = self._connect(self.path, "rwc")
            self._lock: sqlite3.Connection | None = None
            try:
                self._open(model)
            except BaseException:
                self.release()
                raise

    # -- opening --

    @staticmethod
    def _connect(path: Path, mode: str) -> sqlite3.Connection:
        # Autocommit: one INSERT is one transaction. Whoever calls holds the knowledge base's lock, in any thread.
        return sqlite3.connect(
            f"{path.as_uri()}?mode={mode}", uri=True, isolation_level=None, check_same_thread=False, timeout=5.0
        )

    def _open(self, model: KnowledgeModel | None) -> None:
        # Looked at before anything is made beside it, and again when nobody else can be making it.
        self._is_new()
        self._take_lock()
        new = self._is_new()
        if new and model is None:
            raise no_journal(self.path, "this is not a journal: it is empty")
        if self._connection.execute("PRAGMA journal_mode = WAL").fetchone()[0] != "wal":
            raise JournalError(Problem("a journal cannot be kept here", Location(str(self.path)), "use a local disk"))
        self._connection.execute(f"PRAGMA synchronous = {self._options.synchronous}")
        self.tables = JournalTables(self._connection, self.path)
        if new and model is not None:
            self._create(model)
        found = self._connection.execute("PRAGMA quick_check(1)").fetchone()[0]
        if found != "ok":
            raise damaged(self.path, str(found))
        if model is not None:
            self._check_model(model)
            self._set_meta("retention", json.dumps(plain(self._options.retention)))
        self._sequence = self.tables.range()[1]
        self._files = [self.path, self.path.with_name(self.path.name + "-wal")]
        self._identities = self._identify()

    def _is_new(self) -> bool:
        if self._connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0] == 0:
            return True
        check_format(self._connection, self.path)
        return False

    def _take_lock(self) -> None:
        """Hold a lock that the operating system takes back when the process ends, however it ends."""
        self._lock = self._connect(self.path.with_name(self.path.name + "-lock"), "rwc")
        self._lock.execute("PRAGMA busy_timeout = 0")
        try:
            self._lock.execute("BEGIN EXCLUSIVE")
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode == sqlite3.SQLITE_BUSY:
                raise in_use(self.path) from None
            raise

    def _create(self, model: KnowledgeModel) -> None:
        with self._transaction():
            self._connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            self._connection.execute(f"PRAGMA user_version = {VERSION}")
            for statement in SCHEMA:
                self._connection.execute(statement)
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

    def restore(self, model: KnowledgeModel, clock: Clock, history: History) -> tuple[RuntimeState, int]:
        """The state and the revision after the last write; ``history`` is filled.

        Raises:
            JournalError: if the journal is damaged.
        """
        with reading(self.path):
            snapshot = self.tables.last_snapshot()
            if self._connection.execute("SELECT count(*) FROM models WHERE sequence > 0").fetchone()[0]:
                _, model = self.tables.model(snapshot.sequence)
            state = RuntimeState(model, clock)
            self._stored_model = model
            self._snapshot_size = len(snapshot.facts)
            self._replay(state, snapshot.facts)
            revision, sequence = snapshot.revision, snapshot.sequence
            for write in self.tables.writes(after=snapshot.sequence):
                self._replay(state, write.facts)
                revision, sequence = write.revision, write.sequence
            self._since_snapshot = sequence - snapshot.sequence
            if sequence != self._sequence or (self._since_snapshot and self.tables.range()[0] > snapshot.sequence + 1):
                raise damaged(self.path, f"writes after {snapshot.sequence} are missing")
            for topic in TOPICS:
                history.restore(topic, self.tables.entries(topic, None, history.length))
        state.reasoner.infer()
        state.reasoner.changes.clear()
        return state, revision

    def _replay(self, state: RuntimeState, facts: Sequence[Fact]) -> None:
        try:
            for fact in facts:
                apply(state, Transaction(), fact)
        except (LookupError, KnowledgeModelError) as error:
            raise damaged(self.path, f"a fact does not fit the model: {error}") from None

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
            # An interruption came between this row and the memory of it: the file knows more than the process.
            self._broken = f"it does not match the knowledge base any more; open it again ({error})"
            raise self._refusal(self._broken) from None
        except sqlite3.Error as error:
            if not self._holds(sequence):
                raise self._refusal(str(error)) from None
        self._sequence = sequence
        self._since_snapshot += 1

    def keep_up(self, state: RuntimeState, revision: int, time: float) -> None:
        """Make a snapshot and let old writes go, when it is time for that; a failure is logged and tried again."""
        if self._since_snapshot >= max(self._options.snapshot_every, self._snapshot_size):
            try:
                self.snapshot(state, revision, time)
            except sqlite3.Error as error:
                self._since_snapshot = 0
                logger.warning("no snapshot in the journal %s: %s", self.path, error)

    def snapshot(self, state: RuntimeState, revision: int, time: float) -> None:
        """Write all facts down, and let go what need not be kept.

        Raises:
            sqlite3.Error: if that fails; then the journal is as before.
        """
        facts = tuple(facts_of(state))
        with self._transaction():
            if state.model is not self._stored_model:
                self._put_model(self._sequence, state.model)
            self._put_snapshot(self._sequence, revision, time, facts)
            self._let_go(self._options.retention)
        self._snapshot_size = len(facts)
        if state.model is not self._stored_model:
            self._snapshot_size += sum(map(len, state.model.names.values()))
        self._stored_model = state.model
        self._since_snapshot = 0

    def entries(self, topic: str, name: str | None, limit: int) -> list[HistoryEntry]:
        """The latest entries of a topic, oldest first, by a connection of its own: writers need not wait.

        Raises:
            JournalError: if the journal is damaged or gone.
        """
        with JournalReader(self.path) as reader, reading(self.path):
            return reader.entries(topic, name, limit)

    def close(self, state: RuntimeState, revision: int, time: float) -> None:
        """Make a last snapshot, if there is anything new, and let the file go."""
        try:
            if self._since_snapshot and self._broken is None and self._missing_file() is None:
                self.snapshot(state, revision, time)
        except sqlite3.Error as error:
            logger.warning("no snapshot at the end of the journal %s: %s", self.path, error)
        finally:
            self.release()

    # -- inside --

    def compact(self, retention: Retention | None) -> tuple[int, int]:
        """Let old writes go (None: by the retention that the journal was last opened with), and give their space back.

        Returns:
            how many writes were there, and how many are left.

        Raises:
            JournalError: if the journal is damaged, or the disk too full.
        """
        with reading(self.path):
            if retention is None:
                retention = Retention(**json.loads(self.tables.meta("retention")))
            before = self._count()
            with self._transaction():
                self._let_go(retention)
            self._connection.execute("VACUUM")
            return before, self._count()

    def _count(self) -> int:
        first, last = self.tables.range()
        return last - first + 1

    def _let_go(self, retention: Retention) -> None:
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

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self._connection.execute("BEGIN IMMEDIATE")
        try:
            yield
            self._connection.execute("COMMIT")
        except BaseException:
            if self._connection.in_transaction:
                self._connection.execute("ROLLBACK")
            raise

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

    def release(self) -> None:
        """Let the file go as it is."""
        self._connection.close()
        if self._lock is not None:
            self._lock.close()


def open_journal(
    path: str | PathLike[str], model: KnowledgeModel, options: JournalOptions, clock: Clock, history: History
) -> tuple[Journal, RuntimeState, int]:
    """Open a journal for writing, and restore what is in it: the state, the revision, and the history.

    Raises:
        JournalError: if the file is no journal, damaged, of another model, in use, or cannot be opened.
    """
    journal = Journal(path, model, options)
    try:
        return (journal, *journal.restore(model, clock, history))
    except BaseException:
        journal.release()
        raise


def compact_journal(path: str | PathLike[str], retention: Retention | None = None) -> tuple[int, int]:
    """Let a journal's old writes go that its retention, or the one given, does not keep.

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
