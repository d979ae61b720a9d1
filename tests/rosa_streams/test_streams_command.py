"""``rosa streams`` as a user runs it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.rosa_cli.cli import refused, rosa
from tests.rosa_streams.nao import DATA

PIFF = (DATA / "table1.xml", DATA / "pose.xml", DATA / "piff.yaml")


def document(*arguments: object, code: int = 0) -> Any:
    process = rosa("streams", *arguments, "--json")
    assert process.returncode == code, process
    return json.loads(process.stdout)


def test_match_counts_ports_and_names_pairs() -> None:
    found = document("match", DATA / "table1.xml", DATA / "piff.yaml", DATA / "ball.xml")
    assert list(found) == ["inputs", "outputs", "matches"]
    assert (found["inputs"], found["outputs"]) == (11, 19)
    assert ["segmenter(piff).hull", "ball_detector(piff).hull"] in found["matches"]


def test_plan_prints_units_with_their_channels() -> None:
    found = document("plan", *PIFF, DATA / "ball.xml")
    assert list(found) == ["status", "cost", "bound", "units", "why"]
    assert (found["status"], found["why"]) == ("optimal", None)
    assert found["cost"] == found["bound"] == 32.0
    units = {unit["transformation"]: unit for unit in found["units"]}
    assert len(units) == 6
    assert units["ball_localization(piff)"]["outputs"] == {"position": "/result"}
    fed = units["segmenter(piff)"]["inputs"]
    assert set(fed.values()) <= set(units["subsampler(piff)"]["outputs"].values())


@pytest.mark.parametrize("search", ["paper", "fast", "exact"])
def test_every_search_plans(search: str) -> None:
    found = document("plan", *PIFF, DATA / "ball.xml", "--search", search, "--horizon", 10)
    assert found["cost"] == pytest.approx(6.2 + 10 * 0.43)


def test_no_plan_is_the_answer_no_with_the_reason() -> None:
    found = document("plan", DATA / "table1.xml", DATA / "piff.yaml", DATA / "ball.xml", code=1)
    assert (found["status"], found["cost"], found["units"]) == ("none", None, [])
    assert "no transformation gives Pose" in found["why"]
    refused_cost = document("plan", *PIFF, DATA / "ball.xml", "--max-cost", 5, code=1)
    assert "MAX_COST is 5" in refused_cost["why"]


def test_explain_names_what_is_missing_and_what_would_help() -> None:
    process = rosa("streams", "explain", DATA / "table1.xml", DATA / "piff.yaml", DATA / "ball.xml", "q0")
    assert process.returncode == 1
    assert "lacks its input pose" in process.stdout
    assert "to help: register a transformation that gives Pose" in process.stdout
    found = document("explain", *PIFF, DATA / "ball.xml")
    assert found["targets"]["q0"]["satisfied"] is True
    assert "    from ball_detector.1.ball" in found["targets"]["q0"]["reasons"]
    assert "did you mean 'q0'" in refused(rosa("streams", "explain", *PIFF, DATA / "ball.xml", "q00"))


def test_check_finds_violations_in_running_units(tmp_path: Path) -> None:
    assert document("check", *PIFF)["violations"] == []
    (tmp_path / "units.yaml").write_text("units: {segmenter.1: {transformation: segmenter(piff), inputs: {y: /y}}}")
    found = document("check", *PIFF, tmp_path / "units.yaml", code=1)
    assert {each["kind"] for each in found["violations"]} == {"no stream"}


def recording(tmp_path: Path, text: str) -> Path:
    (tmp_path / "data.csv").write_text(text)
    return tmp_path / "data.csv"


@pytest.mark.parametrize(
    ("formula", "verdict", "time", "code"),
    [
        ("G[0,2] x > 3", "false", 1.5, 1),
        ("F[0,2] mode == 'defend'", "true", 1.0, 0),
        ("G (lost -> F[0,5] found)", "unknown", None, 0),
        ("F[3,4] x > 4", "true", 4.0, 0),
        ("F[0.5,0.9] x > 0", "false", 1.0, 1),
        ("x > 3 and O[0,1] mode matches 'att*'", "true", 0.0, 0),
        ("F[4,4] y > 1", "unknown", None, 0),
    ],
)
def test_monitor_gives_the_verdict_and_when_it_was_known(
    tmp_path: Path, formula: str, verdict: str, time: float | None, code: int
) -> None:
    data = recording(
        tmp_path,
        "time,x,mode,lost,found,y\n0,5,attack,false,0,1\n1,4,defend,false,0,1\n1.5,3,defend,true,0,1\n4,5,attack,0,0,\n",
    )
    assert document("monitor", formula, "--data", data, code=code) == {"verdict": verdict, "time": time}


@pytest.mark.parametrize(
    ("formula", "text", "said"),
    [
        ("x > 3", "time,y\n0,1\n", "data.csv:1: there is no column 'x'"),
        ("x > 3", "time,x\n0,1\n0,2\n", "data.csv:3: times grow"),
        ("x > 3", "time,x\n0,high\n", "data.csv:2: 'high' in the column 'x' is no number"),
        ("x > 3", "time,x\nsoon,1\n", "data.csv:2: the time 'soon' is no number"),
        ("x > 3", "time,x\n0\n", "data.csv:2: a row has 1 fields, and the header 2"),
        ("x > 3", "", "data.csv:1: there is no column 'time'"),
        ("x > ", "time,x\n0,1\n", "column 4"),
        ("x > 3", "x,time,time\n0,1,1\n", "two columns are named 'time'"),
    ],
)
def test_a_recording_or_formula_that_cannot_be_used_is_bad_input(
    tmp_path: Path, formula: str, text: str, said: str
) -> None:
    assert said in refused(rosa("streams", "monitor", formula, "--data", recording(tmp_path, text)))


def test_monitor_knows_regions(tmp_path: Path) -> None:
    pytest.importorskip("shapely")
    (tmp_path / "regions.yaml").write_text("half: [[0, 0], [4, 0], [4, 6], [0, 6]]\n")
    data = recording(tmp_path, "time,ball\n0,POINT (1 1)\n1,POINT (9 1)\n")
    found = document("monitor", "G inside(ball, half)", "--data", data, "--regions", tmp_path / "regions.yaml", code=1)
    assert found == {"verdict": "false", "time": 1.0}
    (tmp_path / "regions.yaml").write_text("half: [1]\n")
    process = rosa("streams", "monitor", "G inside(ball, half)", "--data", data, "--regions", tmp_path / "regions.yaml")
    assert "regions.yaml:1" in refused(process)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("plan", DATA / "nothing.xml"), "cannot read it"),
        (("match", DATA / "table1.xml"), "no class 'NAO'"),
        (("plan", DATA / "piff.yaml"), "there are no transformations or targets in the files"),
        (("plan", *PIFF, "--search", "exakt"), "did you mean 'exact'"),
        (("monitor", "G p", "--data", DATA / "nothing.csv"), "cannot read it"),
        (("monitor", "G p", "--data", DATA / "table1.xml"), "a recording of the kind '.xml' cannot be read"),
    ],
)
def test_bad_input_is_one_message_and_exit_code_2(arguments: tuple[object, ...], said: str) -> None:
    assert said in refused(rosa("streams", *arguments))
