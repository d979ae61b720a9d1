"""The tables of a report: results beside published ones, parts of reaction times, and who differs from whom."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import fmean, stdev

from rosa_evaluation.report.reaction_parts import Parts
from rosa_evaluation.report.spec import PublishedRow
from rosa_evaluation.report.studies import Group, Study
from rosa_evaluation.report.svg import told_time
from rosa_evaluation.statistics import Comparison, compare_all, in_words, share_interval
from rosa_simulation.metric_names import label

NONE = "–"


@dataclass(frozen=True, slots=True)
class Row:
    """A line of the table of results; a published one stands below ours. ``note`` is the number of its conditions."""

    name: str
    runs: int
    cells: tuple[str, ...]
    published: bool = False
    note: int = 0
    failed: int = 0


@dataclass(frozen=True, slots=True)
class ResultsTable:
    """Means and standard deviations as in the ROSA paper's table 6, and under which conditions they were obtained."""

    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    conditions: tuple[str, ...]


def results_table(study: Study) -> ResultsTable:
    """Ours, and below each of ours what was published for the same managing system."""
    metrics, uncertainties = study.metrics, study.uncertainties
    ours = study.guide.conditions
    conditions: list[str] = [ours] if ours else []
    rows: list[Row] = []
    for group in study.groups:
        cells = [_cell(study, group, name) for name in metrics]
        cells += [_mean(group.mean_reactions(name)) for name in uncertainties]
        is_ours = any(run.load is not None for run in group.runs)
        rows.append(
            Row(group.label, len(group.runs), tuple(cells), note=int(bool(ours) and is_ours), failed=group.failed)
        )
        for published in study.published(group):
            told = f"{published.source}. {published.conditions}"
            if told not in conditions:
                conditions.append(told)
            shown = tuple(_published(published, name) for name in (*metrics, *uncertainties))
            rows.append(Row(published.source, published.runs, shown, published=True, note=conditions.index(told) + 1))
    heads = [" ".join(filter(None, label(name))) for name in metrics] + [f"{name} s" for name in uncertainties]
    return ResultsTable(tuple(heads), tuple(rows), tuple(conditions))


def is_truth(study: Study, metric: str) -> bool:
    """Whether a metric is a truth value: its mean is a share of the runs."""
    return all(value in (0.0, 1.0) for group in study.groups for value in group.metric(metric))


def _cell(study: Study, group: Group, metric: str) -> str:
    values = group.metric(metric)
    if values and is_truth(study, metric):
        interval = share_interval(round(sum(values)), len(values))
        return f"{fmean(values):.0%} ({interval.low * 100:.0f} to {interval.high * 100:.0f}%)"
    return _mean(values)


def _mean(values: Sequence[float]) -> str:
    return _figures(fmean(values), stdev(values) if len(values) > 1 else None) if values else NONE


def _published(row: PublishedRow, name: str) -> str:
    return _figures(*row.values[name], digits=2) if name in row.values else NONE


def _figures(mean: float, sd: float | None, digits: int | None = None) -> str:
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
        total, delay, compute = (NONE if mean is None else told_time(mean) for mean in part.means)
        rows.append(PartsRow(part.uncertainty, part.group, len(part.totals), total, delay, compute))
    return rows


@dataclass(frozen=True, slots=True)
class PairCell:
    """What a comparison says in a table: in how many pairs of runs the row is above the column, and what is shown."""

    superiority: str
    p: str
    magnitude: str
    words: str


@dataclass(frozen=True, slots=True)
class Tests:
    """All comparisons of one measure: a table by row and column, and sentences."""

    what: str
    groups: tuple[str, ...]
    cells: tuple[tuple[PairCell | None, ...], ...]
    sentences: tuple[str, ...]
    shown: int


def tests_of(study: Study) -> list[Tests]:
    """The comparisons of every metric that varies, and of the mean reaction times of runs."""
    measures: list[tuple[str, str, Callable[[Group], list[float]]]] = []
    for name in study.metrics:
        if not is_truth(study, name):
            what, unit = label(name)
            measures.append((what, unit, lambda group, name=name: group.metric(name)))  # type: ignore[misc]
    for name in study.uncertainties:
        measures.append((f"reaction time to {name}", "s", lambda group, name=name: group.mean_reactions(name)))  # type: ignore[misc]
    tests = [_tests(study, what, unit, values) for what, unit, values in measures]
    return [test for test in tests if test.sentences]


def _tests(study: Study, what: str, unit: str, values: Callable[[Group], list[float]]) -> Tests:
    comparisons = compare_all({group.label: values(group) for group in study.groups})
    by_pair = {(c.first, c.second): c for c in comparisons}
    groups = tuple(group.label for group in study.groups if values(group))
    words = {pair: in_words(c, what, unit, len(comparisons)) for pair, c in by_pair.items()}
    cells = tuple(tuple(_pair(by_pair, words, row, column) for column in groups) for row in groups)
    shown = sum(c.significant() for c in comparisons)
    return Tests(what, groups, cells, tuple(words.values()), shown)


def _pair(
    by_pair: dict[tuple[str, str], Comparison], words: dict[tuple[str, str], str], row: str, column: str
) -> PairCell | None:
    pair = (row, column) if (row, column) in by_pair else (column, row)
    if pair not in by_pair:
        return None
    comparison = by_pair[pair]
    superiority = comparison.superiority if pair == (row, column) else 1.0 - comparison.superiority
    p = "p < 0.001" if comparison.p_corrected < 0.001 else f"p = {comparison.p_corrected:.3f}"
    magnitude = str(comparison.magnitude) if comparison.significant() else "none"
    return PairCell(f"{superiority:.2f}", p, magnitude, words[pair])
