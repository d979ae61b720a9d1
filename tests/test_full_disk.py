"""A disk that is full is said to be full: what was written is kept, and with room again the work goes on.

The disk is a small tmpfs, which only root can mount; for others these tests are skipped.
"""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from rosa_core import InputError, JournalError, KnowledgeBase, SimulationClock
from rosa_core.errors import JournalWriteError
from rosa_core.journal.tables import JournalReader
from rosa_evaluation.campaign import Results, ResultsError, ResultsWriter
from rosa_simulation.run_reader import read_run
from rosa_simulation.scenario import RunRequest, SilentObserver
from tests.rosa_core.journal.writes import robot
from tests.rosa_evaluation.campaign.scenarios import Walk, plan

FULL = r"no space left|No space left"


@pytest.fixture
def disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 2 MB."""
    place = tmp_path / "disk"
    place.mkdir()
    try:
        mounted = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(place)], capture_output=True, text=True, check=False
        )
    except OSError as error:
        pytest.skip(f"no tmpfs can be mounted here: {error}")
    if mounted.returncode:
        pytest.skip(f"no tmpfs can be mounted here (that takes root): {mounted.stderr.strip()}")
    try:
        yield place
    finally:
        subprocess.run(["umount", "-l", str(place)], check=True)


def fill(disk: Path, leave: int = 0) -> Callable[[], None]:
    """Take all room but so many bytes; what is returned gives it back."""
    ballast = disk / "ballast"
    with ballast.open("wb", buffering=0) as file, suppress(OSError):
        while True:
            file.write(b"x" * 4096)
    os.truncate(ballast, max(0, ballast.stat().st_size - leave))
    return ballast.unlink


def journal_of(path: Path) -> KnowledgeBase:
    return KnowledgeBase(robot(), SimulationClock(), path)


def _measure_until_full(kb: KnowledgeBase) -> int:
    """How many measurements were taken."""
    for number in range(1, 100_000):
        try:
            kb.add_measurement("tick", float(number), float(number))
        except JournalWriteError as error:
            if "no space left" not in str(error):
                raise
            return number - 1
    return 100_000


def test_a_journal_refuses_writes_goes_on_with_room_and_has_lost_nothing(disk: Path) -> None:
    path = disk / "kb.journal"
    kb = journal_of(path)
    make_room = fill(disk, leave=300_000)
    written = _measure_until_full(kb)
    assert written > 10
    last = kb.measurement("tick")
    assert last is not None
    assert last.value == written
    make_room()
    kb.add_measurement("light", 0.5, 0.0)
    make_room = fill(disk)
    kb.close()
    with pytest.raises(JournalError, match=FULL) as refusal:
        journal_of(path)
    assert "damaged" not in str(refusal.value)
    assert "new journal" not in str(refusal.value)
    make_room()
    with journal_of(path) as again:
        assert again.measurement("tick") == last
        assert again.measurement("light") is not None


def _use(use: Callable[[], None]) -> None:
    """Use a journal that there may be no room for."""
    try:
        use()
    except JournalError as error:
        if "no space left" not in str(error) or "everything that was written is in it" not in str(error):
            raise RuntimeError(f"a full disk is called something else: {error}") from error
        raise


@pytest.mark.parametrize("leave", range(0, 48 << 10, 4096))
def test_a_good_journal_on_a_full_disk_is_not_called_damaged(disk: Path, leave: int) -> None:
    path = disk / "kb.journal"
    with journal_of(path) as kb:
        kb.add_measurement("tick", 7.0, 1.0)
    make_room = fill(disk, leave)
    for use in (lambda: journal_of(path).close(), lambda: JournalReader(path).close()):
        with suppress(JournalError):
            _use(use)
    make_room()
    with journal_of(path) as kb:
        assert kb.measurement("tick") is not None


def _record_until_full(disk: Path, recorded: list[str]) -> None:
    walks = plan(Walk())
    with ResultsWriter(disk, SimulationClock(1e9)) as writer:
        writer.begin(walks)
        for number in range(1000):
            for run in walks.runs:
                writer.add_failure(run, walks, f"Traceback {number}: " + "it broke " * 2000)
                recorded.append(run.run_id)


def test_a_campaign_keeps_every_run_that_it_has_recorded_and_goes_on(disk: Path) -> None:
    walks = plan(Walk())
    recorded: list[str] = []
    make_room = fill(disk, leave=200_000)
    with pytest.raises(ResultsError, match=FULL):
        _record_until_full(disk, recorded)
    assert recorded
    make_room()
    with ResultsWriter(disk, SimulationClock(1e9)) as writer:
        assert set(recorded) <= set(writer.begin(walks))
        writer.add(walks.runs[0], Walk().run(walks.runs[0].request, SilentObserver()))
    with Results(disk) as results:
        assert results.record(walks.runs[0].run_id).scenario == "walk"


def test_a_run_record_is_there_whole_or_as_it_was(disk: Path) -> None:
    directory = disk / "run"
    first, second = (Walk().run(RunRequest("calm", "bt", seed), SilentObserver()) for seed in (1, 2))
    first.write(directory)
    make_room = fill(disk)
    with pytest.raises(InputError, match=r"No space left on device \(make room on the disk, and do it again\)"):
        second.write(directory)
    assert read_run(directory).seed == 1
    assert {file.name for file in directory.iterdir()} == {
        "run.json", "wall_clock.json", "events.jsonl", "trajectory.csv",
    }  # fmt: skip
    make_room()
    second.write(directory)
    assert read_run(directory).seed == 2


def test_the_command_says_that_the_output_has_no_room() -> None:
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("there is no /dev/full here")
    with full.open("w") as output:
        done = subprocess.run(
            [sys.executable, "-m", "rosa_cli.main", "schema"],
            stdout=output,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert os.strerror(errno.ENOSPC) in done.stderr
    assert "Traceback" not in done.stderr
