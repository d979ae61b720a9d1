"""``rosa run agv`` as a user runs it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.rosa_cli.cli import refused, rosa


def test_it_shows_the_route_with_the_configuration_for_each_corridor() -> None:
    process = rosa("run", "agv")
    assert process.returncode == 0
    for words in (
        "route to B: C1 (kinect + amcl, high speed)",
        "kinect failed: kinect + amcl unfeasible",
        "back out of C1 (lidar + amcl, high speed) -> C4 (lidar + amcl, safe speed) -> C3",
        "at B: goal reached B",
    ):
        assert words in process.stderr
    assert "ended by all goals reached" in process.stdout


def test_as_json_it_has_the_documented_keys() -> None:
    document = json.loads(rosa("run", "agv", "--json", "--quiet").stdout)
    assert (document["scenario"], document["completed"]) == ("agv", True)
    assert {"goals_reached", "energy", "time_s", "risk", "collisions", "routes", "adaptations"} <= set(
        document["metrics"]
    )
    assert len(document["reaction_times"]["component"]) == 1


@pytest.mark.parametrize("manager", ["rosa", "none"])
def test_the_same_seed_leaves_the_same_record(tmp_path: Path, manager: str) -> None:
    def record(name: str, hash_seed: str) -> dict[str, bytes]:
        command = [sys.executable, "-m", "rosa_cli.main", "run", "agv", "-q", "--seed", "4", "--manager", manager]
        environment = {"PYTHONHASHSEED": hash_seed, "PATH": ""}
        subprocess.run([*command, "--out", str(tmp_path / name)], check=True, capture_output=True, env=environment)
        return {f.name: f.read_bytes() for f in (tmp_path / name).iterdir() if f.name != "wall_clock.json"}

    first = record("a", "1")
    assert set(first) == {"run.json", "events.jsonl", "trajectory.csv"}
    assert record("b", "2") == first


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("start: A\n", "mission.yaml:1: the file has no 'map'"),
        ("map: paper.yaml\nstart: A\ngoals: [Bee]\n", "mission.yaml:3: there is no place 'Bee'"),
        ("map: &a [*a]\n", "mission.yaml"),
        ("map: !!python/object:os.system {}\nstart: A\ngoals: [B]\n", "mission.yaml:1"),
    ],
)
def test_a_mission_that_cannot_be_used_is_refused(tmp_path: Path, text: str, words: str) -> None:
    mission = tmp_path / "mission.yaml"
    mission.write_text(text, encoding="utf-8")
    assert words in refused(rosa("run", "agv", "--mission-config", mission))


def test_it_is_listed() -> None:
    assert "agv" in rosa("scenarios").stdout
