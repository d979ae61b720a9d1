"""How long the AGV's co-adaptive planner takes: ``python benchmarks/bench_agv.py [BRASS_MAP.json]``.

Times are in milliseconds. *First* is from the knowledge base and the map to the route, with nothing prepared; *again*
is one more question about the same map; *replanned* is from the write to the knowledge base that a component failed, or
from a corridor's closing, to the new route. Beside it the same question for networkx, on the product of places and
configurations as an explicit graph, and, where ``up-fast-downward`` is installed, for Fast Downward's optimal A*
through unified-planning (from the problem in memory to the plan).
"""

from __future__ import annotations

import importlib.util
import statistics
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from importlib.resources import files
from itertools import permutations, product
from pathlib import Path
from typing import Any

import networkx as nx

from agv_example.corridors import CorridorMap
from agv_example.drive_configurations import DriveOptions, drive_options
from agv_example.grids import grid_map
from agv_example.map_formats import load_map
from agv_example.planning import CoAdaptivePlanner, Objective, Route, drive_costs
from agv_example.planning.costs import StartUp, permits
from rosa_core import KnowledgeBase, KnowledgeModel

MODELS = Path(str(files("agv_example.models")))
ENERGY = Objective.cheapest("energy")
OBJECTIVES = (ENERGY, Objective.weighted({"energy": 1.0, "time": 0.5, "risk": 200.0}), Objective.first("time"))
START_UP = StartUp()


def knowledge() -> KnowledgeBase:
    """The AGV in which everything works."""
    return KnowledgeBase(KnowledgeModel.load(MODELS / "agv.yaml", MODELS / "agv_move.yaml"))


def plan(kb: KnowledgeBase, corridors: CorridorMap, ends: tuple[str, str], objective: Objective) -> Route | None:
    """From the knowledge base to the route."""
    options = drive_options(kb, {corridor.light for corridor in corridors.corridors})
    return CoAdaptivePlanner(corridors, options, START_UP).route(*ends, objective)


def milliseconds(work: Callable[[], object], times: int = 5) -> float:
    """The median of some repetitions."""
    taken = []
    for _ in range(times):
        began = time.perf_counter()
        work()
        taken.append(time.perf_counter() - began)
    return statistics.median(taken) * 1e3


