"""docs/your_own_robot.md: the robot that it builds is built, and does what the page says."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.doc_commands import links, untrue_commands
from tests.rosa_cli.cli import refused, rosa

DOCS = Path(__file__).resolve().parent.parent / "docs"
TEXT = (DOCS / "your_own_robot.md").read_text(encoding="utf-8")
FILE = re.compile(r"`([\w/]+\.(?:yaml|py|xml|pddl))`[^`]*:\n\n```\w+\n(.*?)```", re.DOTALL)
SCAFFOLD, STEPS = TEXT.split("\n## 1. ", 1)


@pytest.fixture(scope="module")
def scaffold(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A directory in which ``rosa new greenhouse`` was called, which prints what the page says."""
    directory = tmp_path_factory.mktemp("robot")
    assert list(untrue_commands(SCAFFOLD, directory)) == []
    return directory / "greenhouse"


@pytest.fixture(scope="module")
def robot(scaffold: Path) -> Iterator[Path]:
    """The scaffold with the page's files instead of its own, installed as ``pip install -e .`` would."""
    for name, content in FILE.findall(TEXT):
        (scaffold / name).write_text(content, encoding="utf-8")
    install(scaffold)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(scaffold))
        yield scaffold


def install(root: Path) -> None:
    """Write down what pip would: the package's name and its entry points."""
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    name, version = project["name"], project["version"]
    installed = root / f"{name}-{version}.dist-info"
    installed.mkdir()
    (installed / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n", encoding="utf-8")
    lines = []
    for group, entries in project["entry-points"].items():
        lines += [f"[{group}]", *(f"{name} = {target}" for name, target in entries.items())]
    (installed / "entry_points.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


def test_the_page_has_the_parts_in_their_order() -> None:
    parts = re.findall(r"^## \d\. (\w+)", TEXT, re.MULTILINE)
    assert parts == ["Model", "Skills", "Mission", "Monitors", "Run", "Report"]


def test_the_commands_print_what_the_page_says(robot: Path) -> None:
    assert list(untrue_commands(STEPS, robot)) == []
    assert {"run.json", "events.jsonl", "trajectory.csv"} <= {path.name for path in (robot / "run").iterdir()}


def test_what_a_newcomer_gets_wrong_is_said(robot: Path, tmp_path: Path) -> None:
    assert "there are: rosa, timer, none" in refused(rosa("run", "greenhouse", "--manager", "careful"))
    config = tmp_path / "config.yaml"
    config.write_text("parameters: {pump_fail_at: 3}\n", encoding="utf-8")
    assert "did you mean 'pump_fails_at'?" in refused(rosa("run", "greenhouse", "--mission-config", config))


def test_a_run_in_which_nothing_was_watered_is_not_completed(robot: Path, tmp_path: Path) -> None:
    config = tmp_path / "config.yaml"
    config.write_text("parameters: {pump_fails_at: 0, time_limit: 1}\n", encoding="utf-8")
    assert rosa("run", "greenhouse", "--manager", "none", "-q", "--mission-config", config).returncode == 1
    assert rosa("run", "greenhouse", "--manager", "none", "-q").returncode == 0


def test_the_entry_point_on_the_page_is_the_scaffolds(robot: Path) -> None:
    (shown,) = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    written = tomllib.loads((robot / "pyproject.toml").read_text(encoding="utf-8"))
    assert tomllib.loads(shown)["project"]["entry-points"] == written["project"]["entry-points"]


@pytest.mark.parametrize("link", links(TEXT))
def test_every_file_that_the_page_names_is_there(link: str) -> None:
    assert (DOCS / link).exists()
