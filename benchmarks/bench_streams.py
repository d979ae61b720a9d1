"""How fast streams are: ``python benchmarks/bench_streams.py [SECTION...]``; sections: matrix plans exact repair
formulas chain learning."""

from __future__ import annotations

import itertools
import random
import statistics
import sys
import threading
import time
import tracemalloc
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.stream_libraries import random_library, structured_library
from rosa_core.clock import SimulationClock, WallClock
from rosa_streams.costs import DeclaredCosts, LearnedCosts, Objective
from rosa_streams.environment import Change, Environment, Port, Transformation, Unit
from rosa_streams.manager import Manager
from rosa_streams.matching import ValidityMatrix
from rosa_streams.planning import plan, problem_of
from rosa_streams.planning.exact import optimal_choice
from rosa_streams.planning.paper_search import paper_search
from rosa_streams.planning.problem import Problem
from rosa_streams.runtime import Function, Host, Sources
from rosa_streams.tags import Concept, Named, One, Ontology, Some, parse_tag
from rosa_streams.tags.ontology import Axioms, Individual
from rosa_streams.temporal import Monitor


def main(wanted: list[str]) -> None:
    """Run the sections that are named, or all."""
    sections: dict[str, Callable[[], None]] = {
        "matrix": bench_matrix,
        "plans": bench_plans,
        "exact": bench_exact,
        "repair": bench_repair,
        "formulas": bench_formulas,
        "chain": bench_chain,
        "learning": bench_learning,
    }
    for name, section in sections.items():
        if not wanted or name in wanted:
            print(f"\n{name}")
            section()


def row(what: str, figure: str, aim: str = "") -> None:
    """Print a line of the table."""
    print(f"  {what:<66} {figure:<34} {aim}", flush=True)


def best_of(work: Callable[[], Any], repeat: int, clock: Callable[[], float] = time.perf_counter) -> float:
    """The median time of a call, in seconds of the clock."""
    times = []
    for _ in range(repeat):
        start = clock()
        work()
        times.append(clock() - start)
    return statistics.median(times)


# -- the validity matrix --


def one_robot(robot: str = "piff") -> list[Transformation]:
    """Transformations with the ports of the paper's table I: 11 inputs, 19 outputs."""
    source = Some("hasSource", Concept.of(One(robot)))

    def port(name: str, kind: str, *more: Some) -> Port:
        return Port(name, Concept.of(Named(kind), source, *more))

    sizes = ("640X480", "320X240", "160X120", "80X60", "40X30")
    field, ball = Some("hasTarget", Concept.of(One("field"))), Some("hasTarget", Concept.of(Named("Ball")))
    luma = [port(f"y{size}", f"Y{size}Image") for size in sizes]
    images = tuple(port(f"{channel}{size}", f"{channel}{size}Image") for channel in "YUV" for size in sizes)
    position = Port("position", Concept.of(Named("Position"), Some("hasSource", Concept.of(Named("Ball")))))
    return [
        Transformation(f"bottom_cam({robot})", "cam", (), (port("image", "YUVImage"),)),
        Transformation(f"subsampler({robot})", "sub", (port("image", "YUVImage"),), images),
        Transformation(
            f"segmenter({robot})",
            "seg",
            (port("y", "Y80X60Image"), port("v", "V80X60Image")),
            (port("h", "Hull", field),),
        ),
        Transformation(
            f"ball_detector({robot})", "det", (port("h", "Hull", field), *luma), (port("b", "Pixel", ball),)
        ),
        Transformation(
            f"ball_localization({robot})", "loc", (port("b", "Pixel", ball), port("p", "Pose")), (position,)
        ),
    ]


def robots_ontology() -> Ontology:
    """Two robots and a field."""
    known = {name: Individual((parse_tag("NAO"),)) for name in ("piff", "puff")}
    return Ontology(Axioms(frozenset({"NAO"}), individuals={**known, "field": Individual((parse_tag("Field"),))}))


