"""How fast reflexes are: ``python benchmarks/bench_reflexes.py [--samples N] [--threads N] [--campaign DIR]``.

Latency is from the moment at which a sample is there to the moment at which the actuators are called. Missions are read
from the results of ``rosa campaign pioneer --managers rosa,gate,rocs,deliberative,reactive --runs 500 --out DIR``.
"""

from __future__ import annotations

import argparse
import gc
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from statistics import mean, median
from typing import Any

import numpy as np

from pioneer_example.reflexes import pioneer_reflexes
from rosa_core.clock import SimulationClock, WallClock
from rosa_evaluation.campaign.results import Results
from rosa_evaluation.statistics import compare, corrected
from rosa_reflexes import Command, CommandGate, Reflex, SensorLimits, parse_rule
from rosa_reflexes.rocs import (
    Action,
    ActionStatus,
    Activity,
    Actuator,
    EventRunner,
    Execute,
    Knowledge,
    Pipeline,
    PublishedLoop,
    ReactiveModel,
    RobotModel,
    Sensor,
    build_robot,
)

NEAR, FAR = 0.2, 0.9


def one_reflex(actuate: Callable[[Command], object]) -> CommandGate:
    """A gate with the rule of the documentation, on the wall clock."""
    rule = parse_rule("range.front < 0.35 -> stop; release > 0.5")
    stop = {"left": 0.0, "right": 0.0}
    reflex = Reflex("keep clear", rule.names, rule.trigger, stop, rule.release)
    return CommandGate(actuate, WallClock(), [SensorLimits("range.front")], [reflex], safe_command=stop)


def event_driven(samples: int) -> np.ndarray:
    """Seconds from sample to command in one thread, with a reflex that fires at every second sample."""
    now, at = time.perf_counter, [0.0]

    def actuate(_: Command) -> None:
        at[0] = now()

    gate = one_reflex(actuate)
    near, far, took = {"range.front": NEAR}, {"range.front": FAR}, np.empty(samples)
    gc.collect()
    for number in range(samples):
        gate.sense(far)
        began = now()
        gate.sense(near)
        took[number] = at[0] - began
    return took


def pioneers_gate(samples: int) -> np.ndarray:
    """The same with all sensors and reflexes of the Pioneer."""
    now, at = time.perf_counter, [0.0]

    def actuate(_: Command) -> None:
        at[0] = now()

    clear = {"ring": 2.0, "range.front": 2.0, "range.left": 2.0, "range.right": 2.0, "range.rear": 2.0}
    near, took = {**clear, "range.front": NEAR}, np.empty(samples)
    clock = SimulationClock()
    gate = pioneer_reflexes().gate(actuate, clock)
    gate.sense({"goal.bearing": 0.0, "own.turn": 0.0})
    for number in range(samples):
        for _ in range(2):
            clock.advance_to(clock.now() + 0.1)
            gate.sense({**clear, "ring": 2.0 + 0.01 * (number % 2)})
        began = now()
        gate.sense(near)
        took[number] = at[0] - began
    return took


@contextmanager
def busy_core() -> Iterator[None]:
    """Another process that computes all the time."""
    process = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        yield
    finally:
        process.kill()
        process.wait()


def between_threads(samples: int, period: float = 0.001) -> np.ndarray:
    """Seconds from a sample in the sensor's thread to the command in that of the gate, which waits for samples."""
    now = time.perf_counter
    inbox: queue.SimpleQueue[tuple[float, float] | None] = queue.SimpleQueue()
    at, took = [0.0], list[float]()

    def actuate(_: Command) -> None:
        at[0] = now()

    gate = one_reflex(actuate)

    def control() -> None:
        while (sample := inbox.get()) is not None:
            value, sent = sample
            gate.sense({"range.front": value})
            if value == NEAR:
                took.append(at[0] - sent)

    thread = threading.Thread(target=control)
    thread.start()
    for number in range(2 * samples):
        time.sleep(period)
        inbox.put((NEAR if number % 2 else FAR, now()))
    inbox.put(None)
    thread.join()
    return np.array(took)


class _Range(Sensor[float]):
    value = FAR

    def get_data(self) -> float:
        return self.value


class _Motor(Actuator[float]):
    def __init__(self) -> None:
        super().__init__("motor")
        self.on_stop: Callable[[], None] = lambda: None

    def actuate(self, command: float) -> None:
        if command == 0.0:
            self.on_stop()


class _Stop(Action):
    def __init__(self, motor: _Motor) -> None:
        self._motor = motor

    def act(self) -> ActionStatus:
        self._motor.actuate(0.0)
        return ActionStatus.SUCCESS


class _KeepClear(ReactiveModel):
    def __init__(self, sensor: _Range, motor: _Motor) -> None:
        super().__init__("keep clear", [sensor], period=0.05, priority=15.0)
        self._sensor, self._motor = sensor, motor

    def run(self) -> Activity | None:
        return _Stop(self._motor) if self._sensor.value < 0.35 else None


