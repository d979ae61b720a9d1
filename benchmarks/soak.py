"""A long run: a million measurements, and how much memory the process has all along.

    python benchmarks/soak.py [--measurements N] [--journal FILE] [--keep N] [--threads]

Ends with exit code 1 if memory has grown by more than 5 MB after the first tenth.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path

from bench_journal import make_model

from rosa_core import JournalOptions, KnowledgeBase, Retention, SimulationClock
from rosa_core.mape import AdaptationLoop

TOLERATED_MB = 5.0


class ObedientSystem:
    """A managed system in which everything works."""

    def activate(self, component: str) -> None:
        """Nothing to do."""

    def deactivate(self, component: str) -> None:
        """Nothing to do."""

    def set_parameters(self, component: str, parameters: object) -> None:
        """Nothing to do."""


def resident_mb() -> float:
    """The memory that the process has now (Linux)."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--measurements", type=int, default=1_000_000)
    parser.add_argument("--journal", type=Path, default=None)
    parser.add_argument("--keep", type=int, default=None, help="how many writes the journal keeps")
    parser.add_argument("--threads", action="store_true", help="subscribers in threads of their own")
    options = parser.parse_args()
    clock = SimulationClock()
    journal_options = JournalOptions(retention=Retention(writes=options.keep))
    dispatch = "threads" if options.threads else "synchronous"
    with KnowledgeBase(
        make_model(1_000), clock, options.journal, journal_options=journal_options, dispatch=dispatch
    ) as kb:
        received = [0]

        def count(_event: object) -> None:
            received[0] += 1

        kb.subscribe(count)
        with AdaptationLoop(kb, ObedientSystem()):
            for name in kb.selectable_actions()[:10]:
                kb.request_action(name)
            grown = run(kb, clock, options.measurements)
        print(f"{received[0]} events, revision {kb.revision}; grown by {grown:.1f} MB after the first tenth")
    return 1 if grown > TOLERATED_MB else 0


def run(kb: KnowledgeBase, clock: SimulationClock, measurements: int) -> float:
    """Write, print a line at each tenth, and return by how many MB memory grew after the first."""
    measures = [f"m{index}" for index in range(100)]
    settled = most = 0.0
    began = time.perf_counter()
    print(f"{'measurements':>12}{'RSS MB':>10}{'us each':>10}")
    print(f"{0:12}{resident_mb():10.1f}")
    tenth = max(measurements // 10, 1)
    for index in range(1, measurements + 1):
        clock.advance_to(index * 0.01)
        kb.add_measurement(measures[index % 100], (index // 100) % 10 / 10)
        if index % tenth == 0:
            took, now = (time.perf_counter() - began) / tenth * 1e6, resident_mb()
            print(f"{index:12}{now:10.1f}{took:10.1f}", flush=True)
            settled = settled or now
            most = max(most, now)
            began = time.perf_counter()
    return most - settled


if __name__ == "__main__":
    sys.exit(main())
