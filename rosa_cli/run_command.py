"""``rosa run``: fly a mission and show it."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn
from rich.table import Table
from rich.text import Text

from rosa_cli.metric_names import label
from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_evaluation.run_record import MissionEvent, Reaction, RunRecord
from rosa_evaluation.scenario import RunRequest, SilentObserver, find_scenario, scenario_names


def list_scenarios() -> None:
    """Print the installed scenarios with a line on each."""
    for name in scenario_names():
        scenario = find_scenario(name)
        print(f"{name:18}{scenario.description} (managers: {', '.join(scenario.managers)})")


def run_scenario(
    name: str, request: RunRequest, *, out: Path | None, speed: float | None, quiet: bool, as_json: bool
) -> None:
    """Run it, write the record if that was asked for, and print the outcome."""
    scenario = find_scenario(name)
    # A scenario that cannot be filmed need not say so.
    if request.video is not None and not getattr(scenario, "films", False):
        raise InputError(Problem(f"the scenario '{name}' cannot be filmed", mend="leave --video out"))
    if quiet:
        record = scenario.run(request, _Warnings())
    else:
        with LiveView(Console(stderr=True, highlight=False), speed) as view:
            record = scenario.run(request, view)
    if out is not None:
        record.write(out)
    if as_json:
        video = None if request.video is None else str(request.video)
        document = {**record.document(), "out": None if out is None else str(out), "video": video}
        print(json.dumps(document, indent=2, ensure_ascii=False))
    else:
        print_summary(record, Console(highlight=False), out, request.video)


class _Warnings(SilentObserver):
    """Warnings are worth telling even when nothing else is."""

    def warning(self, text: str) -> None:
        """Print it."""
        print(f"rosa: {text}", file=sys.stderr)


class LiveView:
    """A progress bar in mission time, and above it a line for each thing that happens.

    Args:
        console: where to show it.
        speed: multiple of real time at which it is shown; as fast as it goes by default.
    """

    def __init__(self, console: Console, speed: float | None) -> None:
        self._console = console
        self._speed = speed
        self._began = time.perf_counter()
        self._progress = Progress(
            TextColumn("mission"),
            BarColumn(bar_width=40),
            TextColumn("{task.completed:5.0f} / {task.total:.0f} s"),
            console=console,
            transient=True,
            disable=not console.is_terminal,
        )
        self._task: TaskID | None = None

    def __enter__(self) -> LiveView:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self._progress.stop()

    def started(self, time_limit: float) -> None:
        """Show the bar."""
        self._began = time.perf_counter()
        self._task = self._progress.add_task("mission", total=time_limit)

    def event(self, event: MissionEvent) -> None:
        """Add a line."""
        when = Text(f"{event.time_s:8.2f} s", style="cyan")
        cause, colon, effects = event.text.partition(": ")
        what = Text.assemble((cause + colon, "bold"), effects)
        if self._console.is_terminal:
            line = Table.grid(padding=(0, 2))
            line.add_row(when, what)
            self._progress.console.print(line)
        else:
            self._progress.console.print(Text("  ").join((when, what)), soft_wrap=True)

    def progress(self, mission_time: float) -> None:
        """Move the bar, and keep to the speed."""
        if self._task is not None:
            self._progress.update(self._task, completed=mission_time)
        if self._speed is not None:
            ahead = mission_time / self._speed - (time.perf_counter() - self._began)
            if ahead > 0:
                time.sleep(ahead)

    def warning(self, text: str) -> None:
        """Add a line that stands out."""
        self._progress.console.print(Text(f"warning: {text}", style="yellow"), soft_wrap=True)


def print_summary(record: RunRecord, console: Console, out: Path | None, video: Path | None = None) -> None:
    """What the run achieved, and how fast it was adapted."""
    console.print(
        Text(f"{record.scenario}, manager {record.manager}, seed {record.seed}: ended by {record.ended_by}", "bold")
    )
    table = Table(box=None, show_header=False, pad_edge=False)
    for name, value in record.metrics.items():
        if not isinstance(value, Mapping):
            words, unit = label(name)
            table.add_row(f"  {words}", Text(f"{_shown(value)} {unit}".rstrip()))
    console.print(table)
    if any(record.reactions.values()):
        console.print(_reaction_table(record.reactions))
    real = record.duration_s / record.wall_clock_s
    console.print(
        f"{record.duration_s:.0f} s of mission in {record.wall_clock_s:.2f} s ({real:.0f} x real time), "
        f"of which {record.managing_s * 1e3:.0f} ms managing"
    )
    if out is not None:
        console.print(Text(f"run record in {out}"))
    if video is not None:
        console.print(Text(f"video in {video}"))


def _reaction_table(reactions: Mapping[str, tuple[Reaction, ...]]) -> Table:
    table = Table(title="adaptations", title_justify="left", title_style="bold", box=None, pad_edge=False)
    for column in ("  ", "at s", "delay ms", "compute ms", "total ms"):
        table.add_column(column, justify="right")
    for name, several in reactions.items():
        for reaction in several:
            parts = (reaction.delay_s, reaction.compute_s, reaction.total_s)
            table.add_row(name, f"{reaction.cause_s:.1f}", *(f"{part * 1e3:.3f}" for part in parts))
    return table


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.2f}" if isinstance(value, float) else str(value)
