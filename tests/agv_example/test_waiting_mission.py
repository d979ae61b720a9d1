"""A mission without a way to go on: few ticks, and a record that says what it was waiting for."""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import pytest

from rosa_cli.run_command import print_summary
from rosa_simulation.run_reader import read_run
from rosa_simulation.run_record import AwaitedAction, RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver, find_scenario
from task_layer.bt import TreeRunner

DARK = [[5, "fails", component] for component in ("lidar", "kinect", "camera")]
DARK += [[5, "dims", f"C{number}", 0.0] for number in range(1, 5)]


class _Runner(SilentObserver):
    """Keeps the runner of the tree."""

    def tree(self, runner: TreeRunner) -> None:
        self.runner = runner


@pytest.fixture(scope="module")
def run() -> tuple[RunRecord, int]:
    observer = _Runner()
    record = find_scenario("agv").run(RunRequest(parameters={"events": DARK, "time_limit": 300}), observer)
    return record, observer.runner.tree.count


def test_it_is_ticked_once_a_period(run: tuple[RunRecord, int]) -> None:
    record, ticks = run
    assert (record.ended_by, record.duration_s) == ("time limit", 300.0)
    assert 600 <= ticks < 640


def test_the_record_names_what_it_was_waiting_for(run: tuple[RunRecord, int], tmp_path: Path) -> None:
    record, _ = run
    (awaited,) = record.waiting_for
    assert awaited.action == "navigate"
    assert awaited.reason.startswith("navigate is unfeasible: lidar: a failure was reported at 5.0 s")
    assert awaited.remedies == ("one of the components lidar, kinect, camera must recover",)
    record.write(tmp_path)
    assert read_run(tmp_path).waiting_for == record.waiting_for
    assert record.document()["waiting_for"][0]["action"] == "navigate"


def test_the_summary_says_so(run: tuple[RunRecord, int]) -> None:
    from rich.console import Console

    console = Console(record=True, width=200, file=StringIO())
    print_summary(run[0], find_scenario("agv").metrics, console, None)
    text = console.export_text()
    assert "was waiting for navigate: navigate is unfeasible: lidar: a failure was reported at 5.0 s" in text
    assert "  to make it feasible: one of the components lidar, kinect, camera must recover" in text


def test_a_mission_that_is_done_was_waiting_for_nothing(tmp_path: Path) -> None:
    record = find_scenario("agv").run(RunRequest(), SilentObserver())
    assert record.ended_by == "all goals reached"
    assert record.waiting_for == ()
    assert "waiting_for" not in record.document()
    assert AwaitedAction("a", "b", ()).document() == {"action": "a", "reason": "b", "remedies": []}
