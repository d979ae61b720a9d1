"""``rosa new``: what it writes runs, passes its own test, and is as tidy as our own code."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.rosa_cli.cli import refused, rosa

ROOT = Path(__file__).resolve().parents[2]


def python(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", *arguments]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, env=environment, timeout=300, check=False)


# Names that the files' own names, YAML and PDDL have a meaning for.
@pytest.mark.parametrize("name", ["my_robot", "yes", "work", "mission"])
def test_the_package_passes_its_own_test(tmp_path: Path, name: str) -> None:
    process = rosa("new", name, "--out", tmp_path)
    assert process.returncode == 0, process.stderr
    project = tmp_path / name
    listed = [line.strip() for line in process.stdout.splitlines() if line.startswith("  ")]
    assert sorted(listed) == sorted(str(file.relative_to(project)) for file in project.rglob("*") if file.is_file())
    tested = python("pytest", "-q", "-p", "no:cacheprovider", cwd=project)
    assert tested.returncode == 0, tested.stdout + tested.stderr
    assert "6 passed" in tested.stdout


def test_its_model_and_mission_are_valid_and_its_code_is_tidy_and_typed(tmp_path: Path) -> None:
    rosa("new", "my_robot", "--out", tmp_path)
    project = tmp_path / "my_robot"
    model, mission = project / "my_robot" / "model.yaml", project / "my_robot" / "mission.xml"
    assert rosa("check", model).returncode == 0
    assert rosa("tree", mission).returncode == 0
    feasible = rosa(
        "plan", mission.with_name("domain.pddl"), mission.with_name("problem.pddl"), "--feasible", "recharge"
    )
    assert feasible.returncode == 0, feasible.stderr
    assert "recharge" in feasible.stdout
    for tool in (("ruff", "check"), ("ruff", "format", "--check"), ("mypy", "--strict", "my_robot")):
        checked = python(*tool, cwd=project)
        assert checked.returncode == 0, checked.stdout + checked.stderr


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("MyRobot", "such as 'my_robot'"),
        ("my-robot", "such as 'my_robot'"),
        ("2robots", "such as 'my_robot'"),
        ("class", "such as 'my_robot'"),
        ("../robot", "such as 'robot'"),
        ("", "such as 'my_robot'"),
        ("json", "there is a Python module 'json' already"),
        ("suave", "there is a Python module 'suave' already"),
        ("tests", "choose another name"),
        ("x" * 65, "such as 'my_robot'"),
    ],
)
def test_names_that_cannot_be_are_refused(tmp_path: Path, name: str, hint: str) -> None:
    assert hint in refused(rosa("new", name, "--out", tmp_path))
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    (tmp_path / "my_robot").mkdir()
    said = refused(rosa("new", "my_robot", "--out", tmp_path))
    assert "there is something of that name already" in said
    assert list((tmp_path / "my_robot").iterdir()) == []


def test_a_place_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    assert "cannot write it" in refused(rosa("new", "my_robot", "--out", tmp_path / "file"))
