"""The tables of a report: our results and published ones, parts of reaction times, and who differs from whom."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev

from rosa_evaluation.report.reaction_parts import Parts
from rosa_evaluation.report.spec import PublishedRow
from rosa_evaluation.report.studies import Group, Study
from rosa_evaluation.report.style import format_duration
from rosa_evaluation.statistics import Comparison, compare_all, describe_comparison, share_interval
from rosa_simulation.metric import Better, Metric, MetricKind

NONE = "–"


@dataclass(frozen=True, slots=True)
class ResultsRow:
    """A line of the table of results; a published one stands below ours. ``note`` is the number of its conditions."""

    name: str
    runs: int
    cells: tuple[str, ...]
    published: bool = False
    note: int = 0
    failed: int = 0


@dataclass(frozen=True, slots=True)
class Column:
    """The head of a column; ``hint`` is shown while the pointer rests on it."""

    heading: str
    hint: str


@dataclass(frozen=True, slots=True)
class ResultsTable:
    """Means and standard deviations as in the ROSA paper's table 6, and under which conditions they were obtained."""

    columns: tuple[Column, ...]
    rows: tuple[ResultsRow, ...]
    conditions: tuple[str, ...]


def results_table(study: Study) -> ResultsTable:
    """Ours, and below each of ours what was published for the same managing system."""
    metrics, uncertainties = study.metrics, study.uncertainties
    names = [*(metric.name for metric in metrics), *uncertainties]
    ours = study.spec.conditions
    conditions: list[str] = [ours] if ours else []
    rows: list[ResultsRow] = []
    for group in study.groups:
        cells = [_cell(group, metric) for metric in metrics]
        cells += [_mean(group.mean_reactions(name)) for name in uncertainties]
        is_ours = any(run.load is not None for run in group.runs)
        rows.append(
            ResultsRow(
                group.label, len(group.runs), tuple(cells), note=int(bool(ours) and is_ours), failed=group.failed
            )
        )
        for published in study.published(group):
            condition = f"{published.source}. {published.conditions}"
            if condition not in conditions:
                conditions.append(condition)
            note = conditions.index(condition) + 1
            shown = tuple(_published(published, name) for name in names)
            rows.append(ResultsRow(published.source, published.runs, shown, published=True, note=note))
    columns = [Column(metric.heading, _column_hint(metric)) for metric in metrics]
    columns += [Column(f"{name} s", study.spec.uncertainties.get(name, "")) for name in uncertainties]
    return ResultsTable(tuple(columns), tuple(rows), tuple(conditions))


def _column_hint(metric: Metric) -> str:
    wanted = "" if metric.better is Better.NEITHER else f"; {metric.better} is better"
    return f"{metric.description}{wanted}"


def _cell(group: Group, metric: Metric) -> str:
    values = group.metric(metric.name)
    if values and metric.kind is MetricKind.TRUTH:
        interval = share_interval(round(sum(values)), len(values))
        return f"{fmean(values):.0%} ({interval.low * 100:.0f} to {interval.high * 100:.0f}%)"
    return _mean(values)


def _mean(values: Sequence[float]) -> str:
    return _mean_and_sd(fmean(values), stdev(values) if len(values) > 1 else None) if values else NONE


def _published(row: PublishedRow, name: str) -> str:
    return _mean_and_sd(*row.values[name], digits=2) if name in row.values else NONE


def _mean_and_sd(mean: float, sd: float | None, digits: int | None = None) -> str:
    if digits is None:
        digits = 2 if abs(mean) >= 0.095 or mean == 0.0 else 4
    return f"{mean:.{digits}f}" if sd is None else f"{mean:.{digits}f} ({sd:.{digits}f})"


@dataclass(frozen=True, slots=True)
class PartsRow:
    """The mean reaction time of a group to an uncertainty, in its parts."""

    uncertainty: str
    group: str
    reactions: int
    total: str
    delay: str
    compute: str


def parts_rows(parts: Sequence[Parts]) -> list[PartsRow]:
    """A row for each group and uncertainty."""
    rows = []
    for part in parts:
        total, delay, compute = (NONE if mean is None else format_duration(mean) for mean in part.means)
        rows.append(PartsRow(part.uncertainty, part.group, len(part.totals), total, delay, compute))
    return rows


@dataclass(frozen=True, slots=True)
class PairCell:
    """What a comparison says in a table: in how many pairs of runs the row is above the column, and what is shown."""

    superiority: str
    p: str
    magnitude: str
    sentence: str


@dataclass(frozen=True, slots=True)
class ComparisonTable:
    """All comparisons of one measure: a table by row and column, and sentences."""

    what: str
    groups: tuple[str, ...]
    cells: tuple[tuple[PairCell | None, ...], ...]
    sentences: tuple[str, ...]
    shown: int


def comparison_tables(study: Study) -> list[ComparisonTable]:
    """The comparisons of every metric that varies, and of the mean reaction times of runs."""
    tables: list[ComparisonTable] = []
    for metric in study.metrics:
        if metric.kind is not MetricKind.TRUTH:
            samples = {group.label: group.metric(metric.name) for group in study.groups}
            tables.append(_comparison_table(metric.title, metric.unit or "", samples))
    for name in study.uncertainties:
        times = {group.label: group.mean_reactions(name) for group in study.groups}
        tables.append(_comparison_table(f"reaction time to {name}", "s", times))
    return [table for table in tables if table.sentences]


def _comparison_table(what: str, unit: str, samples: Mapping[str, Sequence[float]]) -> ComparisonTable:
    comparisons = compare_all(samples)
    by_pair = {(c.first, c.second): c for c in comparisons}
    groups = tuple(label for label, values in samples.items() if values)
    sentences = {pair: describe_comparison(c, what, unit, len(comparisons)) for pair, c in by_pair.items()}
    cells = tuple(tuple(_pair(by_pair, sentences, row, column) for column in groups) for row in groups)
    shown = sum(c.significant() for c in comparisons)
    return ComparisonTable(what, groups, cells, tuple(sentences.values()), shown)


def _pair(
    by_pair: dict[tuple[str, str], Comparison], sentences: dict[tuple[str, str], str], row: str, column: str
) -> PairCell | None:
    pair = (row, column) if (row, column) in by_pair else (column, row)
    if pair not in by_pair:
        return None
    comparison = by_pair[pair]
    superiority = comparison.superiority if pair == (row, column) else 1.0 - comparison.superiority
    p = "p < 0.001" if comparison.p_corrected < 0.001 else f"p = {comparison.p_corrected:.3f}"
    magnitude = str(comparison.magnitude) if comparison.significant() else "none"
    return PairCell(f"{superiority:.2f}", p, magnitude, sentences[pair])
