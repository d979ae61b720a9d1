"""The figures of a study, each with a name for a file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import TypeVar

from rosa_core import InputError
from rosa_core.errors import Problem, unwritable
from rosa_evaluation.report.distributions import PublishedPoint, draw_distributions
from rosa_evaluation.report.reaction_parts import draw_reaction_parts, reaction_parts
from rosa_evaluation.report.spec import Mark
from rosa_evaluation.report.studies import Group, ReportedRun, Study
from rosa_evaluation.report.style import colour
from rosa_evaluation.report.timeline import draw_timeline
from rosa_evaluation.report.trajectories import TrajectoryPlot, draw_trajectories, mark_colours, trajectory_of
from rosa_simulation.metric import Metric, MetricKind
from rosa_simulation.run_record import MissionEvent, RunRecord

_Drawn = TypeVar("_Drawn")

_MOST_TRAJECTORIES = 25
"""Drawn into one figure: more would hide each other, and make the file large."""


@dataclass(frozen=True, slots=True)
class Figure:
    """A figure: SVG that stands on its own, a caption, and the name of a file for it."""

    name: str
    caption: str
    svg: str
    events: tuple[MissionEvent, ...] = ()


def distribution_figures(study: Study) -> Iterator[Figure]:
    """The metrics that are measured, and the reaction times."""
    for metric in study.metrics:
        if metric.kind is not MetricKind.TRUTH:
            values = {group.label: group.metric(metric.name) for group in study.groups}
            yield _distribution(study, metric.name, _axis_title(metric), values, logarithmic=False)
    for name in study.uncertainties:
        meaning = study.spec.uncertainties.get(name)
        title = f"reaction time to {name}" + (f" ({meaning})" if meaning else "")
        totals = {group.label: _totals(group, name) for group in study.groups if group.reactions(name)}
        yield _distribution(study, name, title, totals, logarithmic=True)


def _axis_title(metric: Metric) -> str:
    return f"{metric.title}, {metric.unit}" if metric.unit else metric.heading


def _totals(group: Group, uncertainty: str) -> list[float]:
    return [reaction.total_s for reaction in group.reactions(uncertainty)]


def _distribution(
    study: Study, name: str, title: str, samples: Mapping[str, Sequence[float]], *, logarithmic: bool
) -> Figure:
    published = {
        group.label: [
            PublishedPoint(*row.values[name], row.source) for row in study.published(group) if name in row.values
        ]
        for group in study.groups
    }
    svg = draw_distributions(title, samples, published, _colours(study), logarithmic=logarithmic)
    return Figure(f"{study.title} {name}", title, svg)


def _colours(study: Study) -> dict[str, str]:
    """The colour of each group, the same in all figures."""
    return {group.label: colour(number) for number, group in enumerate(study.groups)}


def reaction_figure(study: Study) -> Figure | None:
    """Reaction times in their parts; None if there are none with parts."""
    parts = [part for part in reaction_parts(study) if part.delays]
    if not parts:
        return None
    return Figure(f"{study.title} reaction parts", "reaction times in their parts", draw_reaction_parts(parts))


def run_figures(study: Study) -> tuple[list[Figure], list[Figure]]:
    """For each managing system with runs of ours: its trajectories, and the timeline of one run.

    The run is one of the same seed for all, if there is such a seed, so that they can be compared.
    """
    groups = [group for group in study.groups if any(run.load for run in group.runs)]
    shown = {group.label: _shown(group, _common_seed(groups)) for group in groups}
    records = {group.label: _load(shown[group.label]) for group in groups}
    return list(_trajectories(study, groups, shown, records)), list(_timelines(study, records))


def _timelines(study: Study, records: dict[str, RunRecord]) -> Iterator[Figure]:
    for name, record in records.items():
        marks = _marks(study, record)
        svg = _drawn(record, partial(draw_timeline, marks=marks))
        caption = f"{name}, seed {record.seed}: ended by {record.ended_by}"
        yield Figure(f"{study.title} timeline {name}", caption, svg, record.events)


def _trajectories(
    study: Study, groups: Sequence[Group], shown: dict[str, ReportedRun], records: dict[str, RunRecord]
) -> Iterator[Figure]:
    spec = study.spec
    if spec.draw is not None:
        for name, record in records.items():
            caption = f"{name}, seed {record.seed}"
            yield Figure(f"{study.title} from above {name}", caption, _drawn(record, spec.draw))
        return
    several = {group.label: [records[group.label], *_others(group, shown[group.label])] for group in groups}
    marks = {label: [_marks(study, run) for run in runs] for label, runs in several.items()}
    kinds = mark_colours([mark for of_group in marks.values() for mark in of_group])
    colours = _colours(study)
    for name, runs in several.items():
        trajectories = [trajectory for trajectory in map(trajectory_of, runs) if trajectory is not None]
        if len(trajectories) == len(runs):
            plot = TrajectoryPlot(list(_drawn(runs[0], spec.landmarks)), trajectories, marks[name])
            svg = draw_trajectories(f"trajectories under {name}, from above", plot, colours[name], kinds)
            caption = f"{name}: {len(trajectories)} runs; what happened on the way is that of seed {runs[0].seed}"
            yield Figure(f"{study.title} from above {name}", caption, svg)


def _others(group: Group, first: ReportedRun) -> Iterator[RunRecord]:
    ours = (run for run in group.runs if run is not first and run.load is not None)
    return map(_load, islice(ours, _MOST_TRAJECTORIES - 1))


def _marks(study: Study, record: RunRecord) -> list[Mark]:
    return list(_drawn(record, study.spec.marks))


def _common_seed(groups: Sequence[Group]) -> str | None:
    seeds = [[run.name for run in group.runs if run.load] for group in groups]
    return next((seed for seed in seeds[0] if all(seed in others for others in seeds)), None) if seeds else None


def _shown(group: Group, seed: str | None) -> ReportedRun:
    ours = [run for run in group.runs if run.load]
    return next((run for run in ours if run.name == seed), ours[0])


def _load(run: ReportedRun) -> RunRecord:
    if run.load is None:
        raise ValueError(f"there is no record of run {run.name}, only its metrics")
    return run.load()


def _drawn(record: RunRecord, draw: Callable[[RunRecord], _Drawn]) -> _Drawn:
    """What is drawn of a run; records come from outside, and may not have what a drawing needs."""
    try:
        return draw(record)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        what = f"the run of {record.scenario} under {record.manager}, seed {record.seed}, cannot be drawn"
        hint = f"its record is not as it was written: {type(error).__name__}: {error}"
        raise InputError(Problem(what, None, hint)) from error


def write_figures(directory: Path, figures: Sequence[Figure]) -> None:
    """Write each figure into a file of its own.

    Args:
        directory: where; it is made if it is not there.
        figures: each becomes an SVG file of its name.

    Raises:
        InputError: if the directory cannot be written.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        for figure in figures:
            (directory / f"{file_name(figure.name)}.svg").write_text(figure.svg, encoding="utf-8")
    except OSError as error:
        raise unwritable(directory, error, "name another directory with --figures") from None


def file_name(name: str) -> str:
    """A name for a file, without what some file system does not like."""
    signs = "".join(sign if (sign.isascii() and sign.isalnum()) or sign in "-_" else "_" for sign in name)
    return "_".join(filter(None, signs.split("_")))[:120] or "figure"
