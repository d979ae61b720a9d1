"""What a journal refuses: other models, damage, full disks."""

from __future__ import annotations

import json
import random
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from rosa_core import (
    JournalError,
    JournalOptions,
    KnowledgeBase,
    KnowledgeBaseError,
    KnowledgeModel,
    SimulationClock,
)
from rosa_core.errors import JournalWriteError
from rosa_core.journal.tables import JournalReader
from rosa_core.model.canonical import fingerprint, model_from_text, model_to_text
from rosa_core.model.elements import Action, Component, Function, FunctionDesign
from tests.rosa_core.journal.writes import picture, random_writes, robot

FREQUENT = JournalOptions(snapshot_every=3)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "kb.journal"


def reopened(path: Path, clock: SimulationClock, model: KnowledgeModel | None = None) -> KnowledgeBase:
    return KnowledgeBase(model or robot(), SimulationClock(clock.now()), path)


# -- what is refused --


def test_a_journal_of_another_model_is_refused_saying_what_differs(path: Path) -> None:
    KnowledgeBase(robot(), SimulationClock(), path).close()
    other = replace(robot(), actions=(*robot().actions, Action("dance")))
    with pytest.raises(JournalError, match=r"another model: only the model given has action 'dance'"):
        KnowledgeBase(other, SimulationClock(), path)
    turned = replace(robot(), actions=tuple(reversed(robot().actions)))
    with pytest.raises(JournalError, match="another order"):
        KnowledgeBase(turned, SimulationClock(), path)
    KnowledgeBase(robot(), SimulationClock(), path).close()


def test_a_journal_is_written_by_one_knowledge_base_at_a_time(path: Path) -> None:
    with (
        KnowledgeBase(robot(), SimulationClock(), path),
        pytest.raises(JournalError, match="in use: another knowledge base writes it"),
    ):
        KnowledgeBase(robot(), SimulationClock(), path)
    KnowledgeBase(robot(), SimulationClock(), path).close()


def test_another_process_cannot_write_it_either(path: Path) -> None:
    with KnowledgeBase(robot(), SimulationClock(), path):
        code = f"from rosa_core.journal.journal import compact_journal; compact_journal({str(path)!r})"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "in use" in done.stderr


def _text(path: Path) -> None:
    path.write_text("measures: {}\n" * 100)


def _foreign_database(path: Path) -> None:
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE addresses (name TEXT)")
    connection.close()


def _directory(path: Path) -> None:
    path.mkdir()


def _later_version(path: Path) -> None:
    KnowledgeBase(robot(), SimulationClock(), path).close()
    connection = sqlite3.connect(path)
    connection.execute("PRAGMA user_version = 99")
    connection.close()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (_text, "not a journal"),
        (_foreign_database, "a database, but not a journal"),
        (_directory, "cannot be opened"),
        (_later_version, "format 99"),
    ],
)
def test_a_file_that_is_no_journal_is_refused_and_left_as_it_is(path: Path, make, message: str) -> None:
    make(path)
    before = path.read_bytes() if path.is_file() else None
    with pytest.raises(JournalError, match=message):
        KnowledgeBase(robot(), SimulationClock(), path)
    assert before is None or path.read_bytes() == before


def test_a_directory_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(JournalError, match="does the directory exist"):
        KnowledgeBase(robot(), SimulationClock(), tmp_path / "missing" / "kb")


def test_an_altered_write_is_found(path: Path) -> None:
    kb = KnowledgeBase(robot(), SimulationClock(), path)
    kb.add_measurement("battery", 0.75)
    assert kb._journal is not None
    kb._journal.release()
    connection = sqlite3.connect(path)
    connection.execute("UPDATE writes SET facts = replace(facts, '0.75', '0.25')")
    connection.commit()
    connection.close()
    with pytest.raises(JournalError, match="write 1 is altered"):
        KnowledgeBase(robot(), SimulationClock(), path)


