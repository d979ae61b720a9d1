"""``rosa compare``: two run records in one table."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import zip_longest
from pathlib import Path
from statistics import fmean
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from rosa_cli.output import plain_table, print_json
from rosa_simulation.metric import find_metric
from rosa_simulation.run_reader import read_run
from rosa_simulation.run_record import Reaction, RunRecord
from rosa_simulation.scenario import declared_metrics

_ABSENT = "–"


def compare_runs(first: Path, second: Path, *, as_json: bool) -> None:
    """Print how two runs were made, what came of them, and what happened in them."""
    runs = read_run(first), read_run(second)
    if as_json:
        print_json(_document(runs, (first, second)))
        return
    console = Console(highlight=False)
    columns = ("", str(first), str(second), "difference")
    table = plain_table(*columns, right=columns[1:])
    for name, one, other, difference in _rows(runs):
        differs = one != other
        table.add_row(Text(name), Text(one), Text(other), Text(difference), style="bold" if differs else "")
    console.print(table)
    console.print()
    console.print(_events(runs, (str(first), str(second))))


def _rows(runs: tuple[RunRecord, RunRecord]) -> Iterator[tuple[str, str, str, str]]:
    one, other = runs
    for name in ("scenario", "manager", "task_layer", "seed", "ended_by"):
        yield name.replace("_", " "), str(getattr(one, name)), str(getattr(other, name)), ""
    yield _row("duration s", one.duration_s, other.duration_s)
    declared = (*declared_metrics(one.scenario), *declared_metrics(other.scenario))
    for name in dict.fromkeys((*one.metrics, *other.metrics)):
        values = one.metrics.get(name), other.metrics.get(name)
        if not any(isinstance(value, Mapping) for value in values):
            yield _row(find_metric(name, declared, values[0]).heading, *values)
    for uncertainty in sorted({*one.reactions, *other.reactions}):
        several = one.reactions.get(uncertainty, ()), other.reactions.get(uncertainty, ())
        yield _row(f"{uncertainty} reactions", *map(len, several))
        for part, seconds in _PARTS.items():
            yield _row(f"{uncertainty} mean {part} ms", *(_mean_ms(reactions, seconds) for reactions in several))
    for name in _differing(one.inputs, other.inputs):
        yield name, _plain(_at(one.inputs, name)), _plain(_at(other.inputs, name)), ""
    for name in sorted({*one.versions, *other.versions}):
        versions = one.versions.get(name, _ABSENT), other.versions.get(name, _ABSENT)
        if versions[0] != versions[1]:
            yield f"version of {name}", *versions, ""


def _row(name: str, one: object, other: object) -> tuple[str, str, str, str]:
    numbers = [value for value in (one, other) if isinstance(value, int | float) and not isinstance(value, bool)]
    difference = f"{numbers[1] - numbers[0]:+.4g}" if len(numbers) == 2 and numbers[0] != numbers[1] else ""
    return name, _plain(one), _plain(other), difference


def _plain(value: object) -> str:
    if value is None:
        return _ABSENT
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


_PARTS: Mapping[str, Callable[[Reaction], float]] = {
    "delay": lambda reaction: reaction.delay_s,
    "compute": lambda reaction: reaction.compute_s,
    "total": lambda reaction: reaction.total_s,
}


def _mean_ms(reactions: Sequence[Reaction], seconds: Callable[[Reaction], float]) -> float | None:
    return 1e3 * fmean(map(seconds, reactions)) if reactions else None


def _differing(one: Mapping[str, Any], other: Mapping[str, Any], within: str = "") -> Iterator[str]:
    """The inputs that differ, as paths with dots."""
    for name in dict.fromkeys((*one, *other)):
        path = f"{within}.{name}" if within else name
        left, right = one.get(name), other.get(name)
        if isinstance(left, Mapping) and isinstance(right, Mapping):
            yield from _differing(left, right, path)
        elif left != right:
            yield path


def _at(inputs: Mapping[str, Any], path: str) -> Any:
    value: Any = inputs
    for name in path.split("."):
        value = value.get(name) if isinstance(value, Mapping) else None
    return value


def _events(runs: tuple[RunRecord, RunRecord], names: tuple[str, str]) -> Table:
    """What happened in both, in order of time; what happened in both at the same time stands in one line."""
    table = Table(box=None, pad_edge=False, header_style="bold")
    table.add_column("s", justify="right")
    for name in names:
        table.add_column(Text(name), overflow="fold")
    texts: dict[float, tuple[list[str], list[str]]] = {}
    for side, run in enumerate(runs):
        for event in run.events:
            texts.setdefault(event.time_s, ([], []))[side].append(event.text)
    for time in sorted(texts):
        for one, other in zip_longest(*texts[time], fillvalue=""):
            table.add_row(f"{time:.2f}", Text(one), Text("the same" if one == other else other))
    return table


def _document(runs: tuple[RunRecord, RunRecord], paths: tuple[Path, Path]) -> dict[str, Any]:
    one, other = runs
    numbers = {
        name: other.metrics[name] - value
        for name, value in one.metrics.items()
        if isinstance(value, int | float) and isinstance(other.metrics.get(name), int | float)
    }
    return {
        "runs": [{**run.document(), "out": str(path)} for run, path in zip(runs, paths, strict=True)],
        "differences": numbers,
        "inputs": {name: [_at(run.inputs, name) for run in runs] for name in _differing(one.inputs, other.inputs)},
        "events": [[{"time_s": event.time_s, "text": event.text} for event in run.events] for run in runs],
    }
