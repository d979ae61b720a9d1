"""docs/agv.md: the run goes as it says, and the map and missions in it can be used."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from agv_example.missions.mission_config import load_mission
from agv_example.scenario import AGV
from rosa_evaluation.campaign import Experiment
from rosa_simulation.scenario import RunRequest, SilentObserver
from tests.doc_commands import untrue_commands

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs" / "agv.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", TEXT, re.DOTALL)


def test_the_run_goes_as_the_page_shows() -> None:
    record = AGV.run(RunRequest(), SilentObserver())
    assert "".join(f"{event.time_s:8.2f} s  {event.text}\n" for event in record.events) == blocks("text")[0]


def test_the_map_and_the_mission_of_the_page_can_be_read(tmp_path: Path) -> None:
    corridors, mission, _ = blocks("yaml")
    (tmp_path / "map.yaml").write_text(corridors, encoding="utf-8")
    (tmp_path / "mission.yaml").write_text(mission, encoding="utf-8")
    assert load_mission(tmp_path / "mission.yaml").goals == ("B", "C")
    (tmp_path / "other.yaml").write_text("map: map.yaml\nstart: A\ngoals: [B]\n", encoding="utf-8")
    assert load_mission(tmp_path / "other.yaml").corridors.corridor("C2").length == 30.0


def test_the_experiment_of_the_page_can_be_run(tmp_path: Path) -> None:
    (tmp_path / "grids.yaml").write_text(blocks("yaml")[2], encoding="utf-8")
    experiment = Experiment.load(tmp_path / "grids.yaml")
    for seed in range(20):
        AGV.check(RunRequest(parameters=experiment.draw(seed)))


def test_the_command_prints_what_the_page_says() -> None:
    assert list(untrue_commands(TEXT, ROOT)) == []


@pytest.mark.parametrize("seed", range(3))
def test_the_warehouse_example_is_driven_to_its_end(seed: int) -> None:
    mission = ROOT / "examples" / "agv_warehouse.yaml"
    record = AGV.run(RunRequest(seed=seed, mission_config=mission), SilentObserver())
    assert record.completed
    assert record.metrics["goals_reached"] >= 1


def test_every_file_that_the_page_names_is_there() -> None:
    for link in re.findall(r"\]\(([^)#]+)\)", TEXT):
        assert (ROOT / "docs" / link).exists(), link
