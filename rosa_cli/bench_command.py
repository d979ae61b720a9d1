"""``rosa bench``: the project's own speed timings, as ratios where a peer is installed."""

from __future__ import annotations

import sys
from dataclasses import asdict
from itertools import chain

from rich.console import Console
from rich.live import Live

from rosa_cli.output import plain_table, print_json
from rosa_evaluation.bench.inference import Timing, clingo_is_installed, measure_inference
from rosa_evaluation.bench.writes import bytes_per_element, measure_writes


def run_bench(most: int, *, as_json: bool) -> None:
    """Measure at sizes of 100, 1000, ... up to ``most`` elements, and print a table or a document."""
    sizes = tuple(size for size in (100, 1_000, 10_000, 100_000, 1_000_000) if size <= most)
    with_clingo = clingo_is_installed()
    if not with_clingo:
        print("rosa: clingo is not installed (extra 'bench'), so there is no ratio to it", file=sys.stderr)
    timings = chain(measure_inference(sizes, with_clingo=with_clingo), measure_writes())
    if as_json:
        print_json([asdict(timing) for timing in timings])
        return
    columns = ("", "elements", "ours", "recompute", "ratio", "clingo", "ratio")
    table = plain_table(*columns, right=columns[1:])
    with Live(table, console=Console(highlight=False), auto_refresh=False) as live:
        for timing in timings:
            table.add_row(*_cells(timing))
            live.refresh()
    print(f"\na knowledge base takes {bytes_per_element(sizes[-1]):.0f} bytes an element at {sizes[-1]} elements")


def _cells(timing: Timing) -> tuple[str, ...]:
    cells = [timing.what, str(timing.elements), _time(timing.seconds)]
    for peer in (timing.recompute_s, timing.clingo_s):
        ratio = timing.ratio(peer)
        cells += ["" if peer is None else _time(peer), "" if ratio is None else f"{ratio:.0f} x"]
    return tuple(cells)


def _time(seconds: float) -> str:
    if seconds < 1e-3:
        return f"{seconds * 1e6:.1f} us"
    return f"{seconds * 1e3:.1f} ms" if seconds < 1 else f"{seconds:.2f} s"
