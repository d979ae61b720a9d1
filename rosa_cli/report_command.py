"""``rosa report``: what came of campaigns, runs and other people's results, in one HTML file and in data files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rosa_evaluation.effort import effort_rows, growths
from rosa_evaluation.report.exports import check_parquet, write_csv, write_parquet
from rosa_evaluation.report.figures import write_figures
from rosa_evaluation.report.page import growth_figure, page, section_of, write_page
from rosa_evaluation.report.sources import RunSources


@dataclass(frozen=True, slots=True)
class ReportRequest:
    """The options of the command."""

    paths: list[Path]
    out: Path | None
    csv: Path | None
    figures: Path | None
    parquet: Path | None


def write_report(request: ReportRequest) -> None:
    """Read, draw, write, and say what was written."""
    if request.parquet is not None:
        check_parquet()
    out = request.out or _default_path(request.paths[0])
    csv = request.csv or out.with_name(f"{out.stem}_csv")
    with RunSources() as sources:
        sources.add(request.paths)
        studies = sources.studies()
        sections = [section_of(study) for study in studies]
        measured = growths()
        # Everything is there before anything is written.
        html = page(sections, sources.origins, effort_rows(), measured)
        write_page(out, html)
        print(f"report in {out} ({len(html.encode()) / 1e6:.1f} MB)")
        if files := write_csv(csv, studies):
            print(f"{len(files)} CSV files in {csv}")
        if request.figures is not None:
            figures = [figure for section in sections for figure in section.figures]
            write_figures(request.figures, [*figures, growth_figure(measured)])
            print(f"{len(figures) + 1} figures in {request.figures}")
        if request.parquet is not None:
            print(f"{len(write_parquet(request.parquet, studies))} Parquet files in {request.parquet}")


def _default_path(first: Path) -> Path:
    return (first if first.is_dir() else Path()) / "report.html"
