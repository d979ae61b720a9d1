"""``rosa run``: fly a mission and show it."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from rich.console import Console, Group, RenderableType
from rich.progress import BarColumn, Progress, TaskID, TextColumn
from rich.table import Table
from rich.text import Text

from rosa_cli.exit_codes import ExitCode
from rosa_cli.options import DisplayOptions
from rosa_cli.output import print_json
from rosa_cli.tree_view import TreeView
from rosa_cli.watching import DEFAULT_SPEED, TreeOutputs, Watching
from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.metric import Metric, find_metric
from rosa_simulation.run_record import MissionEvent, Reaction, RecordedPlan, RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario, scenario_names
from task_layer.bt import TreeRunner


def list_scenarios() -> None:
    """Print the installed scenarios with a line on each."""
    for name in scenario_names():
        scenario = find_scenario(name)
        print(f"{name:18}{scenario.description} (managers: {', '.join(scenario.managers)})")


def run_scenario(name: str, request: RunRequest, display: DisplayOptions) -> ExitCode:
    """Run it, write the record if that was asked for, and print the outcome."""
    scenario = find_scenario(name)
    if request.video is not None and not scenario.films:
        raise InputError(Problem(f"the scenario '{name}' cannot be filmed", hint="leave --video out"))
    if request.mission is not None and not scenario.takes_missions:
        raise InputError(Problem(f"the scenario '{name}' takes no mission files", hint="leave --mission out"))
    console = Console(stderr=True, highlight=False)
    watching = Watching(display.watch, display.groot, display.btlog)
    watching.check(request.task_layer, quiet=display.quiet, is_terminal=console.is_terminal)
    pace = _Pace(DEFAULT_SPEED if display.speed is None and watching.is_live else display.speed)
    with TreeOutputs(watching) as outputs:
        if display.quiet:
            record = scenario.run(request, _Warnings(pace, outputs))
        else:
            with LiveView(console, pace, outputs, show_tree=watching.terminal) as view:
                record = scenario.run(request, view)
    out = display.out
    if out is not None:
        record.write(out)
    if display.as_json:
        video = None if request.video is None else str(request.video)
        print_json({**record.document(), "out": None if out is None else str(out), "video": video})
    else:
        print_summary(record, scenario.metrics, Console(highlight=False), out, request.video)
    return ExitCode.DONE if record.completed else ExitCode.BROKE_OFF


class _Pace:
    """Lets a mission go on at a multiple of real time; without one, as fast as it goes."""

    def __init__(self, speed: float | None) -> None:
        self._speed = speed
        self.begin()

    def begin(self) -> None:
        """The mission begins now."""
        self._began = time.perf_counter()

    def keep(self, mission_time: float) -> None:
        """Wait until it is time for this second of the mission."""
        if self._speed is not None:
            ahead = mission_time / self._speed - (time.perf_counter() - self._began)
            if ahead > 0:
                time.sleep(ahead)


class _Warnings(SilentObserver):
    """Prints warnings, and nothing else."""

    def __init__(self, pace: _Pace, outputs: TreeOutputs) -> None:
        self._pace = pace
        self._outputs = outputs

    def started(self, time_limit: float) -> None:  # noqa: ARG002
        """Note when."""
        self._pace.begin()

    def progress(self, mission_time: float) -> None:
        """Keep to the speed."""
        self._pace.keep(mission_time)

    def warning(self, text: str) -> None:
        """Print it."""
        print(f"rosa: {text}", file=sys.stderr)

    def tree(self, runner: TreeRunner) -> None:
        """Serve it and log it."""
        self._outputs.attach(runner)


class _BarAndTree(Progress):
    """A progress bar, and below it the tree if there is one to show."""

    view: TreeView | None = None

    def get_renderables(self) -> Iterable[RenderableType]:
        """What rich shows, several times a second, from a thread of its own."""
        yield self.make_tasks_table(self.tasks)
        if self.view is not None:
            yield Group(*self.view.lines(self.console.height - 2))


class LiveView:
    """A progress bar in mission time, and above it a line for each thing that happens.

    Args:
        console: where to show it.
        pace: the speed at which it is shown.
        outputs: Groot2 and the log, which a behaviour tree is reported to.
        show_tree: whether to show a behaviour tree below the bar.
    """

    def __init__(self, console: Console, pace: _Pace, outputs: TreeOutputs, *, show_tree: bool) -> None:
        self._console = console
        self._pace = pace
        self._outputs = outputs
        self._show_tree = show_tree
        self._progress = _BarAndTree(
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
        if self._progress.view is not None:
            self._progress.view.close()
            self._console.print(Group(*self._progress.view.lines()))

    def started(self, time_limit: float) -> None:
        """Show the bar."""
        self._pace.begin()
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
        self._pace.keep(mission_time)

    def warning(self, text: str) -> None:
        """Add a line that stands out."""
        self._progress.console.print(Text(f"warning: {text}", style="yellow"), soft_wrap=True)

    def tree(self, runner: TreeRunner) -> None:
        """Show it after each tick, if that is wanted, and serve and log it."""
        self._outputs.attach(runner)
        if self._show_tree:
            view = TreeView(runner.tree.root, unicode=not self._console.options.ascii_only)
            self._progress.view = view
            runner.tree.add_post_tick_handler(lambda _: view.update())


def print_summary(
    record: RunRecord, declared: tuple[Metric, ...], console: Console, out: Path | None, video: Path | None = None
) -> None:
    """What the run achieved, and how fast it was adapted.

    Args:
        record: of the run.
        declared: the scenario's metrics.
        console: where to print it.
        out: where the record is, if it was written.
        video: where the film is, if there is one.
    """
    console.print(
        Text(f"{record.scenario}, manager {record.manager}, seed {record.seed}: ended by {record.ended_by}", "bold")
    )
    table = Table(box=None, show_header=False, pad_edge=False)
    for name, value in record.metrics.items():
        if not isinstance(value, Mapping):
            metric = find_metric(name, declared, value)
            table.add_row(f"  {metric.title}", Text(f"{_shown(value)} {_unit(metric)}".rstrip()))
    console.print(table)
    if any(record.reactions.values()):
        console.print(_reaction_table(record.reactions))
    if record.plans:
        console.print(Text("plans", "bold"))
        for plan in record.plans:
            console.print(Text(_plan_line(plan)), soft_wrap=True)
    for awaited in record.waiting_for:
        console.print(Text(f"was waiting for {awaited.action}: {awaited.reason}"), soft_wrap=True)
        for remedy in awaited.remedies:
            console.print(Text(f"  to make it feasible: {remedy}"), soft_wrap=True)
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


def _plan_line(plan: RecordedPlan) -> str:
    steps = ", ".join(step.strip("()").split()[0] for step in plan.steps) or f"none: {plan.no_plan}"
    return f"  {plan.time_s:8.2f} s  {plan.cost_s * 1e3:7.3f} ms  {steps} ({plan.reason})"


def _unit(metric: Metric) -> str:
    return "(unit unknown)" if metric.unit is None else metric.unit


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.2f}" if isinstance(value, float) else str(value)
