"""The same seed gives the same record, byte for byte; another seed another one."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from rosa_simulation.scenario import RunRequest, SilentObserver
from suave.scenario import SUAVE


def record(
    directory: Path, seed: int, hash_seed: str, manager: str = "rosa", task_layer: str = "bt"
) -> dict[str, bytes]:
    """Fly in a process of its own; the files of the record but for the wall-clock figures."""
    command = [sys.executable, "-m", "rosa_cli.main", "run", "suave-extended", "-q", "--manager", manager]
    command += ["--task-layer", task_layer]
    subprocess.run(
        [*command, "--seed", str(seed), "--out", str(directory)],
        check=True,
        capture_output=True,
        env={"PYTHONHASHSEED": hash_seed, "PATH": ""},
    )
    return {file.name: file.read_bytes() for file in directory.iterdir() if file.name != "wall_clock.json"}


def test_two_runs_with_the_same_seed_leave_identical_records(tmp_path: Path) -> None:
    first = record(tmp_path / "a", 7, "1")
    assert set(first) == {"run.json", "events.jsonl", "trajectory.csv"}
    assert record(tmp_path / "b", 7, "2") == first


def test_another_seed_is_another_run(tmp_path: Path) -> None:
    first, second = record(tmp_path / "a", 7, "1"), record(tmp_path / "b", 8, "1")
    assert first["trajectory.csv"] != second["trajectory.csv"]


@pytest.mark.parametrize("manager", ["none", "bt"])
def test_under_another_manager_it_is_just_as_repeatable(tmp_path: Path, manager: str) -> None:
    assert record(tmp_path / "a", 3, "1", manager) == record(tmp_path / "b", 3, "2", manager)


@pytest.mark.parametrize("manager", ["random", "metacontrol"])
def test_what_is_left_to_chance_is_decided_by_the_seed(manager: str) -> None:
    first, again, other = (
        SUAVE.run(RunRequest(manager=manager, seed=seed, time_limit=80.0), SilentObserver()) for seed in (5, 5, 6)
    )
    assert first.events == again.events
    assert first.trajectory == again.trajectory
    assert first.events != other.events


def test_the_world_is_the_same_whoever_manages_the_robot() -> None:
    starts = {
        SUAVE.run(RunRequest(manager=manager, seed=5, time_limit=1.0), SilentObserver()).trajectory[0]
        for manager in SUAVE.managers
    }
    assert len(starts) == 1