def bench_matrix() -> None:
    """Matching of tags."""
    robot, both = one_robot(), [*one_robot(), *one_robot("puff")]
    matrix = ValidityMatrix.of(robot, similarity=robots_ontology())
    row("ports of one robot", f"{len(matrix.inputs)} x {len(matrix.outputs)}", "11 x 19")
    took = best_of(lambda: ValidityMatrix.of(robot, similarity=robots_ontology()), 50)
    row("from nothing, one robot", f"{took * 1e3:.2f} ms", "<= 2 ms")
    took = best_of(lambda: ValidityMatrix.of(both, similarity=robots_ontology()), 50)
    row("from nothing, two robots (22 x 38)", f"{took * 1e3:.2f} ms")
    new = Transformation(
        "new", "new", (Port("in", parse_tag("Hull ⊓ ∃hasSource.piff")),), (Port("out", parse_tag("Y80X60Image")),)
    )
    times = []
    for _ in range(50):
        fresh = ValidityMatrix.of(both, similarity=robots_ontology())
        start = time.perf_counter()
        fresh.add(new)
        times.append(time.perf_counter() - start)
    row("one transformation added to two robots", f"{statistics.median(times) * 1e3:.3f} ms", "<= 0.2 ms")


# -- planning --


def solvable(make: Callable[[int], Environment], count: int) -> list[tuple[int, Environment, ValidityMatrix, Problem]]:
    """Libraries of which the targets can be reached."""
    found = []
    for seed in itertools.count():
        environment = make(seed)
        matrix = ValidityMatrix.of(environment.library().values(), environment.targets, environment.similarity)
        problem = problem_of(environment, DeclaredCosts(), None, matrix)
        if not problem.unsatisfiable_goals():
            found.append((seed, environment, matrix, problem))
            if len(found) == count:
                return found
    raise AssertionError


def bench_plans() -> None:
    """The immediate plan and the paper's search."""
    for count, aim in ((300, 5), (1000, 20), (10_000, 150)):
        times, processor = [], []
        for _, environment, matrix, _ in solvable(partial(structured_library, count), 5):
            work = partial(plan, environment, search="fast", matrix=matrix)
            times.append(best_of(work, 5))
            processor.append(best_of(work, 5, time.process_time))
        row(
            f"immediate plan, {count} transformations (problem to change set)",
            f"{statistics.median(times) * 1e3:.1f} ms ({statistics.median(processor) * 1e3:.1f} of processor time)",
            f"<= {aim} ms",
        )
    for title, make in (
        ("random, 300", lambda seed: random_library(300, seed, kinds=40)),
        ("structured, 300", partial(structured_library, 300)),
        ("dense (8 layers, no short cuts, costs alike), 300", dense_library),
    ):
        outcomes = [paper_search(problem, timeout=8.0) for _, _, _, problem in solvable(make, 3)]
        plans = sum(outcome.chosen is not None for outcome in outcomes)
        done = sum(outcome.exhausted for outcome in outcomes)
        row(f"the paper's search in 8 s, {title} transformations", f"a plan in {plans} of 3, exhausted {done} of 3")


def dense_library(seed: int, count: int = 300) -> Environment:
    """Hard to search: every pipeline is eight deep, and all cost about the same."""
    return structured_library(count, seed, branching=5, layers=8, sharing=0.0, labor=(40, 60))


