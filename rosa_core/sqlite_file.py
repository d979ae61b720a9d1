"""SQLite files of a format of one's own: opening them, one writer at a time, and what is said of bad ones.

A journal is such a file, and so are a campaign's results. Each is a :class:`SqliteFormat`; whatever is wrong with a
file becomes the format's error, with the file's name and a hint.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from rosa_core.errors import InputError, Location, Problem

_NOT_OPENED = (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM)
_NOT_WRITTEN = (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR)


@dataclass(frozen=True, slots=True)
class SqliteFormat:
    """A kind of SQLite file.

    Args:
        noun: what such a file is called, such as ``journal``.
        application_id: the number in the file's header by which tools such as file(1) know what it is for.
        version: of the tables; another one is refused.
        tables: the statements that make them.
        error: what is raised.
        writer: who else may be writing the file, such as ``another knowledge base``.
        use_hint, foreign_hint, damage_hint: what to do about a file that is being written, that is something else,
            that is damaged.
    """

    noun: str
    application_id: int
    version: int
    tables: tuple[str, ...]
    error: type[InputError]
    writer: str
    use_hint: str
    foreign_hint: str
    damage_hint: str

    # -- what is said --

    def problem(self, path: Path, what: str, hint: str) -> InputError:
        """The format's error about a file.

        Args:
            path: of the file.
            what: is wrong.
            hint: what to do about it.

        Returns:
            the error, to be raised.
        """
        return self.error(Problem(what, Location(str(path)), hint))

    def damaged(self, path: Path, what: str) -> InputError:
        """The error for a file that is not as it was written.

        Args:
            path: of the file.
            what: shows it.

        Returns:
            the error, to be raised.
        """
        return self.problem(path, f"the {self.noun} is damaged: {what}", self.damage_hint)

    def foreign(self, path: Path, what: str) -> InputError:
        """The error for a file that is something else.

        Args:
            path: of the file.
            what: it is instead.

        Returns:
            the error, to be raised.
        """
        return self.problem(path, what, self.foreign_hint)

    def in_use(self, path: Path) -> InputError:
        """Another process, or another part of this one, writes the file."""
        return self.problem(path, f"the {self.noun} is in use: {self.writer} writes it", self.use_hint)

    @contextmanager
    def accessing(self, path: Path) -> Iterator[None]:
        """Turn what SQLite and the decoders of rows find wrong with a file into the error that says so.

        Raises:
            InputError: the format's own, for every error of SQLite and every row that cannot be read.
        """
        try:
            yield
        except sqlite3.Error as error:
            raise self._unusable(path, error) from None
        except ValueError as error:
            raise self.damaged(path, str(error)) from None
        except (TypeError, LookupError) as error:
            # Damage in a table's definition shows as columns that are missing, or are something else.
            raise self.damaged(path, f"{type(error).__name__}: {error}") from None

    def _unusable(self, path: Path, error: sqlite3.Error) -> InputError:
        code = getattr(error, "sqlite_errorcode", 0) & 0xFF
        if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
            return self.in_use(path)
        if code == sqlite3.SQLITE_NOTADB:
            return self.foreign(path, f"this is not a {self.noun}")
        if code in _NOT_OPENED:
            hint = "does the directory exist, and may you read and write in it?"
            return self.problem(path, f"the {self.noun} cannot be opened", hint)
        if code in _NOT_WRITTEN:
            hint = "make room on the disk; what was written before is kept"
            return self.problem(path, f"the {self.noun} cannot be written: {error}", hint)
        return self.damaged(path, str(error))

    # -- checking and making --

    def check(self, connection: sqlite3.Connection, path: Path) -> None:
        """Make sure that an open database is a file of this format, and of its version.

        Args:
            connection: the open database.
            path: its file, for the error.

        Raises:
            InputError: the format's own, if it is not.
            sqlite3.Error: if it cannot be read.
        """
        if connection.execute("PRAGMA application_id").fetchone()[0] != self.application_id:
            raise self.foreign(path, f"this is a database, but not a {self.noun}")
        version = connection.execute("PRAGMA user_version").fetchone()[0]
        if version != self.version:
            what = f"the {self.noun} has format {version}; this version reads format {self.version}"
            raise self.problem(path, what, "use the version that wrote it")

    def check_pages(self, connection: sqlite3.Connection, path: Path) -> None:
        """Make sure that SQLite finds no damage; reads the whole file.

        Args:
            connection: the open database.
            path: its file, for the error.

        Raises:
            InputError: the format's own, if it does.
        """
        found = connection.execute("PRAGMA quick_check(1)").fetchone()[0]
        if found != "ok":
            raise self.damaged(path, str(found).splitlines()[-1])

    def create(self, connection: sqlite3.Connection) -> None:
        """Make the tables, within the transaction that is open."""
        connection.execute(f"PRAGMA application_id = {self.application_id}")
        connection.execute(f"PRAGMA user_version = {self.version}")
        for statement in self.tables:
            connection.execute(statement)

    def open_to_read(self, path: Path) -> sqlite3.Connection:
        """A connection for reading only; another process may be writing.

        Raises:
            InputError: the format's own, if the file is not one of this format.
        """
        with self.accessing(path):
            connection = connect(path, "ro")
            try:
                self.check(connection, path)
            except BaseException:
                connection.close()
                raise
            return connection


class SqliteWriter:
    """A file that only this object writes, until it is released; anybody may read it meanwhile.

    Args:
        path: the file; made if it is not there. Beside it are ``-wal`` and ``-shm`` while it is open, and an empty
            ``-lock`` that stays.
        kind: its format.
        create: whether a file that is empty is to become one of this format; if not, that is an error.
        synchronous: what a write waits for: the operating system (``NORMAL``) or the disk (``FULL``).

    Raises:
        InputError: the format's own, if the file is something else, damaged, in use, or cannot be opened.
    """

    def __init__(self, path: Path, kind: SqliteFormat, *, create: bool = True, synchronous: str = "NORMAL") -> None:
        self.path = path
        self._kind = kind
        self._lock: sqlite3.Connection | None = None
        with kind.accessing(path):
            self.connection = connect(path, "rwc")
            try:
                self.is_new = self._open(create, synchronous)
            except BaseException:
                self.release()
                raise

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """What is written in the block is written together, or, if it raises, not at all.

        Raises:
            sqlite3.Error: if it cannot be written.
        """
        self.connection.execute("BEGIN IMMEDIATE")
        try:
            yield
            self.connection.execute("COMMIT")
        except BaseException:
            if self.connection.in_transaction:
                self.connection.execute("ROLLBACK")
            raise

    def release(self) -> None:
        """Release the file as it is."""
        self.connection.close()
        if self._lock is not None:
            self._lock.close()

    def _open(self, create: bool, synchronous: str) -> bool:
        # Checked before any other file is made, and again when nobody else can be making this one.
        self._is_empty()
        self._take_lock()
        empty = self._is_empty()
        if empty and not create:
            raise self._kind.foreign(self.path, f"this is not a {self._kind.noun}: it is empty")
        if not empty:
            # Before anything is changed: a damaged file is left as it is.
            self._kind.check_pages(self.connection, self.path)
        if self.connection.execute("PRAGMA journal_mode = WAL").fetchone()[0] != "wal":
            raise self._kind.problem(self.path, f"a {self._kind.noun} cannot be kept here", "use a local disk")
        self.connection.execute(f"PRAGMA synchronous = {synchronous}")
        return empty

    def _is_empty(self) -> bool:
        if self.connection.execute("SELECT count(*) FROM sqlite_master").fetchone()[0] == 0:
            return True
        self._kind.check(self.connection, self.path)
        return False

    def _take_lock(self) -> None:
        """Hold a lock that the operating system takes back when the process ends, however it ends."""
        self._lock = connect(self.path.with_name(f"{self.path.name}-lock"), "rwc")
        self._lock.execute("PRAGMA busy_timeout = 0")
        try:
            self._lock.execute("BEGIN EXCLUSIVE")
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode == sqlite3.SQLITE_BUSY:
                raise self._kind.in_use(self.path) from None
            raise


def connect(path: Path, mode: str) -> sqlite3.Connection:
    """A connection in autocommit, usable from any thread as long as one uses it at a time.

    Args:
        path: the file, absolute.
        mode: ``ro`` to read, ``rwc`` to read and write and to make the file if it is not there.
    """
    return sqlite3.connect(
        f"{path.as_uri()}?mode={mode}", uri=True, isolation_level=None, check_same_thread=False, timeout=5.0
    )