def test_a_missing_write_is_found(path: Path) -> None:
    kb = KnowledgeBase(robot(), SimulationClock(), path)
    for value in range(3):
        kb.add_measurement("battery", value)
    assert kb._journal is not None
    kb._journal.release()
    connection = sqlite3.connect(path)
    connection.execute("DELETE FROM writes WHERE sequence = 1")
    connection.commit()
    connection.close()
    with pytest.raises(JournalError, match="missing"):
        KnowledgeBase(robot(), SimulationClock(), path)


@pytest.mark.parametrize("seed", range(120))
def test_a_damaged_journal_is_refused_or_restores_the_state_exactly(path: Path, seed: int) -> None:
    source = random.Random(seed)
    clock = SimulationClock()
    kb = KnowledgeBase(robot(), clock, path, journal_options=JournalOptions(snapshot_every=20))
    for write in random_writes(1, 60):
        write(kb)
    before = picture(kb)
    assert kb._journal is not None
    (kb.close if seed % 2 else kb._journal.release)()
    data = bytearray(path.read_bytes())
    if seed % 5 == 0:
        del data[source.randrange(len(data)) :]
    else:
        for _ in range(source.choice([1, 4, 300])):
            data[source.randrange(len(data))] ^= 1 << source.randrange(8)
    path.write_bytes(data)
    try:
        again = reopened(path, clock)
    except JournalError:
        return
    # An emptied file is a new journal; otherwise what was not damaged is all that matters.
    assert again.revision == 0 or picture(again) == before
    assert again.revision or not data
    again.close()


# -- writes that the journal cannot take --


@pytest.fixture
def full_disk(path: Path) -> Iterator[KnowledgeBase]:
    kb = KnowledgeBase(robot(), SimulationClock(), path)
    assert kb._journal is not None
    connection = kb._journal.tables.connection
    pages = connection.execute("PRAGMA page_count").fetchone()[0]
    connection.execute(f"PRAGMA max_page_count = {pages + 2}")
    yield kb
    kb.close()


def test_a_write_that_the_disk_has_no_room_for_is_refused(full_disk: KnowledgeBase, path: Path) -> None:
    kb, events = full_disk, []
    kb.subscribe(events.append)
    before = picture(kb)

    def write() -> None:
        nonlocal before
        before = picture(kb)
        events.clear()
        with kb.transaction():
            kb.add_measurement("battery", before["revision"] % 2)
            kb.set_component_active("motor", before["revision"] % 2 == 0)

    def fill() -> None:
        while True:
            write()

    with pytest.raises(JournalWriteError, match="full"):
        fill()
    assert not events
    assert picture(kb) == before
    assert kb._journal is not None
    kb._journal.tables.connection.execute("PRAGMA max_page_count = 100000")
    kb.add_measurement("light", 0.5)
    assert kb.revision == before["revision"] + 1
    after = picture(kb)
    kb.close()
    with KnowledgeBase(robot(), SimulationClock(), path) as again:
        assert picture(again) == after


