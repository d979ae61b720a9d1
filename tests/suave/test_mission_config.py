"""The exemplar's mission configurations load unchanged; what does not fit is named with its line."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import InputError
from suave.mission_config import MissionConfig, ThrusterEvent, load_mission_config

EXEMPLARS = """\
/mission_metrics:
  ros__parameters:
    result_path: "~/suave/results" # Path to save results
    water_visibiity_threshold: [3.25, 2.25, 1.25]
    expected_altitude: [3.0, 2.0, 1.0]
    battery_limit: 0.2

/mission_node:
  ros__parameters:
    time_limit: 250 # Time limit for a time_constrained mission
    f_generate_search_path_mode: "fd_spiral_medium"

/water_visibility_observer_node:  # water visibility
  ros__parameters:
    qa_publishing_period: 0.5
    water_visibility_period: 120
    water_visibility_min: 2.5
    water_visibility_max: 2.5
    water_visibility_sec_shift: 10.0

/battery_monitor:
  ros__parameters:
    discharge_time: 180.0

/thruster_monitor:
  ros__parameters:
    thruster_events: # (thruster number (1 to 6), failure or recovery, seconds from the last event)
    - (1,failure,100)
    - (3,recovery,20.5)

/task_bridge:
  ros__parameters:
    adapt_period: 30
"""


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "mission_config.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_of_the_exemplar_loads_unchanged(tmp_path: Path) -> None:
    config, ignored = load_mission_config(write(tmp_path, EXEMPLARS))
    assert config == MissionConfig(
        time_limit=250.0,
        qa_publishing_period=0.5,
        water_visibility_period=120.0,
        water_visibility_min=2.5,
        water_visibility_max=2.5,
        water_visibility_sec_shift=10.0,
        thruster_events=(ThrusterEvent(1, True, 100.0), ThrusterEvent(3, False, 20.5)),
        discharge_time=180.0,
        f_generate_search_path_mode="fd_spiral_medium",
        adaptation_period=30.0,
        battery_limit=0.2,
    )
    assert len(ignored) == 1
    assert "mission_config.yaml:3: 'result_path'" in ignored[0]


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("- 1\n", 1, "not a mission configuration"),
        ("", 1, "not a mission configuration"),
        ("/a:\n  b: 1\n", 1, "ros__parameters"),
        ("/a:\n  ros__parameters:\n    time_limit: soon\n", 3, "a number is expected"),
        ("/a:\n  ros__parameters:\n    time_limit: .nan\n", 3, "a finite number is expected"),
        ("/a:\n  ros__parameters:\n    time_limit: true\n", 3, "a number is expected"),
        ("/a:\n  ros__parameters:\n    time_limit: 0\n", 3, "above 0"),
        ("/a:\n  ros__parameters:\n    thruster_events: ['(7,failure,1)']\n", 3, r"look like (1,failure,35)"),
        ("/a:\n  ros__parameters:\n    f_generate_search_path_mode: fast\n", 3, "fd_spiral_low"),
        ("/a:\n  ros__parameters:\n    expected_altitude: 3\n", 3, "a list is expected"),
        ("/a:\n  ros__parameters:\n    x: 1\n    x: 2\n", 4, "stands twice"),
        ("/a: [\n", 2, "not valid YAML"),
    ],
)
def test_what_does_not_fit_is_named_with_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    with pytest.raises(InputError) as error:
        load_mission_config(write(tmp_path, text))
    assert f"mission_config.yaml:{line}:" in str(error.value)
    assert words in str(error.value)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ("water_visibility_min: 4", "water_visibility_min is above"),
        ("expected_altitude: [1.0]", "different lengths"),
    ],
)
def test_values_that_do_not_go_together_are_refused(tmp_path: Path, parameters: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        load_mission_config(write(tmp_path, f"/a:\n  ros__parameters:\n    {parameters}\n"))


def test_a_misspelt_key_is_left_out_and_its_neighbour_named(tmp_path: Path) -> None:
    _, ignored = load_mission_config(write(tmp_path, "/a:\n  ros__parameters:\n    time_limt: 10\n"))
    assert "did you mean 'time_limit'?" in ignored[0]
