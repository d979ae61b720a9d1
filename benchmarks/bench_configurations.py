"""How long the best of 10^6 configurations takes: 6 functions with 10 designs each, of random estimations.

Run: ``python benchmarks/bench_configurations.py``. Times are in milliseconds over random instances, from the
alternatives to the answer; ``first 100`` is the time for the 100 best, in order; ``request`` that from
``kb.request_action`` to the reconfiguration plan, with all that the knowledge base and the planner do.
"""

from __future__ import annotations

import itertools
import random
import statistics
import sys
import time

from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_core.choice import (
    Alternatives,
    ConfigurationOption,
    DesignOption,
    best_configuration,
    complete_configurations,
)
from rosa_core.mape import ConfigurationPlanner
from rosa_core.model.elements import (
    Action,
    Component,
    ComponentConfiguration,
    ElementKind,
    ElementRef,
    Estimation,
    EstimationType,
    Function,
    FunctionalRequirement,
    FunctionDesign,
    Measure,
)
from rosa_core.model.utility import Utility

GOAL_MS = 20.0
UTILITY = {"safety": 1.0, "energy": -0.5}


def instance(
    seed: int, *, pool: int = 0, configurations: int = 0, like_energy: bool = False, absolutes: int = 0
) -> Alternatives:
    """Random alternatives.

    Args:
        seed: of the random numbers.
        pool: how many components the designs of all functions share; 0: each design has one of its own.
        configurations: how many each component has.
        like_energy: safety goes with energy, which is the hard case for a limit on energy.
        absolutes: how many of the designs set safety absolutely.
    """
    rng = random.Random(seed)
    functions, estimations, components = {}, [], {}

    def estimate(kind: ElementKind, name: str, scale: float) -> None:
        energy = round(rng.uniform(0.0, scale), 2)
        safety = round(energy + rng.uniform(-0.1, 0.1) * scale if like_energy else rng.uniform(0.0, scale), 2)
        for measure, value in (("energy", energy), ("safety", safety)):
            estimations.append(Estimation(ElementRef(kind, name), measure, value))

    for f in range(6):
        options = []
        for d in range(10):
            shared = rng.sample(range(pool), min(pool, rng.randint(1, 3)))
            parts = tuple(f"c{c}" for c in shared) or (f"c{f}.{d}",)
            options.append(DesignOption(f"d{f}.{d}", parts, float(rng.randint(1, 3))))
            estimate(ElementKind.FUNCTION_DESIGN, f"d{f}.{d}", 10.0)
        functions[f"f{f}"] = tuple(options)
    for name in dict.fromkeys(c for options in functions.values() for o in options for c in o.components):
        estimate(ElementKind.COMPONENT, name, 5.0)
        if configurations:
            components[name] = tuple(ConfigurationOption(f"{name}/{k}", float(k)) for k in range(configurations))
            for k in range(configurations):
                estimate(ElementKind.COMPONENT_CONFIGURATION, f"{name}/{k}", 3.0)
    for index in rng.sample(range(60), absolutes):
        ref = ElementRef(ElementKind.FUNCTION_DESIGN, f"d{index // 10}.{index % 10}")
        estimations = [e for e in estimations if (e.causer, e.measure) != (ref, "safety")]
        estimations.append(Estimation(ref, "safety", round(rng.uniform(20.0, 40.0), 2), EstimationType.ABSOLUTE))
    return Alternatives(functions, components, tuple(estimations))


PLAIN = Utility(UTILITY)
LIMITED = Utility(UTILITY, (("energy", "<=", 35.0),))
LIMITED_TWICE = Utility({"accuracy": 1.0, "safety": 1.0}, (("energy", "<=", 40.0), ("safety", ">=", 45.0)))

CASES = {
    "plain": ({}, PLAIN),
    "one limit": ({}, LIMITED),
    "two limits": ({}, LIMITED_TWICE),
    "one limit, correlated": ({"like_energy": True}, Utility({"safety": 1.0}, (("energy", "<=", 35.0),))),
    "subset sum (utility is what is limited)": ({}, Utility({"energy": 1.0}, (("energy", "<=", 35.0),))),
    "20 shared components": ({"pool": 20}, PLAIN),
    "8 shared components": ({"pool": 8}, PLAIN),
    "20 shared components, one limit": ({"pool": 20}, LIMITED),
    "12 shared components x 3 configurations": ({"pool": 12, "configurations": 3}, PLAIN),
    "12 shared x 3 configurations, one limit": ({"pool": 12, "configurations": 3}, LIMITED),
    "own components x 3 configurations, one limit": ({"configurations": 3}, LIMITED),
    "6 absolute estimations": ({"absolutes": 6}, PLAIN),
}


def measure(arguments: dict[str, int], utility: Utility, seeds: range) -> tuple[list[float], list[float]]:
    """Times in ms for the best, and for the first 100."""
    best, hundred = [], []
    for seed in seeds:
        alternatives = instance(seed, **arguments)
        start = time.perf_counter()
        best_configuration(alternatives, utility)
        best.append((time.perf_counter() - start) * 1e3)
        start = time.perf_counter()
        list(itertools.islice(complete_configurations(alternatives, utility), 100))
        hundred.append((time.perf_counter() - start) * 1e3)
    return best, hundred


def request(arguments: dict[str, int], utility: Utility, seeds: range) -> list[float]:
    """Times in ms from the request of the action to the reconfiguration plan, knowledge base and planner included."""
    times = []
    for seed in seeds:
        alternatives = instance(seed, **arguments)
        names = {
            component for options in alternatives.functions.values() for o in options for component in o.components
        }
        model = KnowledgeModel(
            measures=tuple(Measure(name) for name in ("energy", "safety", "accuracy")),
            actions=(Action("act"),),
            functions=tuple(Function(name) for name in alternatives.functions),
            components=tuple(Component(name) for name in sorted(names)),
            requirements=(FunctionalRequirement("act", tuple(alternatives.functions)),),
            function_designs=tuple(
                FunctionDesign(option.name, function, option.components, option.priority)
                for function, options in alternatives.functions.items()
                for option in options
            ),
            component_configurations=tuple(
                ComponentConfiguration(option.name, component, (), option.priority)
                for component, options in alternatives.components.items()
                for option in options
            ),
            estimations=alternatives.estimations,
        )
        kb = KnowledgeBase(model)
        kb.subscribe(ConfigurationPlanner(kb).on_event, ConfigurationPlanner.EVENTS)
        start = time.perf_counter()
        kb.request_action("act", utility=utility)
        times.append((time.perf_counter() - start) * 1e3)
    return times


def main(instances: int = 20) -> None:
    """Print a table; ``instances`` random ones per row."""
    print(f"{'best of 10^6 [ms]':46}{'median':>8}{'worst':>8}{'first 100':>11}{'request':>9}   goal {GOAL_MS:g}")
    for name, (arguments, utility) in CASES.items():
        best, hundred = measure(arguments, utility, range(instances))
        whole = statistics.median(request(arguments, utility, range(instances)))
        median, worst = statistics.median(best), max(best)
        verdict = "met" if worst <= GOAL_MS else "met by the median" if median <= GOAL_MS else "missed"
        print(f"{name:46}{median:8.1f}{worst:8.1f}{statistics.median(hundred):11.1f}{whole:9.1f}   {verdict}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]))