def test_a_real_write_error_is_refused_too(path: Path) -> None:
    """A file size limit stands for a disk that takes no more, in a process of its own since it cannot be lifted."""
    code = f"""
import resource, sys
sys.path.insert(0, {str(Path(__file__).parents[3])!r})
from tests.rosa_core.journal.writes import robot
from rosa_core import KnowledgeBase, KnowledgeBaseError, SimulationClock
kb = KnowledgeBase(robot(), SimulationClock(), {str(path)!r})
resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, resource.RLIM_INFINITY))
written = 0
try:
    for index in range(100_000):
        kb.add_measurement("tick", index)
        written = kb.revision
except KnowledgeBaseError as error:
    assert kb.revision == written and kb.measurement("tick").value == index - 1, "half done"
    print(written, "refused" in str(error))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    written, refused = done.stdout.split()
    assert refused == "True"
    with KnowledgeBase(robot(), SimulationClock(), path) as kb:
        assert kb.revision == int(written)


@pytest.mark.parametrize("suffix", ["", "-wal"])
def test_a_write_is_refused_when_the_file_has_been_removed(path: Path, suffix: str) -> None:
    kb = KnowledgeBase(robot(), SimulationClock(), path)
    kb.add_measurement("battery", 0.9)
    before = picture(kb)
    path.with_name(path.name + suffix).unlink()
    with pytest.raises(KnowledgeBaseError, match="removed or replaced"):
        kb.add_measurement("battery", 0.1)
    assert picture(kb) == before
    kb.close()


def test_a_row_that_is_there_already_stops_the_writing(path: Path) -> None:
    """So it looks when an interruption comes between the row and the memory of it."""
    kb = KnowledgeBase(robot(), SimulationClock(), path)
    kb.add_measurement("battery", 0.9)
    assert kb._journal is not None
    kb._journal._sequence -= 1
    for _ in range(2):
        with pytest.raises(JournalWriteError, match="open it again"):
            kb.add_measurement("battery", 0.1)
    assert kb.measurement("battery").value == 0.9  # type: ignore[union-attr]
    kb.close()
    with KnowledgeBase(robot(), SimulationClock(), path) as again:
        assert again.measurement("battery").value == 0.9  # type: ignore[union-attr]


def test_a_failing_snapshot_does_not_fail_the_write(path: Path, monkeypatch, caplog) -> None:
    kb = KnowledgeBase(robot(), SimulationClock(), path, journal_options=FREQUENT)

    def fail(*_: object) -> None:
        raise sqlite3.OperationalError("disk I/O error")

    with monkeypatch.context() as patch:
        patch.setattr(kb._journal, "_put_snapshot", fail)
        for value in range(8):
            kb.add_measurement("battery", value)
    assert "no snapshot" in caplog.text
    kb.close()
    with KnowledgeBase(robot(), SimulationClock(), path) as again:
        assert again.revision == 8


# -- the file --


def test_the_fingerprint_tells_models_apart_and_stays() -> None:
    assert fingerprint(robot()) == fingerprint(robot())
    drive, *others = robot().function_designs
    assert fingerprint(replace(robot(), function_designs=(replace(drive, priority=1), *others))) == fingerprint(robot())
    assert fingerprint(replace(robot(), function_designs=(replace(drive, priority=3), *others))) != fingerprint(robot())
    # Journals of earlier versions must stay readable: this value may not change.
    small = KnowledgeModel(
        functions=(Function("move"),),
        components=(Component("motor"),),
        function_designs=(FunctionDesign("drive", "move", ("motor",), 1.0),),
    )
    assert fingerprint(small).startswith("0a15f10023594ee8")


def test_a_model_comes_back_from_its_text() -> None:
    assert model_from_text(model_to_text(robot())) == robot()
    assert model_to_text(model_from_text(model_to_text(robot()))) == model_to_text(robot())


def test_the_rows_are_facts_in_order(path: Path) -> None:
    with KnowledgeBase(robot(), SimulationClock(1.5), path) as kb, kb.transaction():
        kb.add_measurement("battery", 0.125)
        kb.set_component_failure("legs", 1.0)
    connection = sqlite3.connect(path)
    ((revision, time, facts, statuses),) = connection.execute("SELECT revision, time, facts, statuses FROM writes")
    connection.close()
    assert (revision, time) == (1, 1.5)
    assert json.loads(facts) == [["measurement", "battery", 0.125, 1.5], ["component_failure", "legs", 1.0]]
    assert ["action", "explore", "feasible", "unfeasible"] in json.loads(statuses)


def test_a_long_journal_is_soon_open_again(path: Path) -> None:
    """Only what came after the last snapshot is done again."""
    with KnowledgeBase(robot(), SimulationClock(), path, journal_options=FREQUENT) as kb:
        for index in range(100):
            kb.add_measurement("tick", index)
    with JournalReader(path) as reader:
        snapshot = reader.last_snapshot()
    assert snapshot.sequence == 100
    assert len(snapshot.facts) == 2
