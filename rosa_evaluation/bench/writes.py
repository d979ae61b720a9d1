"""Measures what is not inference: choosing among many configurations, durable writes, memory."""

from __future__ import annotations

import random
import tempfile
import tracemalloc
from collections.abc import Iterator
from itertools import cycle
from pathlib import Path

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
from rosa_core.kb import Limit, Utility
from rosa_core.mape import ConfigurationPlanner
from rosa_core.model.elements import (
    Action,
    Component,
    ConstraintOperator,
    ElementKind,
    ElementRef,
    Estimation,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from rosa_evaluation.bench.inference import Timing, count_elements, median_seconds
from rosa_evaluation.bench.synthetic import many_small_robots


def measure_writes() -> Iterator[Timing]:
    """The figures, as they are measured."""
    yield _best_configuration()
    yield from _journal()


def bytes_per_element(size: int) -> float:
    """Memory that a knowledge base of about ``size`` elements takes, its model not counted, per element."""
    model = many_small_robots(size)
    tracemalloc.start()
    try:
        before, _ = tracemalloc.get_traced_memory()
        kb = KnowledgeBase(model, clock=SimulationClock())
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    return (after - before) / count_elements(kb.model)


def _best_configuration() -> Timing:
    """From the request of an action to its reconfiguration plan: 6 functions with 10 designs each, one limit."""
    model = _million_configurations()
    kb = KnowledgeBase(model, clock=SimulationClock())
    kb.subscribe(ConfigurationPlanner(kb).on_event, ConfigurationPlanner.EVENTS)
    utility = Utility({"safety": 1.0, "energy": -0.5}, (Limit("energy", ConstraintOperator.LESS_OR_EQUAL, 40.0),))

    def choose() -> None:
        kb.request_action("a", utility=utility)
        kb.cancel_action("a")

    return Timing("best of 10^6 configurations", count_elements(model), median_seconds(choose, 5))


def _million_configurations() -> KnowledgeModel:
    rng = random.Random(1)  # noqa: S311 - no secrets here, only the same numbers every time
    functions = [f"f{i}" for i in range(6)]
    designs = [FunctionDesign(f"d{f}.{n}", f, (f"c{f}.{n}",)) for f in functions for n in range(10)]
    return KnowledgeModel(
        measures=(Measure("energy"), Measure("safety")),
        actions=(Action("a"),),
        functions=tuple(map(Function, functions)),
        components=tuple(Component(name) for design in designs for name in design.components),
        requirements=(FunctionalRequirement("a", tuple(functions)),),
        function_designs=tuple(designs),
        estimations=tuple(
            Estimation(ElementRef(ElementKind.COMPONENT, design.components[0]), measure, round(rng.uniform(0, 15), 2))
            for design in designs
            for measure in ("energy", "safety")
        ),
    )


def _journal() -> Iterator[Timing]:
    model = many_small_robots(1000)
    count = count_elements(model)
    values = cycle((0.5, 1.5))
    with tempfile.TemporaryDirectory() as directory:
        path = Path(directory) / "journal.sqlite"
        with KnowledgeBase(model, SimulationClock(), path) as kb:
            seconds = median_seconds(lambda: kb.add_measurement("m0", next(values)), 2000)
    yield Timing("one measurement, journalled", count, seconds)
