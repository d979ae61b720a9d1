"""``rosa report``: what came of campaigns, runs and other people's results, in one HTML file and in data files."""

from __future__ import annotations

from pathlib import Path

from rosa_cli.options import ReportOptions
from rosa_evaluation.effort import effort_rows, growths
from rosa_evaluation.report.exports import check_parquet, write_csv, write_parquet
from rosa_evaluation.report.figures import write_figures
from rosa_evaluation.report.page import growth_figure, page, section_of, write_page
from rosa_evaluation.report.sources import RunSources


def write_report(options: ReportOptions) -> None:
    """Read, draw, write, and say what was written."""
    if options.parquet is not None:
        check_parquet()
    out = options.out or _default_path(options.paths[0])
    csv = options.csv or out.with_name(f"{out.stem}_csv")
    with RunSources() as sources:
        sources.add(options.paths)
        studies = sources.studies()
        sections = [section_of(study) for study in studies]
        measured = growths()
        # Everything is there before anything is written.
        html = page(sections, sources.origins, effort_rows(), measured)
        write_page(out, html)
        print(f"report in {out} ({len(html.encode()) / 1e6:.1f} MB)")
        if files := write_csv(csv, studies):
            print(f"{len(files)} CSV files in {csv}")
        if options.figures is not None:
            figures = [figure for section in sections for figure in section.figures]
            write_figures(options.figures, [*figures, growth_figure(measured)])
            print(f"{len(figures) + 1} figures in {options.figures}")
        if options.parquet is not None:
            print(f"{len(write_parquet(options.parquet, studies))} Parquet files in {options.parquet}")


def _default_path(first: Path) -> Path:
    return (first if first.is_dir() else Path()) / "report.html"