def bench_exact() -> None:
    """The proven optimum, and what the paper's objective and search cost beside it."""
    for count in (300, 1000):
        outcomes = [
            optimal_choice(problem, deadline=10.0) for *_, problem in solvable(partial(dense_library, count=count), 3)
        ]
        gaps = []
        for (*_, problem), optimum in zip(solvable(partial(dense_library, count=count), 3), outcomes, strict=True):
            best = problem.cost(optimum.chosen or ())
            gaps.append((best - optimum.bound) / best)
        proven = sum(optimum.proven for optimum in outcomes)
        row(f"optimum in 10 s, dense library of {count}", f"{proven} of 3 proven, worst gap {max(gaps) * 100:.0f} %")
    for count, seeds in ((100, 10), (1000, 10), (10_000, 5)):
        times, ratios, paper, proven = [], [], [], 0
        for _, environment, matrix, problem in solvable(
            lambda seed, count=count: structured_library(count, seed), seeds
        ):  # type: ignore[misc]
            start = time.perf_counter()
            optimum = optimal_choice(problem, deadline=60.0)
            times.append(time.perf_counter() - start)
            proven += optimum.proven
            assert optimum.chosen is not None
            best = problem.cost(optimum.chosen)
            tree = plan(environment, search="fast", matrix=matrix).cost
            assert tree is not None
            ratios.append(tree / best)
            if count == 100:
                outcome = paper_search(problem, timeout=2.0)
                paper.append(problem.cost(outcome.chosen) / best if outcome.chosen else float("nan"))
        row(
            f"optimum, structured library of {count} ({proven} of {seeds} proven)",
            f"{statistics.median(times):.2f} s median, worst {max(times):.2f}",
            "<= 1 s median" if count == 1000 else "",
        )
        row("  cost of the immediate plan / optimum", f"{statistics.mean(ratios):.2f} mean, {max(ratios):.2f} worst")
        if paper:
            known = [ratio for ratio in paper if ratio == ratio]  # noqa: PLR0124
            what = f"{statistics.mean(known):.2f} mean, {max(known):.2f} worst" if known else "no plan"
            row(f"  cost of the paper's search (2 s) / optimum, {len(known)} of {seeds} had a plan", what, "1.0 to 1.7")


# -- repair --

STAGES = 5


def pipeline_sources(period: float) -> Sources:
    """A source and stages that pass numbers on."""
    known = Sources()
    known.factory("source")(lambda _: Function(lambda _, at: (at, at + 1), (), ("out",), state=0, period=period))
    known.function("stage", lambda value: value)
    return known


def pipeline() -> list[Transformation]:
    """A chain of a source and four stages."""
    stages = [Transformation("s0", "source", (), (Port("out", parse_tag("K0")),), labor=1.0)]
    stages += [
        Transformation(
            f"s{number}",
            "stage",
            (Port("in", parse_tag(f"K{number - 1}")),),
            (Port("out", parse_tag(f"K{number}")),),
            labor=1.0,
        )
        for number in range(1, STAGES)
    ]
    return stages


def percentiles(times: list[float], unit: float, name: str) -> str:
    """Median and 99 %."""
    ordered = sorted(times)
    return f"p50 {ordered[len(ordered) // 2] * unit:.2f}, p99 {ordered[int(len(ordered) * 0.99)] * unit:.2f} {name}"


def bench_repair() -> None:
    """From a lost unit to the next sample of the target."""
    losses = 1000
    rng = random.Random(0)
    clock = SimulationClock()
    manager = Manager(clock, pipeline_sources(0.01), objective=Objective(horizon=3600.0), tries=10**6)
    arrivals: list[float] = []
    manager.subscribe("/result", lambda _: arrivals.append(clock.now()))
    manager.register(pipeline())
    manager.add_target("q", f"K{STAGES - 1}", "/result")
    waits, works, touched = [], [], []
    for _ in range(losses):
        clock.advance_to(clock.now() + rng.uniform(0.02, 0.05))
        victim = rng.choice(sorted(manager.environment.graph()))
        seen = len(arrivals)
        lost_at = clock.now()
        start = time.perf_counter()
        manager.host.lose(victim)
        clock.advance_to(lost_at)
        works.append(time.perf_counter() - start)
        touched.append(len(manager.journal[-1].change.created()))
        while len(arrivals) == seen:
            clock.advance_to(clock.now() + 0.001)
        waits.append(clock.now() - lost_at)
    row(f"{losses} losses, simulated: to the next sample (source at 100 Hz)", percentiles(waits, 1e3, "ms simulated"))
    row("  computing of a repair (loss to connected again)", percentiles(works, 1e3, "ms"))
    row("  units made anew in a repair", f"mean {statistics.mean(touched):.2f}, most {max(touched)}", "1 in case B")
    manager.close()
    bench_repair_in_real_time(300)


