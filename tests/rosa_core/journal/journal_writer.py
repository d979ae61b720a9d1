"""A process that writes a journal until it is killed; see test_journal_kill.

It reads jobs, one a line, from standard input (``path first``), and forks a child for each: the imports are made once,
and hundreds of writers can live and die within seconds. Each child prints ``start PID``, opens the journal, and
``done N`` after each write; when it could not open the journal, ``error ...``.
"""

from __future__ import annotations

import os
import sys
import tempfile

from rosa_core import JournalOptions, KnowledgeBase, Retention, SimulationClock
from tests.rosa_core.journal.writes import random_writes, robot

OPTIONS = JournalOptions(snapshot_every=7, retention=Retention(writes=25))
LAST = 100_000


def step(kb: KnowledgeBase, index: int) -> None:
    """The write of that number, always the same: some random ones, and one that says which it was."""
    assert isinstance(kb.clock, SimulationClock)
    # Far enough apart for the random writes' own passing of time.
    kb.clock.advance_to(index * 1000.0)
    with kb.transaction():
        for write in random_writes(index, 3):
            write(kb)
        # Later than any random measurement, so that it always counts.
        kb.add_measurement("tick", index, 1e12 + index)


def tell(text: str) -> None:
    """One line in one system call, so that a kill leaves it whole or unsaid."""
    os.write(1, f"{text}\n".encode())


def work(path: str, first: int) -> None:
    """Write from ``first`` on for ever."""
    tell(f"start {os.getpid()}")
    try:
        kb = KnowledgeBase(robot(), SimulationClock(first * 1000.0), path, journal_options=OPTIONS)
        for index in range(first, LAST):
            step(kb, index)
            tell(f"done {index}")
    except Exception as error:
        tell(f"error {type(error).__name__}: {error}")


def warm_up() -> None:
    """Import everything that is imported late, so that the children need not each do it."""
    with tempfile.TemporaryDirectory() as directory:
        for first in (0, 20):
            with KnowledgeBase(
                robot(), SimulationClock(first * 1000.0), f"{directory}/kb", journal_options=OPTIONS
            ) as kb:
                for index in range(first, first + 20):
                    step(kb, index)


def main() -> None:
    """Serve jobs until standard input ends."""
    warm_up()
    for line in sys.stdin:
        path, first = line.rsplit(maxsplit=1)
        child = os.fork()
        if child == 0:
            work(path, int(first))
            os._exit(0)
        os.waitpid(child, 0)
        tell("ended")


if __name__ == "__main__":
    main()
