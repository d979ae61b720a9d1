"""Commands about many runs: campaigns, reports, comparisons, speed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rosa_cli.option_groups import expand_options
from rosa_cli.options import CampaignOptions, Json, ReportOptions

app = typer.Typer()


@app.command()
@expand_options
def campaign(options: CampaignOptions) -> None:
    """Run a scenario many times under several managers, in parallel. The same command goes on after an interruption."""
    from rosa_cli.campaign_command import run_campaign

    raise typer.Exit(run_campaign(options))


@app.command()
@expand_options
def report(options: ReportOptions) -> None:
    """Report on results: one HTML file that needs nothing else, and CSV files."""
    from rosa_cli.report_command import write_report

    write_report(options)


@app.command()
def compare(
    first: Annotated[Path, typer.Argument(metavar="RUN", help="A directory of rosa run --out.")],
    second: Annotated[Path, typer.Argument(metavar="RUN", help="Another one.")],
    as_json: Json = False,
) -> None:
    """Show two runs next to each other: how they were made, what came of them, what happened."""
    from rosa_cli.compare_command import compare_runs

    compare_runs(first, second, as_json=as_json)


@app.command()
def bench(
    most: Annotated[int, typer.Option(min=100, max=1_000_000, help="The largest model, in elements.")] = 10_000,
    as_json: Json = False,
) -> None:
    """Measure how fast inference is, and compare it with peers that are installed."""
    from rosa_cli.bench_command import run_bench

    run_bench(most, as_json=as_json)
