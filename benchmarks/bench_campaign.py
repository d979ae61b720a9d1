"""What a campaign costs beside the runs themselves: ``python benchmarks/bench_campaign.py [RUNS]``."""

from __future__ import annotations

import resource
import sys
import tempfile
import time
from pathlib import Path

from rosa_evaluation.campaign import (
    CampaignPlan,
    LocalWorkers,
    PlannedRun,
    ResultsWriter,
    RunState,
    execute_campaign,
    make_plan,
    read_managers,
)
from rosa_evaluation.campaign.local_workers import usable_cores
from rosa_simulation.scenario import SilentObserver, find_scenario

_SEED = 20_000


class _Silent:
    def started(self, runs: int, present: int) -> None:
        """Nothing."""

    def run_recorded(self, run: PlannedRun, state: RunState) -> None:
        """Nothing."""

    def worker_lost(self, run: PlannedRun, reason: str, *, again: bool) -> None:
        """Nothing."""


def cpu_time() -> float:
    """Seconds of processor time, of this process and of its children that have ended."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def alone(plan: CampaignPlan) -> None:
    """The runs in this process, one after the other, with nothing recorded."""
    began, cpu_began = time.perf_counter(), cpu_time()
    for run in plan.runs:
        plan.scenario.run(run.request, SilentObserver())
    report("one process, nothing recorded", len(plan.runs), time.perf_counter() - began, cpu_time() - cpu_began)


def campaign(plan: CampaignPlan, workers: int) -> None:
    """A campaign, from nothing to the closed database."""
    with tempfile.TemporaryDirectory() as directory:
        began, cpu_began = time.perf_counter(), cpu_time()
        with ResultsWriter(directory) as writer:
            execute_campaign(plan, writer, lambda runs: LocalWorkers(plan.scenario, min(runs, workers)), _Silent())
        report(f"campaign, {workers} workers", len(plan.runs), time.perf_counter() - began, cpu_time() - cpu_began)
        size = (Path(directory) / "runs.sqlite").stat().st_size / len(plan.runs)
        print(f"    {size / 1024:.0f} KB a run")


def report(what: str, runs: int, seconds: float, cpu: float) -> None:
    """Print how fast it was, and what it cost whatever else the machine had to do."""
    print(f"  {what}: {runs / seconds:.1f} runs/s, {cpu / runs * 1e3:.0f} ms of processor time a run")


def writing(plan: CampaignPlan, times: int = 200) -> float:
    """Seconds that recording one run takes the writer."""
    record = plan.scenario.run(plan.runs[0].request, SilentObserver())
    many = make_plan(plan.scenario, plan.managers[:1], range(times))
    with tempfile.TemporaryDirectory() as directory, ResultsWriter(directory) as writer:
        writer.begin(many)
        began = time.perf_counter()
        for run in many.runs:
            writer.add(run, record)
        return (time.perf_counter() - began) / times


def main() -> None:
    """Print the figures."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 30
    for name in ("suave", "suave-extended"):
        scenario = find_scenario(name)
        plan = make_plan(scenario, read_managers("none,rosa", scenario), range(_SEED, _SEED + runs))
        print(f"{name}, {len(plan.runs)} runs of none and rosa")
        alone(plan)
        for workers in sorted({1, usable_cores()}):
            campaign(plan, workers)
        print(f"  recording a run: {writing(plan) * 1e3:.1f} ms; planning a run: {planning(plan) * 1e3:.2f} ms")


def planning(plan: CampaignPlan) -> float:
    """Seconds that planning one run takes."""
    began = time.perf_counter()
    make_plan(plan.scenario, plan.managers, range(1000))
    return (time.perf_counter() - began) / (1000 * len(plan.managers))


if __name__ == "__main__":
    main()
