"""Journals and results: SQLite files whose cells, rows, tables and bytes are not as they were written.

The checksums of journals are made right again: they protect from damage, not from somebody who computes them.
"""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import pytest

from rosa_cli import journal_commands
from rosa_core import KnowledgeBase, SimulationClock
from rosa_core.journal.codec import checksum
from rosa_core.journal.journal import compact_journal
from rosa_evaluation.campaign import Results, ResultsWriter, RunState
from rosa_evaluation.campaign.schema import FILE_NAME
from rosa_evaluation.report.page import page, section_of
from rosa_evaluation.report.sources import RunSources
from rosa_simulation.scenario import SilentObserver
from tests.fuzz.harness import fuzzed, result_or_refusal
from tests.fuzz.mutations import Change, change_database, changed_bytes
from tests.rosa_core.journal.writes import random_writes, robot
from tests.rosa_evaluation.campaign.scenarios import Walk, plan


def _right_checksums(db: sqlite3.Connection, table: str) -> None:
    columns = [column[1] for column in db.execute(f"PRAGMA table_info({table})")]
    if "checksum" not in columns:
        return
    key = columns[0]
    for row in db.execute(f"SELECT * FROM {table}").fetchall():
        db.execute(f"UPDATE {table} SET checksum = ? WHERE {key} IS ?", (checksum(*row[:-1]), row[0]))


def _fresh(path: Path, original: Path) -> None:
    for suffix in ("-wal", "-shm"):
        path.with_name(path.name + suffix).unlink(missing_ok=True)
    shutil.copyfile(original, path)


def _open(path: Path) -> object:
    with KnowledgeBase(robot(), SimulationClock(1e6), path) as kb:
        kb.add_measurement("battery", 0.5)
        kb.replan()
        return [kb.explain("action", "explore"), kb.history("measurements"), kb.selectable_actions()]


@pytest.fixture(scope="module")
def journal(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("journal") / "kb.journal"
    clock = SimulationClock()
    with KnowledgeBase(robot(), clock, path) as kb:
        for write in random_writes(3, 60):
            write(kb)
    return path


def _journal_uses(path: Path) -> list[Callable[[], object]]:
    return [
        lambda: journal_commands.show_journal(path, None),
        lambda: journal_commands.export_journal(path),
        lambda: _open(path),
        lambda: compact_journal(path),
    ]


def test_journals_with_other_cells(journal: Path, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = folder / "kb.journal"

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        _fresh(path, journal)
        change_database(path, changes[:3], _right_checksums)
        uses = _journal_uses(path)
        result_or_refusal(uses[changes[0].payload % len(uses)])
        capsys.readouterr()

    check()


def test_journals_with_other_bytes(journal: Path, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = folder / "bytes.journal"
    data = journal.read_bytes()

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        _fresh(path, journal)
        path.write_bytes(changed_bytes(data, [Change(c.what, c.where * 7, c.payload) for c in changes]))
        uses = _journal_uses(path)
        result_or_refusal(uses[changes[0].payload % len(uses)])
        capsys.readouterr()

    check()


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("results")
    walks = plan(Walk())
    with ResultsWriter(directory, SimulationClock(1e9)) as writer:
        writer.begin(walks)
        for run in walks.runs[:3]:
            writer.add(run, Walk().run(run.request, SilentObserver()))
        writer.add_failure(walks.runs[3], walks, "Traceback: it broke")
    return directory / FILE_NAME


def _everything(directory: Path) -> object:
    with Results(directory) as stored:
        for campaign in stored.campaigns():
            for run in stored.runs(campaign.campaign_id):
                if run.state is RunState.DONE:
                    stored.record(run.run_id)
    return True


def _report(directory: Path, *, whole: bool) -> object:
    with RunSources() as sources:
        sources.add([directory])
        studies = sources.studies()
        return page([section_of(study) for study in studies], sources.origins, [], []) if whole else studies


def _go_on(directory: Path) -> object:
    with ResultsWriter(directory, SimulationClock(2e9)) as writer:
        return writer.begin(plan(Walk()))


def test_results_with_other_cells(results: Path, folder: Path) -> None:
    path = folder / FILE_NAME

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        _fresh(path, results)
        change_database(path, changes[:3])
        # A page takes a tenth of a second: one input in eight gets it.
        report = partial(_report, whole=changes[0].payload % 8 == 0)
        for use in (_everything, report, _go_on):
            result_or_refusal(partial(use, folder))

    check()


def test_results_with_other_bytes(results: Path, folder: Path) -> None:
    path = folder / FILE_NAME
    data = results.read_bytes()

    @fuzzed
    def check(changes: Sequence[Change]) -> None:
        _fresh(path, results)
        path.write_bytes(changed_bytes(data, [Change(c.what, c.where * 7, c.payload) for c in changes]))
        for use in (_everything, _go_on):
            result_or_refusal(partial(use, folder))

    check()
