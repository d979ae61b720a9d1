"""What is shown of a campaign: a bar with the time left while it runs, and what came of it."""

from __future__ import annotations

import statistics
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeRemainingColumn
from rich.text import Text

from rosa_cli.output import plain_table
from rosa_evaluation.campaign import CampaignOutcome, CampaignPlan, PlannedRun, RunState, StoredRun
from rosa_simulation.metric import Metric, find_metric

_LINE_EVERY = 10.0


class CampaignView:
    """A progress bar in runs; where there is no terminal, a line now and then. A context manager.

    Args:
        console: where to show it.
        quiet: show nothing but what went wrong.
    """

    def __init__(self, console: Console, *, quiet: bool) -> None:
        self._console = console
        self._quiet = quiet
        self._failed = self._recorded = self._present = self._runs = 0
        self._began = self._last_line = time.perf_counter()
        self._progress = Progress(
            TextColumn("campaign"),
            BarColumn(bar_width=40),
            MofNCompleteColumn(),
            TextColumn("{task.fields[failed]}", style="red"),
            TimeRemainingColumn(compact=True),
            TextColumn("left"),
            console=console,
            transient=True,
            disable=quiet or not console.is_terminal,
        )
        self._task: TaskID | None = None

    def __enter__(self) -> CampaignView:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._progress.stop()

    def started(self, runs: int, present: int) -> None:
        """Show the bar."""
        self._runs, self._present = runs, present
        self._began = self._last_line = time.perf_counter()
        self._task = self._progress.add_task("campaign", total=runs, completed=present, failed="")
        if present and not self._quiet:
            self._print(f"{present} of {runs} runs are there already")

    def run_recorded(self, run: PlannedRun, state: RunState) -> None:
        """Move the bar; a run that failed gets a line."""
        self._recorded += 1
        if state is RunState.FAILED:
            self._failed += 1
            self._print(f"failed: {_name(run)}", "red")
        if self._task is not None:
            self._progress.update(self._task, advance=1, failed=f"{self._failed} failed" if self._failed else "")
        self._print_progress()

    def worker_lost(self, run: PlannedRun, reason: str, *, again: bool) -> None:
        """A line that says so."""
        self._print(f"a worker is lost, {reason}: {_name(run)}{', which is done again' if again else ''}", "yellow")

    def stopping(self) -> None:
        """A line that says what Ctrl-C does."""
        self._print("stopping: runs that have begun are finished (Ctrl-C again breaks off)", "yellow")

    def _print_progress(self) -> None:
        now = time.perf_counter()
        if self._quiet or self._console.is_terminal or now - self._last_line < _LINE_EVERY:
            return
        self._last_line = now
        there = self._present + self._recorded
        left = (now - self._began) / self._recorded * (self._runs - there)
        self._print(f"{there} of {self._runs} runs, about {left:.0f} s left")

    def _print(self, text: str, style: str = "") -> None:
        self._progress.console.print(Text(text, style), soft_wrap=True)


def _name(run: PlannedRun) -> str:
    return f"{run.manager.name}, seed {run.request.seed}"


def campaign_document(
    plan: CampaignPlan, outcome: CampaignOutcome, runs: list[StoredRun], out: Path, seconds: float
) -> dict[str, Any]:
    """What came of a campaign, as JSON; the metrics of each manager with number, mean and standard deviation.

    Args:
        plan: of the campaign.
        outcome: how many runs are recorded.
        runs: those that are.
        out: where.
        seconds: how long it took, s of wall-clock time.
    """
    by_manager = {spec.name: [run for run in runs if run.manager_name == spec.name] for spec in plan.managers}
    return {
        "scenario": plan.scenario.name,
        "experiment": plan.experiment.name or None,
        "seeds": [plan.seeds.start, plan.seeds.stop - 1],
        "runs": len(plan.runs),
        "done": outcome.done,
        "failed": outcome.failed,
        "missing": outcome.missing,
        "carried_out": outcome.carried_out,
        "managers": {
            name: {
                "done": sum(run.state is RunState.DONE for run in several),
                "failed": sum(run.state is RunState.FAILED for run in several),
                "metrics": _metrics(run.metrics for run in several),
            }
            for name, several in by_manager.items()
        },
        "failures": [
            {"manager": run.manager_name, "seed": run.seed, "run_id": run.run_id, "error": run.error}
            for run in runs
            if run.state is RunState.FAILED
        ],
        "wall_clock_s": seconds,
        "out": str(out),
    }


def _metrics(several: Iterator[Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    values: dict[str, list[float]] = {}
    for metrics in several:
        for name, value in _numbers(metrics):
            values.setdefault(name, []).append(value)
    return {
        name: {
            "n": len(numbers),
            "mean": statistics.fmean(numbers),
            "sd": statistics.stdev(numbers) if len(numbers) > 1 else None,
        }
        for name, numbers in values.items()
    }


def _numbers(metrics: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """The metrics that have a mean: numbers, what is true of a share of the runs, and mappings of them."""
    for name, value in metrics.items():
        if isinstance(value, Mapping):
            yield from ((f"{part} {name}", number) for part, number in _numbers(value))
        elif isinstance(value, int | float):
            yield name, float(value)


def print_summary(document: Mapping[str, Any], declared: tuple[Metric, ...], console: Console) -> None:
    """A table of means and standard deviations, a column for each manager; then what failed, and where it all is.

    Args:
        document: what came of the campaign.
        declared: the scenario's metrics.
        console: where to print it.
    """
    managers = document["managers"]
    first, last = document["seeds"]
    under = f", {document['experiment']}" if document["experiment"] else ""
    console.print(Text(f"{document['scenario']}{under}: seeds {first} to {last}", "bold"))
    table = plain_table("  mean (standard deviation)", *managers, right=list(managers))
    table.add_row("  runs", *(str(manager["done"]) for manager in managers.values()))
    for metric in dict.fromkeys(metric for manager in managers.values() for metric in manager["metrics"]):
        cells = (_cell(manager["metrics"].get(metric)) for manager in managers.values())
        table.add_row(f"  {_heading(metric, declared)}", *cells)
    console.print(table)
    for failure in document["failures"]:
        reason = failure["error"].strip().splitlines()[-1]
        console.print(Text(f"failed: {failure['manager']}, seed {failure['seed']}: {reason}"), soft_wrap=True)
    if document["failures"]:
        console.print("the tracebacks are in the results; --retry-failed tries those runs again")
    rate = f" in {document['wall_clock_s']:.1f} s" if document["carried_out"] else ""
    console.print(Text(f"{document['carried_out']} runs carried out{rate}; results in {document['out']}"))


def _heading(name: str, declared: tuple[Metric, ...]) -> str:
    """The metric's heading, after the parts of it that it is a mean of."""
    *parts, metric = name.split(" ")
    return " ".join((*parts, find_metric(metric, declared).heading))


def _cell(metric: Mapping[str, Any] | None) -> str:
    if metric is None:
        return "–"
    digits = 2 if abs(metric["mean"]) >= 1 else 4
    spread = "" if metric["sd"] is None else f" ({metric['sd']:.{digits}f})"
    return f"{metric['mean']:.{digits}f}{spread}"
