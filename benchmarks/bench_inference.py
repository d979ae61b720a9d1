"""From one measurement to all statuses: ``python benchmarks/bench_inference.py``.

Measured is a whole ``kb.add_measurement`` that crosses a limit: validated, inferred, recorded, announced (nobody
listens), beside building the same knowledge base from nothing, which is what inference without change would cost.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_evaluation.bench.synthetic import many_small_robots, one_measure_for_all
from suave.models import model_files


def timed(call: Callable[[], object]) -> float:
    """Seconds that a call takes."""
    began = time.perf_counter()
    call()
    return time.perf_counter() - began


def measurements(kb: KnowledgeBase, measure: str, values: tuple[float, float], count: int) -> list[float]:
    """Seconds that each of ``count`` measurements takes, alternating between two values."""
    kb.add_measurement(measure, values[1])
    return [timed(lambda v=values[n % 2]: kb.add_measurement(measure, v)) for n in range(count)]  # type: ignore[misc]


def report(name: str, model: KnowledgeModel, measure: str, values: tuple[float, float], count: int) -> None:
    """Print the median and the 99th percentile, and how they compare with inferring everything."""
    kb = KnowledgeBase(model, clock=SimulationClock())
    whole = timed(lambda: KnowledgeBase(model, clock=SimulationClock()))
    for action in kb.selectable_actions()[:50]:
        kb.request_action(action)
    times = sorted(measurements(kb, measure, values, count))
    changed = 0

    def count_changes(event: object) -> None:
        nonlocal changed
        changed = max(changed, len(getattr(event, "changes", ())))

    kb.subscribe(count_changes)
    measurements(kb, measure, values, 2)
    median, late = statistics.median(times), times[int(len(times) * 0.99)]
    print(
        f"{name:34}{median * 1e6:12.1f}{late * 1e6:12.1f}{changed:10}{median / max(changed, 1) * 1e6:12.2f}"
        f"{whole * 1e3:14.1f}{whole / median:12.0f}"
    )


def main() -> None:
    """Print the table."""
    print(f"{'':34}{'median us':>12}{'p99 us':>12}{'changed':>10}{'us/changed':>12}{'build ms':>14}{'ratio':>12}")
    suave = KnowledgeModel.load(*model_files(extended=True))
    report("SUAVE extended, battery", suave, "battery_level", (0.2, 0.3), 5000)
    report("SUAVE extended, visibility", suave, "water_visibility", (3.0, 3.5), 5000)
    for size in (100, 1_000, 10_000, 100_000):
        report(f"{size} elements, small cone", many_small_robots(size), "m0", (0.5, 1.5), 5000)
    for size in (100, 1_000, 10_000):
        report(f"wide cone, {size} configurations", one_measure_for_all(size), "m", (0.5, 1.5), 20)


if __name__ == "__main__":
    main()
