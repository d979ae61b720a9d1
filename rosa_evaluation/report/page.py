"""The page: everything that a report says, as one HTML file that needs nothing else."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from rosa_core.errors import unwritable
from rosa_evaluation.effort import EffortRow, Growth
from rosa_evaluation.report.figures import Figure, distribution_figures, reaction_figure, run_figures
from rosa_evaluation.report.growth_figure import draw_growth
from rosa_evaluation.report.reaction_parts import reaction_parts
from rosa_evaluation.report.sources import Origin
from rosa_evaluation.report.studies import Study
from rosa_evaluation.report.tables import (
    ComparisonTable,
    PartsRow,
    ResultsTable,
    comparison_tables,
    parts_rows,
    results_table,
)


@dataclass(frozen=True, slots=True)
class Section:
    """What is said about a study."""

    study: Study
    results: ResultsTable
    distributions: tuple[Figure, ...]
    parts: tuple[PartsRow, ...]
    parts_figure: Figure | None
    comparisons: tuple[ComparisonTable, ...]
    trajectories: tuple[Figure, ...]
    timelines: tuple[Figure, ...]

    @property
    def figures(self) -> list[Figure]:
        """All of them."""
        parts = [] if self.parts_figure is None else [self.parts_figure]
        return [*self.distributions, *parts, *self.trajectories, *self.timelines]


def section_of(study: Study) -> Section:
    """Everything about a study.

    Raises:
        InputError: if a run's record cannot be drawn.
    """
    trajectories, timelines = run_figures(study)
    return Section(
        study=study,
        results=results_table(study),
        distributions=tuple(distribution_figures(study)),
        parts=tuple(parts_rows(reaction_parts(study))),
        parts_figure=reaction_figure(study),
        comparisons=tuple(comparison_tables(study)),
        trajectories=tuple(trajectories),
        timelines=tuple(timelines),
    )


def growth_figure(growths: Sequence[Growth]) -> Figure:
    """How models grow with adaptations."""
    return Figure("growth", "elements to be modelled, by number of adaptations", draw_growth(growths))


def page(
    sections: Sequence[Section], origins: Sequence[Origin], effort: Sequence[EffortRow], growths: Sequence[Growth]
) -> str:
    """The HTML document. Whatever comes from runs and files is escaped; no script can run in it.

    Args:
        sections: one for each study.
        origins: where the runs come from.
        effort: rows of the table of development effort.
        growths: what is drawn of its growth.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    environment = Environment(
        loader=PackageLoader("rosa_evaluation.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    # Our own drawings and style; their texts are escaped where they are made.
    environment.filters["drawing"] = lambda figure: Markup(figure.svg)  # noqa: S704
    style = files("rosa_evaluation.report").joinpath("report.css").read_text(encoding="utf-8")
    return environment.get_template("report.html.j2").render(
        sections=sections,
        origins=origins,
        effort=effort,
        growths=growths,
        growth_figure=growth_figure(growths) if growths else None,
        style=Markup(style),  # noqa: S704
    )


def write_page(path: Path, html: str) -> None:
    """Write the document; whatever happens, there is the whole file or the one from before.

    Args:
        path: of the file.
        html: the document.

    Raises:
        InputError: if it cannot be written.
    """
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            temporary.write_text(html, encoding="utf-8")
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        raise unwritable(path, error, "name another file with --out") from None
