"""What a journal costs: microseconds per write without one, with ``synchronous=NORMAL`` and with ``FULL``.

    python benchmarks/bench_journal.py [--writes N] [--elements N] [--directory DIR]

Every write is a measurement that changes the status of a constraint, of a configuration, and of its component. With
``FULL`` it depends on the disk more than on anything else: name a directory on the disk that you will use.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from pathlib import Path

from rosa_core import JournalOptions, KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    Constraint,
    ElementKind,
    ElementRef,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)


def make_model(elements: int) -> KnowledgeModel:
    """A model of about so many elements: units of an action, a function, a design, a component, and so on."""
    units = range(max(elements // 7, 1))
    return KnowledgeModel(
        measures=tuple(Measure(f"m{i}") for i in units),
        actions=tuple(Action(f"a{i}") for i in units),
        functions=tuple(Function(f"f{i}") for i in units),
        components=tuple(Component(f"c{i}") for i in units),
        requirements=tuple(FunctionalRequirement(f"a{i}", (f"f{i}",)) for i in units),
        function_designs=tuple(FunctionDesign(f"d{i}", f"f{i}", (f"c{i}",)) for i in units),
        component_configurations=tuple(ComponentConfiguration(f"cc{i}", f"c{i}") for i in units),
        constraints=tuple(
            Constraint(f"m{i}", ElementRef(ElementKind.COMPONENT_CONFIGURATION, f"cc{i}"), value=0.5) for i in units
        ),
    )


def measure_writes(kb: KnowledgeBase, writes: int) -> list[float]:
    """Microseconds for each write."""
    measures = kb.model.names[ElementKind.MEASURE]
    took = []
    for index in range(writes):
        measure = measures[index % min(len(measures), 100)]
        value = (index // 100) % 2
        began = time.perf_counter()
        kb.add_measurement(measure, value)
        took.append((time.perf_counter() - began) * 1e6)
    return took


def show(what: str, took: list[float]) -> None:
    """One line of the table."""
    took.sort()
    percentiles = (took[len(took) // 2], took[len(took) * 99 // 100], took[len(took) * 999 // 1000])
    cells = "".join(f"{value:12.1f}" for value in (*percentiles, statistics.fmean(took)))
    print(f"{what:14}{len(took):9}{cells}")


def main() -> None:
    """Measure, print the table, and how long reopening takes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--writes", type=int, default=20_000)
    parser.add_argument("--elements", type=int, default=1_000)
    parser.add_argument("--directory", type=Path, default=None, help="where to make the journals")
    options = parser.parse_args()
    model = make_model(options.elements)
    print(f"{sum(map(len, model.names.values())) + len(model.constraints)} elements; microseconds per write")
    print(f"{'journal':14}{'writes':>9}{'median':>12}{'p99':>12}{'p99.9':>12}{'mean':>12}")
    with tempfile.TemporaryDirectory(dir=options.directory) as directory:
        with KnowledgeBase(model, SimulationClock()) as kb:
            show("none", measure_writes(kb, options.writes))
        path = Path(directory) / "normal"
        with KnowledgeBase(model, SimulationClock(), path) as kb:
            show("NORMAL", measure_writes(kb, options.writes))
        full = JournalOptions(synchronous="FULL")
        with KnowledgeBase(model, SimulationClock(), Path(directory) / "full", journal_options=full) as kb:
            show("FULL", measure_writes(kb, options.writes // 10))
        began = time.perf_counter()
        KnowledgeBase(model, SimulationClock(), path).close()
        took = time.perf_counter() - began
        size = path.stat().st_size / 1e6
        print(f"reopening {options.writes} writes ({size:.1f} MB) takes {took * 1e3:.0f} ms")


if __name__ == "__main__":
    main()
