"""How fast missions fly, what the command costs, and how much memory: ``python benchmarks/bench_mission.py``."""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import time

from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario


def processes(*arguments: str, times: int = 5) -> float:
    """Median wall-clock seconds of a process from its start to its end."""
    taken = []
    for _ in range(times):
        began = time.perf_counter()
        subprocess.run([sys.executable, "-m", "rosa_cli.main", *arguments], check=True, capture_output=True)
        taken.append(time.perf_counter() - began)
    return statistics.median(taken)


def main() -> None:
    """Print the figures."""
    for name in ("suave", "suave-extended"):
        scenario = find_scenario(name)
        for manager in scenario.managers:
            scenario.run(RunRequest(manager=manager), SilentObserver())
            runs = [scenario.run(RunRequest(manager=manager, seed=seed), SilentObserver()) for seed in range(20)]
            speed = statistics.median(run.duration_s / run.wall_clock_s for run in runs)
            managing = statistics.median(run.managing_s for run in runs)
            compute = [r.compute_s for run in runs for several in run.reactions.values() for r in several]
            reacting = f", reaction compute median {statistics.median(compute) * 1e3:.2f} ms" if compute else ""
            print(f"{name}, {manager}: {speed:.0f} x real time, managing {managing * 1e3:.0f} ms a mission{reacting}")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"peak memory of this process: {peak:.0f} MB")
    print(f"rosa --help: {processes('--help'):.2f} s")
    print(f"rosa run suave-extended, cold start: {processes('run', 'suave-extended', '-q'):.2f} s")


if __name__ == "__main__":
    main()
