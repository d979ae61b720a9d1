"""What it costs a tree to be watched: ``python benchmarks/bench_watching.py``."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack, nullcontext
from pathlib import Path

from py_trees.behaviour import Behaviour

from rosa_core import SimulationClock
from task_layer.bt import Condition, Fallback, ReactiveSequence, Sequence
from task_layer.bt.engine.status_changes import watch_statuses
from task_layer.bt.groot import BtLogWriter, GrootPublisher

TICKS, TIMES, PORT = 3000, 5, 17_667


def a_tree() -> Behaviour:
    """21 nodes, all visited in every tick, all of which change their status."""
    guarded = [
        ReactiveSequence(f"do {n}", [Condition("feasible", lambda: True), Condition("done", lambda: True)])
        for n in range(5)
    ]
    ends = [Condition(f"end {n}", lambda: False) for n in range(2)]
    done = Condition("done", lambda: True)
    return Sequence("all", [*guarded, Fallback("any", [*ends, Condition("last", lambda: True)]), done])


def ticks_per_second(root: Behaviour) -> float:
    """The best of several rounds."""
    best = 0.0
    for _ in range(TIMES):
        began = time.perf_counter()
        for _ in range(TICKS):
            root.tick_once()
        best = max(best, TICKS / (time.perf_counter() - began))
    return best


def main() -> None:
    """Print the figures."""
    root, folder = a_tree(), Path(tempfile.mkdtemp())

    def observed() -> AbstractContextManager[object]:
        stack = ExitStack()
        stack.callback(watch_statuses(root, lambda *_: None))
        return stack

    ways: dict[str, Callable[[], AbstractContextManager[object]]] = {
        "not watched": nullcontext,
        "observed": observed,
        "served to Groot2": lambda: GrootPublisher(root, PORT),
        "logged": lambda: BtLogWriter(folder / "bench.btlog", root, SimulationClock()),
        "not watched any more": nullcontext,
    }
    base = 0.0
    for name, way in ways.items():
        with way():
            rate = ticks_per_second(root)
        base = base or rate
        print(f"{name:22}{rate:10.0f} ticks/s, {base / rate:5.2f} times as long as unwatched")


if __name__ == "__main__":
    main()
