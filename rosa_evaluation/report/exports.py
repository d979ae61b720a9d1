"""The runs of a report as data: CSV as the exemplar writes it, and Parquet."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Problem, unwritable
from rosa_evaluation.exemplar_csv import (
    REACTION_SUFFIXES,
    ExemplarMission,
    ExemplarReaction,
    mission_of,
    reaction_file,
    reactions_of,
    write_missions,
    write_reactions,
)
from rosa_evaluation.report.figures import file_name
from rosa_evaluation.report.studies import Group, Study


def write_csv(directory: Path, studies: Sequence[Study]) -> list[Path]:
    """Write our runs as the exemplar does: a file of missions for each study, and its files of reactions.

    Runs of scenarios that are none of the exemplar's missions are left out.

    Args:
        directory: where; it is made if it is not there.
        studies: whose runs are written.

    Returns:
        the files that were written.

    Raises:
        InputError: if they cannot be.
    """
    written: list[Path] = []
    for study in studies:
        missions, reactions = _exemplar_rows(study)
        if not missions:
            continue
        _make(directory, "--csv")
        path = directory / f"{file_name(study.title)}.csv"
        write_missions(path, missions)
        written.append(path)
        for uncertainty in REACTION_SUFFIXES:
            reaction_path = reaction_file(path, uncertainty)
            write_reactions(reaction_path, reactions.get(uncertainty, []))
            written.append(reaction_path)
    return written


def _exemplar_rows(study: Study) -> tuple[list[ExemplarMission], dict[str, list[ExemplarReaction]]]:
    missions: list[ExemplarMission] = []
    reactions: dict[str, list[ExemplarReaction]] = {}
    for group in study.groups:
        for run in group.runs:
            if run.load is None:
                continue
            record, date = run.load(), run.date or _NO_DATE
            try:
                missions.append(mission_of(record, date))
            except KeyError:
                return [], {}
            for uncertainty, rows in reactions_of(record, date).items():
                reactions.setdefault(uncertainty, []).extend(rows)
    return missions, reactions


_NO_DATE = datetime(1970, 1, 1, tzinfo=UTC)
"""A run record does not say when it was made: the same run makes the same record."""


def check_parquet() -> None:
    """Make sure that Parquet can be written.

    Raises:
        InputError: if the extra is missing.
    """
    if find_spec("pyarrow") is None:
        hint = "pip install 'rosa-coadaptation[parquet]'"
        raise InputError(Problem("Parquet needs pyarrow, which is not installed", hint=hint))


def write_parquet(directory: Path, studies: Sequence[Study]) -> list[Path]:
    """Write ``runs.parquet`` (a row for each run, ours and others') and ``reactions.parquet`` (one for each reaction).

    Args:
        directory: where; it is made if it is not there.
        studies: whose runs are written; metrics in their units, times in s, truth values as 0 and 1.

    Returns:
        the files that were written.

    Raises:
        InputError: if they cannot be.
    """
    import pyarrow
    import pyarrow.parquet

    _make(directory, "--parquet")
    written = []
    for name, rows in (("runs", list(_run_rows(studies))), ("reactions", list(_reaction_rows(studies)))):
        columns = dict.fromkeys(column for row in rows for column in row)
        table = pyarrow.table({column: [row.get(column) for row in rows] for column in columns})
        path = directory / f"{name}.parquet"
        try:
            pyarrow.parquet.write_table(table, path)
        except OSError as error:
            raise unwritable(path, error, _other_directory("--parquet")) from None
        written.append(path)
    return written


def _run_rows(studies: Sequence[Study]) -> Iterator[dict[str, Any]]:
    for study in studies:
        for group in study.groups:
            for run in group.runs:
                yield {
                    **_names(study, group),
                    "run": run.name,
                    **{name: float(value) for name, value in run.metrics.items()},
                }


def _reaction_rows(studies: Sequence[Study]) -> Iterator[dict[str, Any]]:
    for study in studies:
        for group in study.groups:
            for run in group.runs:
                for uncertainty, several in run.reactions.items():
                    for reaction in several:
                        yield {
                            **_names(study, group),
                            "run": run.name,
                            "uncertainty": uncertainty,
                            "total_s": reaction.total_s,
                            "delay_s": reaction.delay_s,
                            "compute_s": reaction.compute_s,
                        }


def _names(study: Study, group: Group) -> dict[str, str]:
    return {"study": study.title, "group": group.label, "manager": group.manager}


def _make(directory: Path, option: str) -> None:
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(directory, error, _other_directory(option)) from None


def _other_directory(option: str) -> str:
    return f"name another directory with {option}"
