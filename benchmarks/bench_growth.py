"""From an element to a knowledge base that has it: ``python benchmarks/bench_growth.py``.

Measured are whole writes (checked, inferred, recorded, announced; nobody listens): a component and a design of it are
added to the last function, and removed again. Beside them what building the same knowledge base from nothing takes, the
check of the model included, and ``kb.model`` after a change, which is put together when it is asked for.
"""

from __future__ import annotations

import gc
import statistics
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.model.elements import Component, FunctionDesign
from rosa_evaluation.bench.synthetic import many_small_robots


def milliseconds(work: Callable[[], object]) -> float:
    """How long a call takes."""
    began = time.perf_counter()
    work()
    return (time.perf_counter() - began) * 1e3


def grow_and_shrink(kb: KnowledgeBase, times: int) -> tuple[float, float, float, float]:
    """Median milliseconds of adding, removing, and asking for the model; and the longest of the first two."""
    function = next(reversed(kb.statuses("function")))
    added, removed, asked = [], [], []
    for number in range(times):
        component = Component(f"new {number}")
        design = FunctionDesign(f"new {number}", function, (component.name,))
        added.append(milliseconds(lambda c=component, d=design: kb.add_elements(c, d)))  # type: ignore[misc]
        asked.append(milliseconds(lambda: kb.model))
        removed.append(milliseconds(lambda c=component, d=design: kb.remove_elements(c, d)))  # type: ignore[misc]
    return (*map(statistics.median, (added, removed, asked)), max(*added, *removed))


def build(model: KnowledgeModel) -> float:
    """Milliseconds from elements to a knowledge base."""
    return milliseconds(lambda: KnowledgeBase(replace(model), SimulationClock()))


def main() -> None:
    """Print the table, in ms."""
    print(f"{'elements':>10}{'':14}{'add':>10}{'remove':>10}{'longest':>10}{'kb.model':>10}{'from nothing':>14}")
    for size in (1_000, 10_000, 100_000):
        model = many_small_robots(size)
        gc.collect()
        whole = build(model)
        with tempfile.TemporaryDirectory() as directory:
            for what, journal in (("", None), ("with journal", Path(directory) / "kb")):
                with KnowledgeBase(model, SimulationClock(), journal) as kb:
                    add, remove, asked, longest = grow_and_shrink(kb, 50)
                print(f"{size:10}{what:>14}{add:10.3f}{remove:10.3f}{longest:10.3f}{asked:10.3f}{whole:14.1f}")


if __name__ == "__main__":
    main()
