"""The table of docs/managers.md: every manager on the same missions: ``python benchmarks/compare_managers.py [RUNS]``.

Search time and distance as mean (standard deviation), reaction times as mean delay + mean time of computing.
"""

from __future__ import annotations

import sys
from statistics import fmean, stdev

from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario

FIRST_SEED = 6000
"""Nothing was fitted to the seeds from here on."""


def spread(values: list[float]) -> str:
    """Mean and standard deviation."""
    return f"{fmean(values):.1f} ({stdev(values):.1f})"


def reactions(runs: list[RunRecord], name: str) -> str:
    """How long reactions to one uncertainty took, ms."""
    several = [reaction for run in runs for reaction in run.reactions[name]]
    if not several:
        return ""
    delay, compute = fmean(r.delay_s for r in several), fmean(r.compute_s for r in several)
    return f"  {name} {delay * 1e3:.1f} + {compute * 1e3:.2f} ms (n={len(several)})"


def main() -> None:
    """Print a line for each scenario and manager."""
    seeds = range(FIRST_SEED, FIRST_SEED + (int(sys.argv[1]) if len(sys.argv) > 1 else 40))
    for name in ("suave", "suave-extended"):
        scenario = find_scenario(name)
        for manager in scenario.managers:
            runs = [scenario.run(RunRequest(manager=manager, seed=seed), SilentObserver()) for seed in seeds]
            search, last, total = (
                spread([run.metrics[metric] for run in runs])
                for metric in ("search_time_s", "distance_inspected_m", "distance_inspected_total_m")
            )
            reacting = "".join(reactions(runs, uncertainty) for uncertainty in ("U1", "U2", "U3"))
            print(
                f"{name}, {manager}: search {search} s, distance {last} m, all stints {total} m{reacting}",
                flush=True,
            )


if __name__ == "__main__":
    main()
