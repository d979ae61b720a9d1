"""Managers from other packages: the one in docs/managers.md, installed and flown."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path

import pytest

from rosa_simulation.managers.registry import manager_group
from suave.scenario import SUAVE, SUAVE_EXTENDED
from tests.rosa_cli.cli import refused, rosa

PLAIN = manager_group("suave")
PAGE = (Path(__file__).resolve().parents[3] / "docs" / "managers.md").read_text(encoding="utf-8")


def block(language: str, containing: str) -> str:
    (found,) = (text for text in re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL) if containing in text)
    return found


def install(directory: Path, entry_points: dict[str, dict[str, str]], module: str = "") -> None:
    """What an installer leaves behind."""
    info = directory / "careful-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: careful\nVersion: 1.0\n", encoding="utf-8")
    lines = [
        line
        for group, names in entry_points.items()
        for line in (f"[{group}]", *(f"{name} = {value}" for name, value in names.items()))
    ]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (directory / "careful.py").write_text(module, encoding="utf-8")


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A directory whose packages are installed, for processes that are started."""
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    return tmp_path


def test_the_manager_in_the_docs_flies(site: Path) -> None:
    entry_points = tomllib.loads(block("toml", "entry-points"))["project"]["entry-points"]
    install(site, entry_points, block("python", "def careful"))
    assert "none, careful)" in rosa("scenarios").stdout
    process = rosa("run", "suave", "--manager", "careful", "--json", "--out", site / "run")
    assert process.returncode == 0, process.stderr
    document = json.loads(process.stdout)
    assert document["manager"] == "careful"
    assert document["metrics"]["pipeline_found"]
    (reaction,) = document["reaction_times"]["U1"]
    assert 0.0 < reaction["delay_s"] <= 1.01
    assert "altitude 2.0 -> 1.0" in process.stderr


def test_it_is_not_there_for_a_mission_that_it_does_not_name(site: Path) -> None:
    install(site, {PLAIN: {"careful": "careful:careful"}}, block("python", "def careful"))
    assert "there is no manager 'careful'" in refused(rosa("run", "suave-extended", "--manager", "careful"))


@pytest.mark.parametrize("value", ["nowhere:careful", "careful:nothing", "careful:broken.thing"])
def test_one_that_cannot_be_loaded_is_named_with_its_entry_point(site: Path, value: str) -> None:
    install(site, {PLAIN: {"careful": value}})
    said = refused(rosa("run", "suave", "-q", "--manager", "careful"))
    assert f"correct the entry point 'careful = {value}' of the group {PLAIN}" in said


def test_our_own_names_cannot_be_taken(site: Path) -> None:
    install(site, {PLAIN: {"none": "careful:careful"}}, "raise SystemExit('taken')\n")
    assert rosa("run", "suave", "-q", "--manager", "none", "--time-limit", "5").returncode == 0


def test_all_managers_are_there_for_the_plain_mission_and_those_that_can_recharge_for_the_extended_one() -> None:
    assert set(SUAVE.managers) >= {"none", "random", "bt", "metacontrol", "rosa"}
    assert set(SUAVE_EXTENDED.managers) >= {"bt", "rosa", "none"}
    assert not {"random", "metacontrol"} & set(SUAVE_EXTENDED.managers)
