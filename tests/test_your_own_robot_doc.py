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
FILE = re.compile(r"`([\w/]+\.(?:yaml|py|xml|toml))`[^`]*:\n\n```\w+\n(.*?)```", re.DOTALL)


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A directory with the page's files, installed as ``pip install -e .`` would."""
    root = tmp_path_factory.mktemp("robot")
    for name, content in FILE.findall(TEXT):
        (root / name).parent.mkdir(exist_ok=True)
        (root / name).write_text(content, encoding="utf-8")
    (root / "greenhouse" / "__init__.py").touch()
    install(root)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(root))
        yield root


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
    assert list(untrue_commands(TEXT, robot)) == []
    assert {"run.json", "events.jsonl", "trajectory.csv"} <= {path.name for path in (robot / "run").iterdir()}


def test_what_a_newcomer_gets_wrong_is_said(robot: Path, tmp_path: Path) -> None:
    assert "there are: rosa" in refused(rosa("run", "greenhouse", "--manager", "none"))
    config = tmp_path / "config.yaml"
    config.write_text("parameters: {pump_fail_at: 3}\n", encoding="utf-8")
    assert "did you mean 'pump_fails_at'?" in refused(rosa("run", "greenhouse", "--mission-config", config))


@pytest.mark.parametrize("link", links(TEXT))
def test_every_file_that_the_page_names_is_there(link: str) -> None:
    assert (DOCS / link).exists()