def bench_repair_in_real_time(losses: int) -> None:
    """The same with threads, source at 500 Hz."""
    rng = random.Random(1)
    manager = Manager(WallClock(), pipeline_sources(0.002), objective=Objective(horizon=3600.0), tries=10**6)
    arrived = threading.Event()
    manager.subscribe("/result", lambda _: arrived.set())
    manager.register(pipeline())
    manager.add_target("q", f"K{STAGES - 1}", "/result")
    waits = []
    for _ in range(losses):
        arrived.clear()
        arrived.wait(5)
        victim = rng.choice(sorted(unit.cid for unit in manager.host.units()))
        cycle = manager.cycle
        arrived.clear()
        start = time.perf_counter()
        manager.host.lose(victim)
        while manager.cycle == cycle:
            time.sleep(0.0002)
        arrived.clear()
        arrived.wait(5)
        waits.append(time.perf_counter() - start)
    row(f"{losses} losses, real time: to the next sample (source at 500 Hz)", percentiles(waits, 1e3, "ms"))
    manager.close()


# -- formulas --


def bench_formulas() -> None:
    """Updates a second of monitors."""
    count = 1_000_000
    times = np.arange(count) / 100
    columns = {
        "x": np.full(count, 5.0),
        "lost": (np.arange(count) % 1000 == 1).astype(float),
        "found": (np.arange(count) % 100 == 50).astype(float),
    }
    for text, aim in (
        ("G (lost -> F[0,5] found)", ">= 1 000 000/s"),
        ("G (x > 3 -> F[0,5] found)", ">= 1 000 000/s"),
        ("G x > 3", ">= 1 000 000/s"),
    ):
        monitor = Monitor(text)
        start = time.perf_counter()
        monitor.run(times, columns)
        row(f"{text}, periodic, columns", f"{count / (time.perf_counter() - start):,.0f}/s", aim)
    short = 30_000
    monitor = Monitor("G[0,300] x > 3")
    start = time.perf_counter()
    monitor.run(times[:short], {"x": columns["x"][:short]})
    row("G[0,300] x > 3, columns", f"{short / (time.perf_counter() - start):,.0f}/s", ">= 250 000/s")
    for text in ("G (lost -> F[0,5] found)", "G[0,300] x > 3", "O[0,5] found"):
        monitor = Monitor(text)
        states = [{name: float(column[index]) for name, column in columns.items()} for index in range(short)]
        moments = times[:short].tolist()
        start = time.perf_counter()
        for state, moment in zip(states, moments, strict=True):
            monitor.step(state, moment)
        row(f"{text}, one call a state", f"{short / (time.perf_counter() - start):,.0f}/s")
    bench_memory()
    bench_peers(columns, times)


def bench_memory() -> None:
    """A day at 100 Hz."""
    monitor = Monitor("G (lost -> (F[0,30] found and not (found U[2,60] x > 9)))")
    tracemalloc.start()
    peaks = []
    for hour in range(24):
        index = np.arange(hour * 360_000, (hour + 1) * 360_000)
        columns = {
            "lost": (index % 7777 == 0).astype(float),
            "found": (index % 2000 == 0).astype(float),
            "x": np.zeros(len(index)),
        }
        tracemalloc.reset_peak()
        monitor.run(index / 100, columns)
        del columns, index
        peaks.append(tracemalloc.get_traced_memory()[0] / 1e6)
    tracemalloc.stop()
    row(
        "24 h of samples at 100 Hz: memory after 1, 6, 24 h",
        f"{peaks[0]:.1f}, {peaks[5]:.1f}, {peaks[23]:.1f} MB",
        "flat",
    )