def all_pairs(corridors: CorridorMap) -> None:
    """Every pair of places, asked of one planner, and each on its own from the knowledge base on."""
    kb = knowledge()
    planner = CoAdaptivePlanner(corridors, drive_options(kb, {c.light for c in corridors.corridors}), START_UP)
    pairs = list(permutations([place.name for place in corridors.places], 2))
    for objective in OBJECTIVES:
        taken, found = [], 0
        for one, other in pairs:
            began = time.perf_counter()
            found += planner.route(one, other, objective) is not None
            taken.append(time.perf_counter() - began)
        mean, worst = statistics.fmean(taken) * 1e3, max(taken) * 1e3
        some = pairs[:: max(1, len(pairs) // 200)]
        whole = statistics.fmean(milliseconds(partial(plan, kb, corridors, ends, objective), 1) for ends in some)
        print(
            f"{len(corridors.places)} places, {objective}: all {len(pairs)} pairs ({found} with a way), "
            f"mean {mean:.2f}, worst {worst:.2f}; each from the knowledge base on, mean {whole:.2f}"
        )


def one_pair(columns: int, rows: int) -> None:
    """From one corner of a grid to the other."""
    corridors = grid_map(columns, rows, 1)
    ends = ("p0_0", f"p{columns - 1}_{rows - 1}")
    kb = knowledge()
    for objective in OBJECTIVES:
        first = milliseconds(partial(plan, kb, corridors, ends, objective))
        options = drive_options(kb, {corridor.light for corridor in corridors.corridors})
        planner = CoAdaptivePlanner(corridors, options, START_UP)
        route = planner.route(*ends, objective)
        again = milliseconds(partial(planner.route, *ends, objective))
        failed = milliseconds(partial(replan_after_failure, kb, corridors, ends, objective))
        middle = route.corridors[len(route.corridors) // 2] if route is not None else corridors.corridors[0].name
        closed = milliseconds(partial(replan_closed, kb, corridors, middle, ends, objective))
        print(
            f"{columns * rows} places, {objective}: first {first:.1f}, again {again:.1f}, "
            f"replanned after a failure {failed:.1f}, after a closed corridor {closed:.1f}"
        )


def replan_after_failure(
    kb: KnowledgeBase, corridors: CorridorMap, ends: tuple[str, str], objective: Objective
) -> None:
    """The Kinect fails, and there must be another route."""
    kb.set_component_failure("kinect")
    plan(kb, corridors, ends, objective)
    kb.clear_component_failure("kinect")


def replan_closed(
    kb: KnowledgeBase, corridors: CorridorMap, name: str, ends: tuple[str, str], objective: Objective
) -> None:
    """A corridor in the middle of the route closes."""
    changed = corridors.changing(replace(corridors.corridor(name), closed=True))
    plan(kb, changed, ends, objective)


def usable(corridors: CorridorMap, options: DriveOptions) -> Iterable[tuple[str, str, int, float]]:
    """Every corridor in every direction and configuration: from, to, configuration, energy."""
    for corridor, (number, one) in product(corridors.corridors, enumerate(options.configurations)):
        if number in options.in_light(corridor.light) and permits(corridor, one):
            for origin in corridor.origins():
                costs = drive_costs(corridor, origin, one)
                if costs is not None:
                    yield origin, corridor.other_end(origin), number, costs.energy


def networkx_dijkstra(corridors: CorridorMap, options: DriveOptions, ends: tuple[str, str]) -> float:
    """The least energy, by networkx on the explicit product."""
    several = options.configurations
    graph: nx.DiGraph[Any] = nx.DiGraph()
    for number, one in enumerate(several):
        graph.add_edge("start", (ends[0], number), weight=START_UP.costs(frozenset(), one.components).energy)
        graph.add_edge((ends[1], number), "goal", weight=0.0)
    for place, (number, one), (to, other) in product(corridors.places, enumerate(several), enumerate(several)):
        if number != to:
            change = START_UP.costs(one.components, other.components).energy
            graph.add_edge((place.name, number), (place.name, to), weight=change)
    for origin, end, number, energy in usable(corridors, options):
        graph.add_edge((origin, number), (end, number), weight=energy)
    return float(nx.dijkstra_path_length(graph, "start", "goal"))


def fast_downward(corridors: CorridorMap, options: DriveOptions, ends: tuple[str, str]) -> float:
    """The seconds that Fast Downward takes for the least energy (in whole thousandths), with its optimal alias."""
    from unified_planning.shortcuts import (
        BoolType,
        Fluent,
        InstantaneousAction,
        IntType,
        MinimizeActionCosts,
        Object,
        OneshotPlanner,
        Problem,
        UserType,
        get_environment,
    )

    get_environment().credits_stream = None
    place, configuration = UserType("place"), UserType("configuration")
    at, runs = Fluent("at", BoolType(), p=place), Fluent("runs", BoolType(), c=configuration)
    way = Fluent("way", BoolType(), a=place, b=place, c=configuration)
    energy = Fluent("energy", IntType(), a=place, b=place, c=configuration)
    change = Fluent("change", IntType(), c=configuration, d=configuration)
    problem = Problem("agv")
    for fluent, default in ((at, False), (runs, False), (way, False), (energy, 0), (change, 0)):
        problem.add_fluent(fluent, default_initial_value=default)
    drive = InstantaneousAction("drive", a=place, b=place, c=configuration)
    a, b, c = (drive.parameter(name) for name in "abc")
    for condition in (at(a), runs(c), way(a, b, c)):
        drive.add_precondition(condition)
    drive.add_effect(at(a), False)
    drive.add_effect(at(b), True)
    switch = InstantaneousAction("switch", c=configuration, d=configuration)
    old, new = switch.parameter("c"), switch.parameter("d")
    switch.add_precondition(runs(old))
    switch.add_effect(runs(old), False)
    switch.add_effect(runs(new), True)
    problem.add_actions([drive, switch])
    places = {one.name: Object(one.name, place) for one in corridors.places}
    several = {number: Object(f"c{number}", configuration) for number, _ in enumerate(options.configurations)}
    problem.add_objects([*places.values(), *several.values()])
    for origin, end, number, cost in usable(corridors, options):
        problem.set_initial_value(way(places[origin], places[end], several[number]), True)
        problem.set_initial_value(energy(places[origin], places[end], several[number]), round(cost * 1000))
    for one, other in product(several, several):
        parts, others = options.configurations[one].components, options.configurations[other].components
        problem.set_initial_value(
            change(several[one], several[other]), round(START_UP.costs(parts, others).energy * 1000)
        )
    problem.set_initial_value(at(places[ends[0]]), True)
    problem.set_initial_value(runs(several[0]), True)
    problem.add_goal(at(places[ends[1]]))
    problem.add_quality_metric(MinimizeActionCosts({drive: energy(a, b, c), switch: change(old, new)}))
    with OneshotPlanner(name="fast-downward-opt") as planner:
        began = time.perf_counter()
        result = planner.solve(problem, timeout=240)
        taken = time.perf_counter() - began
    assert result.plan is not None, result.status
    return taken


def peers(columns: int, rows: int, *, downward: bool) -> None:
    """The same question for the others."""
    corridors, ends = grid_map(columns, rows, 1), ("p0_0", f"p{columns - 1}_{rows - 1}")
    options = drive_options(knowledge(), {corridor.light for corridor in corridors.corridors})
    ours = milliseconds(lambda: CoAdaptivePlanner(corridors, options, START_UP).route(*ends, ENERGY))
    theirs = milliseconds(lambda: networkx_dijkstra(corridors, options, ends), 1)
    line = f"{columns * rows} places: ours {ours:.1f}, networkx {theirs:.0f} ({theirs / ours:.0f} x)"
    if downward and importlib.util.find_spec("up_fast_downward") is not None:
        taken = fast_downward(corridors, options, ends) * 1e3
        line += f", Fast Downward, optimal {taken:.0f} ({taken / ours:.0f} x)"
    print(line)


def main() -> None:
    """Print the figures."""
    if len(sys.argv) > 1:
        all_pairs(load_map(sys.argv[1]))
        return
    all_pairs(grid_map(29, 2, 1, missing=0.4))
    one_pair(32, 32)
    one_pair(100, 100)
    peers(8, 7, downward=True)
    peers(10, 10, downward=True)
    peers(32, 32, downward=False)


if __name__ == "__main__":
    main()
