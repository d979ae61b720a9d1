"""Mission files: what can be said, and what is wrong named with its line."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from agv_example.missions.mission_config import DrawnDisturbance, default_mission, load_mission
from agv_example.planning import Objective
from agv_example.planning.costs import StartUp
from rosa_core import InputError
from tests.agv_example.brass_map import write_brass_map
from tests.agv_example.drives import drive, routes


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "mission.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_default_mission_is_the_papers_example() -> None:
    config = load_mission(default_mission())
    assert (config.start, config.goals) == ("A", ("B",))
    (disturbance,) = config.draw(np.random.default_rng(0))
    assert (disturbance.kind, disturbance.subject) == ("fails", "kinect")


def test_everything_that_can_be_said(tmp_path: Path) -> None:
    config = load_mission(
        written(
            tmp_path,
            """
map: {places: {A: [0, 0], B: [8, 0]}, corridors: {x: {between: [A, B], light: 0.4}}}
start: B
goals: [A, B]
minimise: [time, risk]
battery: 77
start_up: {time: 0.2, energy: 0}
time_limit: 50
models: [agv_published_draws.yaml]
events:
  - {at: 30, closes: x}
  - {at: 12, works: lamp}
  - {at: 12.5, dims: x, light: 0.1}
  - {at: 40, opens: x}
""",
        )
    )
    assert config.corridors.corridor("x").length == 8.0
    assert (config.start, config.goals, config.battery, config.time_limit) == ("B", ("A", "B"), 77.0, 50.0)
    assert config.objective == Objective.in_order(["time", "risk"])
    assert config.start_up == StartUp(0.2, 0.0)
    assert [path.name for path in config.models] == ["agv_published_draws.yaml"]
    assert config.lights == {0.4, 0.1, 1.0}
    assert config.draw(np.random.default_rng(0)) == (
        DrawnDisturbance(12.0, "works", "lamp"),
        DrawnDisturbance(12.5, "dims", "x", 0.1),
        DrawnDisturbance(30.0, "closes", "x"),
        DrawnDisturbance(40.0, "opens", "x"),
    )


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("", 1, "not a mission"),
        ("[1]\n", 1, "not a mission"),
        ("map: paper.yaml\nstart: A\ngoal: B\ngoals: [B]\n", 3, "did you mean 'goals'?"),
        ("map: papr.yaml\nstart: A\ngoals: [B]\n", 1, "there is no file 'papr.yaml'"),
        ("map: {places: {A: [0]}}\nstart: A\ngoals: [B]\n", 1, "x and y in m"),
        ("map: paper.yaml\nstart: Z\ngoals: [B]\n", 2, "there is no place 'Z'"),
        ("map: paper.yaml\nstart: A\n", 1, "there is nowhere to go"),
        ("map: paper.yaml\nstart: A\ngoals: []\n", 3, "there is nowhere to go"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nminimise: enrgy\n", 4, "did you mean 'energy'?"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nminimise: {energy: -1}\n", 4, "a number from 0 "),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nbattery: 0\n", 4, "a number from 0.001 "),
        (
            "map: paper.yaml\nstart: A\ngoals: [B]\nevents:\n  - {at: 3, fails: sonar}\n",
            5,
            "no component that can fail",
        ),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nevents:\n  - {at: 3, closes: C9}\n", 5, "there is no corridor 'C9'"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nevents:\n  - {at: 3}\n", 5, "what happens?"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nevents:\n  - {fails: lidar}\n", 5, "events / 0 has no 'at'"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nevents:\n  - {at: [9, 3], fails: lidar}\n", 5, "swap them"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nevents:\n  - {at: [9], fails: lidar}\n", 5, "two to draw it from"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nevents:\n  - {at: 9, fails: []}\n", 5, "at least 1 expected"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nevents:\n  - {at: 9, dims: C1}\n", 5, "'light' belongs to 'dims'"),
        ("map: paper.yaml\nstart: A\ngoals: [B]\nmodels: [nothing.yaml]\n", 4, "there is no file 'nothing.yaml'"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    with pytest.raises(InputError) as error:
        load_mission(written(tmp_path, text))
    assert f"mission.yaml:{line}:" in str(error.value)
    assert words in str(error.value)


def test_a_brass_map_is_driven_with_its_own_times_and_the_published_draws(tmp_path: Path) -> None:
    write_brass_map(tmp_path / "cp3.json")
    record = drive(
        tmp_path,
        map="cp3.json",
        start="l1",
        goals=["l20"],
        minimise="energy",
        models=["agv_published_draws.yaml"],
        battery=1e8,
        time_limit=2000,
    )
    assert record.ended_by == "all goals reached"
    (route,) = routes(record)
    assert record.metrics["time_s"] == pytest.approx(sum(leg["time_s"] for leg in route["legs"]), abs=1.5)
    assert record.metrics["energy"] == pytest.approx(sum(leg["energy"] for leg in route["legs"]), rel=0.02)
    assert route["legs"][0]["energy"] > 10_000, "the published draws count, not the sums of the components"
    json.dumps(record.inputs)


WORDS = """map start goals minimise events at fails dims light places corridors grid columns rows between length A B
node-id coords connected-to time hitrate from to amcl-kinect mean"""
KEYS = st.sampled_from(WORDS.split())
SCALARS = st.none() | st.booleans() | st.integers(-3, 12) | st.floats(allow_nan=False) | KEYS | st.text(max_size=3)
VALUES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=4), max_leaves=12
)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.dictionaries(KEYS, VALUES, max_size=5)
    | st.fixed_dictionaries({"map": VALUES, "start": VALUES, "goals": VALUES, "events": VALUES, "minimise": VALUES})
    | st.fixed_dictionaries({"map": st.just("paper.yaml"), "start": st.just("A"), "goals": VALUES, "events": VALUES})
)
def test_whatever_a_file_says_it_is_a_mission_or_a_clear_error(tmp_path: Path, document: dict[str, object]) -> None:
    path = written(tmp_path, json.dumps(document))
    with suppress(InputError):
        load_mission(path)