def simulated(samples: int, *, published: bool) -> np.ndarray:
    """Simulated seconds from a change in the world to the command; no action is running that it would wait for."""
    rng, took = np.random.default_rng(0), []
    for _ in range(samples):
        clock, sensor, motor = SimulationClock(), _Range("front"), _Motor()
        robot = build_robot(
            "r", Knowledge(RobotModel([sensor], [motor]), reactive=(_KeepClear(sensor, motor),)), Execute(Pipeline())
        )
        runner = (
            PublishedLoop(robot, clock, phase=lambda: float(rng.uniform(0.0, 0.05)))
            if published
            else EventRunner(robot, clock)
        )
        runner.start()
        changed = 1.0 + float(rng.uniform(0.0, 0.05))
        clock.advance_to(changed)
        times: list[float] = []

        def note(times: list[float] = times, clock: SimulationClock = clock) -> None:
            times.append(clock.now())

        motor.on_stop = note
        sensor.value = NEAR
        clock.advance_to(2.0)
        took.append(times[0] - changed)
    return np.array(took)


def row(what: str, seconds: np.ndarray) -> str:
    """One line of the table, in microseconds."""
    p50, p99, most = np.percentile(seconds, 50), np.percentile(seconds, 99), seconds.max()
    return f"| {what} | {len(seconds)} | {1e6 * p50:.1f} | {1e6 * p99:.1f} | {1e6 * most:.0f} |"


def missions(directory: Path) -> Iterator[str]:
    """The tables of a campaign's results: each manager, and its times to the goal beside those of ``rocs``."""
    runs: dict[str, dict[int, Mapping[str, Any]]] = {}
    with Results(directory) as results:
        for run in results.runs(results.campaigns()[-1].campaign_id):
            if run.error is None:
                runs.setdefault(run.manager_name, {})[run.seed] = run.metrics
    yield (
        "| manager | runs | reached | time s, median (all runs) | driven / straight, median | runs with collisions "
        "| collisions | least clearance m, median and least | route switches, mean | oscillations, mean |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for manager, by_seed in runs.items():
        several = list(by_seed.values())
        reached = [one for one in several if one["reached_goal"]]
        ratio = f"{median(one['path_ratio'] for one in reached):.2f}" if reached else "-"
        clear = [one["least_clearance_m"] for one in several]
        cells = [
            str(len(several)),
            str(len(reached)),
            f"{median(one['time_s'] for one in several):.1f}",
            ratio,
            str(sum(one["collisions"] > 0 for one in several)),
            str(sum(one["collisions"] for one in several)),
            f"{median(clear):.3f}, {min(clear):.3f}",
            f"{mean(one['route_switches'] for one in several):.1f}",
            f"{mean(one['oscillations'] for one in several):.1f}",
        ]
        yield f"| {manager} | {' | '.join(cells)} |"
    yield ""
    yield "| time, beside rocs | seeds | faster | slower | median difference s | Vargha-Delaney A | p, Holm |"
    yield "|---|---|---|---|---|---|---|"
    others = [manager for manager in runs if manager != "rocs"]
    times = {manager: {seed: one["time_s"] for seed, one in by_seed.items()} for manager, by_seed in runs.items()}
    comparisons = [compare((name, [*times[name].values()]), ("rocs", [*times["rocs"].values()])) for name in others]
    for name, comparison in zip(others, corrected(comparisons), strict=True):
        pairs = [times[name][seed] - times["rocs"][seed] for seed in times[name].keys() & times["rocs"].keys()]
        faster, slower = sum(pair < 0.0 for pair in pairs), sum(pair > 0.0 for pair in pairs)
        figures = f"{median(pairs):.1f} | {comparison.superiority:.3f} | {comparison.p_corrected:.2g}"
        yield f"| {name} | {len(pairs)} | {faster} | {slower} | {figures} |"


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=1_000_000)
    parser.add_argument("--threads", type=int, default=10_000)
    parser.add_argument("--campaign", type=Path)
    options = parser.parse_args(arguments)
    print("| from sample to command | samples | p50 us | p99 us | max us |\n|---|---|---|---|---|")
    print(row("gate, one reflex, one thread", event_driven(options.samples)))
    print(row("gate of the Pioneer, one thread", pioneers_gate(options.samples // 10)))
    with busy_core():
        print(row("gate, between threads, a busy second core", between_threads(options.threads)))
    print(row("RoCS blocks on events, period 50 ms, simulated", simulated(2000, published=False)))
    print(row("RoCS as published, simulated, nothing running", simulated(2000, published=True)))
    if options.campaign is not None:
        print()
        print("\n".join(missions(options.campaign)))


if __name__ == "__main__":
    main()
