"""``kill -9`` at any moment loses no acknowledged write and never damages the journal: tried, hundreds of times."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from rosa_core import KnowledgeBase, SimulationClock
from tests.rosa_core.journal.journal_writer import step
from tests.rosa_core.journal.writes import picture, robot

KILLS = 300
KILLS_WHILE_OPENING = 60


@pytest.fixture
def writer() -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(
        [sys.executable, "-u", "-m", "tests.rosa_core.journal.journal_writer"],
        cwd=Path(__file__).parents[3],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        yield process
        process.stdin.close()  # type: ignore[union-attr]


def write_and_kill(writer: subprocess.Popen[str], path: Path, first: int, delay: float, after: str) -> int:
    """Let a process write from ``first`` on, and kill it ``delay`` seconds after its start, or its first write done.

    Returns:
        the last write that it acknowledged.
    """
    assert writer.stdin is not None
    assert writer.stdout is not None
    writer.stdin.write(f"{path} {first}\n")
    writer.stdin.flush()
    acknowledged = first - 1
    timer: threading.Timer | None = None
    for line in writer.stdout:
        word, _, rest = line.strip().partition(" ")
        assert word != "error", rest
        if word == "start":
            timer = threading.Timer(delay, os.kill, (int(rest), signal.SIGKILL))
        elif word == "done":
            acknowledged = int(rest)
        elif word == "ended":
            break
        if timer is not None and word == after and not timer.ident:
            timer.start()
    assert timer is not None
    timer.join()
    return acknowledged


def state(kb: KnowledgeBase) -> dict[str, object]:
    """Everything but the history: the journal keeps only the latest of that."""
    return {**picture(kb), "history": None}


@pytest.mark.slow
def test_no_kill_loses_an_acknowledged_write_or_damages_the_journal(
    writer: subprocess.Popen[str], tmp_path: Path
) -> None:
    source = random.Random(1)
    path = tmp_path / "kb"
    reference = KnowledgeBase(robot(), SimulationClock())
    done, unacknowledged, writers_that_wrote = -1, 0, 0
    for _ in range(KILLS):
        after = source.choice(["start", "done", "done", "done"])
        acknowledged = write_and_kill(writer, path, done + 1, source.uniform(0.0, 0.05), after)
        with KnowledgeBase(robot(), SimulationClock(), path) as kb:
            tick = kb.measurement("tick")
            written = -1 if tick is None else int(tick.value)
            # The last write may be durable though the process died before it could say so. No more than that one.
            assert acknowledged <= written <= acknowledged + 1
            unacknowledged += written > acknowledged
            writers_that_wrote += written > done
            while done < written:
                done += 1
                step(reference, done)
            assert state(kb) == state(reference)
            if written >= 0:
                assert kb.history("measurements", "tick", limit=1)[0].value == written  # type: ignore[union-attr]
    print(f"{KILLS} kills, {done + 1} writes, {unacknowledged} durable but killed before they could say so")
    assert writers_that_wrote > KILLS / 2, "the writers were killed before they wrote"


@pytest.mark.slow
def test_no_kill_while_a_journal_is_made_leaves_it_half_made(writer: subprocess.Popen[str], tmp_path: Path) -> None:
    source = random.Random(2)
    found_before_first_write = 0
    for index in range(KILLS_WHILE_OPENING):
        path = tmp_path / f"kb{index}"
        acknowledged = write_and_kill(writer, path, 0, source.uniform(0.0, 0.015), "start")
        with KnowledgeBase(robot(), SimulationClock(), path) as kb:
            tick = kb.measurement("tick")
            assert (-1 if tick is None else tick.value) >= acknowledged
            found_before_first_write += kb.revision == 0
    assert found_before_first_write, "no kill came early enough"
