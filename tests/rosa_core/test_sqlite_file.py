"""SQLite files of a format of one's own: one writer, many readers, and an error with a hint for every bad file."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from rosa_core import InputError
from rosa_core.sqlite_file import SqliteFormat, SqliteWriter, connect


class DiaryError(InputError):
    """What is wrong with a diary."""


DIARY = SqliteFormat(
    noun="diary",
    application_id=0x44494152,
    version=3,
    tables=("CREATE TABLE days (day INTEGER PRIMARY KEY, entry TEXT NOT NULL)",),
    error=DiaryError,
    writer="another author",
    use_hint="wait",
    foreign_hint="name a diary",
    damage_hint="restore it",
)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "a.diary"


def write(path: Path, *entries: str) -> None:
    writer = SqliteWriter(path, DIARY)
    with writer.transaction():
        if writer.is_new:
            DIARY.create(writer.connection)
        for entry in entries:
            writer.connection.execute("INSERT INTO days (entry) VALUES (?)", (entry,))
    writer.release()


def read(path: Path) -> list[str]:
    with closing(DIARY.open_to_read(path)) as connection:
        return [entry for (entry,) in connection.execute("SELECT entry FROM days ORDER BY day")]


def test_what_was_written_is_read_and_written_on(path: Path) -> None:
    write(path, "one", "two")
    write(path, "three")
    assert read(path) == ["one", "two", "three"]


def test_a_reader_does_not_write(path: Path) -> None:
    write(path, "one")
    with (
        closing(DIARY.open_to_read(path)) as connection,
        pytest.raises(DiaryError, match="cannot be opened"),
        DIARY.accessing(path),
    ):
        connection.execute("DELETE FROM days")


def test_there_is_one_writer_and_readers_see_what_it_has_written(path: Path) -> None:
    write(path, "one")
    writer = SqliteWriter(path, DIARY)
    with pytest.raises(DiaryError, match=r"the diary is in use: another author writes it \(wait\)"):
        SqliteWriter(path, DIARY)
    with writer.transaction():
        writer.connection.execute("INSERT INTO days (entry) VALUES ('two')")
        assert read(path) == ["one"]
    assert read(path) == ["one", "two"]
    writer.release()
    write(path, "three")
    assert read(path) == ["one", "two", "three"]


def test_a_transaction_that_raises_leaves_nothing(path: Path) -> None:
    def write_half() -> None:
        with writer.transaction():
            writer.connection.execute("INSERT INTO days (entry) VALUES ('half')")
            raise KeyboardInterrupt

    write(path, "one")
    writer = SqliteWriter(path, DIARY)
    with pytest.raises(KeyboardInterrupt):
        write_half()
    writer.release()
    assert read(path) == ["one"]


def _text(path: Path) -> None:
    path.write_text("Dear diary, " * 100, encoding="utf-8")


def _another_database(path: Path) -> None:
    with closing(connect(path, "rwc")) as connection:
        connection.execute("CREATE TABLE days (day)")


def _another_version(path: Path) -> None:
    write(path, "one")
    with closing(connect(path, "rwc")) as connection:
        connection.execute("PRAGMA user_version = 4")


def _damaged(path: Path) -> None:
    write(path, *(f"{number:0500}" for number in range(100)))
    data = bytearray(path.read_bytes())
    data[4096:6096] = b"x" * 2000
    path.write_bytes(data)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (_text, r"this is not a diary \(name a diary\)"),
        (_another_database, r"this is a database, but not a diary \(name a diary\)"),
        (_another_version, r"the diary has format 4; this version reads format 3 \(use the version that wrote it\)"),
        (_damaged, r"the diary is damaged: .* \(restore it\)"),
        (Path.mkdir, r"the diary cannot be opened \(does the directory exist"),
    ],
)
def test_what_is_no_good_is_refused_and_left_as_it_is(path: Path, make: Callable[[Path], None], words: str) -> None:
    make(path)
    before = path.read_bytes() if path.is_file() else None
    with pytest.raises(DiaryError, match=words) as refusal:
        SqliteWriter(path, DIARY)
    assert str(path) in str(refusal.value)
    assert (path.read_bytes() if path.is_file() else None) == before


def test_an_empty_file_becomes_a_diary_only_where_that_is_wanted(path: Path) -> None:
    path.touch()
    with pytest.raises(DiaryError, match="this is not a diary: it is empty"):
        SqliteWriter(path, DIARY, create=False)
    assert path.read_bytes() == b""
    write(path, "one")
    assert read(path) == ["one"]


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (ValueError("no number"), "the diary is damaged: no number"),
        (KeyError("day"), "the diary is damaged: KeyError: 'day'"),
        (sqlite3.DatabaseError("malformed"), "the diary is damaged: malformed"),
    ],
)
def test_what_decoding_finds_is_damage(path: Path, error: Exception, words: str) -> None:
    with pytest.raises(DiaryError) as damage, DIARY.accessing(path):
        raise error
    assert words in str(damage.value)


def test_a_full_disk_is_not_damage(path: Path) -> None:
    write(path, "one")
    writer = SqliteWriter(path, DIARY)
    pages = writer.connection.execute("PRAGMA page_count").fetchone()[0]
    writer.connection.execute(f"PRAGMA max_page_count = {pages}")

    def fill() -> None:
        with DIARY.accessing(path), writer.transaction():
            writer.connection.execute("INSERT INTO days (entry) VALUES (?)", ("x" * 100_000,))

    with pytest.raises(DiaryError, match=r"no space left for the diary: .* \(make room"):
        fill()
    writer.release()
    assert read(path) == ["one"]