def bench_peers(columns: dict[str, Any], times: Any) -> None:
    """Other libraries on what they can do: past operators, and (late) future ones; where they are installed."""
    short = 20_000
    try:
        import reelay

        peer = reelay.dense_timed_monitor(
            pattern="historically({lost: false} or once[0:5]{found: true})", semantics="boolean"
        )
        updates = [
            {"time": float(times[i]), "lost": bool(columns["lost"][i]), "found": bool(columns["found"][i])}
            for i in range(short)
        ]
        start = time.perf_counter()
        for update in updates:
            peer.update(update)
        row("reelay, H (not lost or O[0,5] found)", f"{short / (time.perf_counter() - start):,.0f}/s")
    except ImportError:
        row("reelay", "not installed")
    try:
        import rtamt

        peer = rtamt.StlDiscreteTimeSpecification()
        peer.declare_var("lost", "float")
        peer.declare_var("found", "float")
        peer.spec = "always[0,500]((lost >= 0.5) implies (eventually[0,500](found >= 0.5)))"
        peer.parse()
        peer.pastify()
        start = time.perf_counter()
        for index in range(2000):
            peer.update(index, [("lost", float(columns["lost"][index])), ("found", float(columns["found"][index]))])
        row("rtamt, pastified G[0,500] (lost -> F[0,500] found)", f"{2000 / (time.perf_counter() - start):,.0f}/s")
    except ImportError:
        row("rtamt", "not installed")


# -- samples through a chain --


def bench_chain() -> None:
    """Five units in a row, in process."""
    tag = parse_tag("Number")
    library = {"inc": Transformation("inc", "inc", (Port("in", tag),), (Port("out", tag),))}
    units = frozenset(
        Unit.of(f"inc.{place}", "inc", {"in": f"/c{place}"}, {"out": f"/c{place + 1}"}) for place in range(5)
    )
    known = Sources()
    known.function("inc", lambda value: value + 1)
    host = Host(SimulationClock(), known)
    host.apply(Change(units_added=units), library)
    counted = itertools.count()
    host.subscribe("/c5", lambda _: next(counted))
    count = 100_000
    start, cpu = time.perf_counter(), time.process_time()
    for number in range(count):
        host.publish("/c0", number, float(number))
    wall, cpu = time.perf_counter() - start, time.process_time() - cpu
    row(
        "samples through five units, simulated time",
        f"{count / wall:,.0f}/s ({count / cpu:,.0f} a cpu second)",
        ">= 100 000/s",
    )
    threaded = Host(WallClock(), known, workers=1)
    threaded.apply(Change(units_added=units), library)
    latencies: list[float] = []
    threaded.subscribe("/c5", lambda sample: latencies.append(time.perf_counter() - (sample.value - 5)))
    for _ in range(3000):
        threaded.publish("/c0", time.perf_counter())
        time.sleep(0.0005)
    time.sleep(0.1)
    row("added latency of five units, threads", percentiles(latencies, 1e3, "ms"), "p99 <= 0.2 ms")
    threaded.close()


# -- learning --


def bench_learning() -> None:
    """Regret of first guesses: cost over 50 cycles compared with always running the cheapest of eight."""
    for title, guess in (("explore (guess 0)", 0.0), ("exploit (guess 1000)", 1000.0), ("guess at the mean", 0.05)):
        ratios = []
        for seed in range(10):
            rng = random.Random(seed)
            true = [rng.uniform(0.01, 0.1) for _ in range(8)]
            spent = cost_of_cycles(true, guess, 50)
            ratios.append(spent / (min(true) * 10.0 * 50))
        row(f"{title}: upkeep of 50 cycles / oracle's", f"{statistics.mean(ratios):.2f} mean, {max(ratios):.2f} worst")


def cost_of_cycles(true: list[float], guess: float, cycles: int) -> float:
    """Upkeep actually paid when the planner chooses among transformations by what it has learned."""
    tag = parse_tag("A")
    library = [Transformation(f"t{number}", "t", (), (Port("out", tag),), labor=0.01) for number in range(len(true))]
    costs = LearnedCosts(first_labor=0.01, first_upkeep=guess)
    from rosa_streams.environment import Target, update

    environment = Environment(frozenset(), frozenset(library), frozenset({Target("q", tag, "/r")}))
    spent = 0.0
    for _ in range(cycles):
        environment = update(environment, plan(environment, costs, Objective(horizon=10.0), search="fast").change)
        for unit in environment.units:
            rate = true[int(unit.tid[1:])]
            spent += rate * 10.0
            costs.observe_upkeep(environment.library()[unit.tid], [rate])
    return spent


if __name__ == "__main__":
    main(sys.argv[1:])
