"""The same seed gives the same record, byte for byte; another seed another one."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


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


def test_without_a_manager_it_is_just_as_repeatable(tmp_path: Path) -> None:
    assert record(tmp_path / "a", 3, "1", "none") == record(tmp_path / "b", 3, "2", "none")
