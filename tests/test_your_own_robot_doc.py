"""docs/your_own_robot.md: the robot that it builds is built, and does what the page says."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parent.parent / "docs"
TEXT = (DOCS / "your_own_robot.md").read_text(encoding="utf-8")
FILE = re.compile(r"`([\w/]+\.(?:yaml|py|xml|toml))`[^`]*:\n\n```\w+\n(.*?)```", re.DOTALL)
COMMANDS = re.compile(r"```sh\n(.*?)```\n(?:\n```text\n(.*?)```)?", re.DOTALL)


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A directory with the page's files, installed as ``pip install -e .`` would."""
    root = tmp_path_factory.mktemp("robot")
    for name, content in FILE.findall(TEXT):
        (root / name).parent.mkdir(exist_ok=True)
        (root / name).write_text(content, encoding="utf-8")
    (root / "greenhouse" / "__init__.py").touch()
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    installed = root / f"{project['name']}-{project['version']}.dist-info"
    installed.mkdir()
    metadata = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    (installed / "METADATA").write_text(metadata, encoding="utf-8")
    points = [
        f"[{group}]\n" + "".join(f"{name} = {target}\n" for name, target in entries.items())
        for group, entries in project["entry-points"].items()
    ]
    (installed / "entry_points.txt").write_text("\n".join(points), encoding="utf-8")
    return root


def rosa(line: str, root: Path) -> str:
    """What a command prints, the story on standard error first."""
    process = subprocess.run(
        [sys.executable, "-m", "rosa_cli.main", *shlex.split(line)[1:]],
        capture_output=True,
        text=True,
        cwd=root,
        env={**os.environ, "PYTHONPATH": str(root), "COLUMNS": "120"},
        timeout=120,
        check=False,
    )
    assert process.returncode in (0, 1), process
    return process.stderr + process.stdout


def differences(printed: str, shown: str) -> Iterator[str]:
    """The lines that the page shows and that were not printed in this order; ``...`` stands for any lines."""
    lines = iter([line.rstrip() for line in printed.splitlines()])
    exactly = True
    for wanted in shown.splitlines():
        if wanted == "...":
            exactly = False
            continue
        found = next(lines, None) if exactly else next((line for line in lines if line == wanted), None)
        if found != wanted:
            yield f"shown: {wanted}\nprinted: {found}"
            return
        exactly = True


def test_the_page_has_the_parts_in_their_order() -> None:
    parts = re.findall(r"^## \d\. (\w+)", TEXT, re.MULTILINE)
    assert parts == ["Model", "Skills", "Mission", "Monitors", "Run", "Report"]


def test_the_commands_print_what_the_page_says(robot: Path) -> None:
    for commands, shown in COMMANDS.findall(TEXT):
        lines = [line for line in commands.splitlines() if line.startswith("rosa ")]
        printed = "".join(rosa(line, robot) for line in lines)
        assert list(differences(printed, shown)) == [], printed


def test_the_record_is_there(robot: Path) -> None:
    rosa("rosa run greenhouse --quiet --out run", robot)
    assert {"run.json", "events.jsonl", "trajectory.csv"} <= {path.name for path in (robot / "run").iterdir()}


def test_what_a_newcomer_gets_wrong_is_said(robot: Path) -> None:
    wrong = rosa_refuses("rosa run greenhouse --manager none", robot)
    assert "there are: rosa" in wrong


def rosa_refuses(line: str, root: Path) -> str:
    process = subprocess.run(
        [sys.executable, "-m", "rosa_cli.main", *shlex.split(line)[1:]],
        capture_output=True,
        text=True,
        cwd=root,
        env={**os.environ, "PYTHONPATH": str(root)},
        timeout=120,
        check=False,
    )
    assert process.returncode == 2
    return process.stderr


@pytest.mark.parametrize("link", re.findall(r"\]\(([^)#]+)\)", TEXT))
def test_every_file_that_the_page_names_is_there(link: str) -> None:
    assert (DOCS / link).exists()
