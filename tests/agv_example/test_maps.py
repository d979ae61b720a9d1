"""Map files: our own, grids, and those of the CMU BRASS exemplar; what is wrong is named with its line."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agv_example.corridors import Corridor, CorridorMap, Drive, Place
from agv_example.grids import grid_map
from agv_example.map_formats import load_map
from agv_example.planning import CoAdaptivePlanner, Objective
from rosa_core import InputError, InvalidValueError
from tests.agv_example.brass_map import brass_document, write_brass_map
from tests.agv_example.maps import agv_kb, options_on

PAPER = Path(str(files("agv_example.maps"))) / "paper.yaml"
AMCL_KINECT = frozenset({"amcl", "kinect"})


def written(tmp_path: Path, text: str, name: str = "map.yaml") -> Path:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


# our own format


def test_the_papers_map() -> None:
    corridors = load_map(PAPER)
    assert [place.name for place in corridors.places] == ["A", "B", "C", "D"]
    c1 = corridors.corridor("C1")
    assert (c1.length, c1.obstacles, c1.accuracy) == (20.0, 3, 1.6)
    assert [corridors.corridor(name).length for name in ("C4", "C3", "C2")] == [10.0, 20.0, 10.0]
    assert [corridors.corridor(name).obstacles for name in ("C4", "C3", "C2")] == [0, 0, 0]


def test_everything_that_can_be_said_of_a_corridor(tmp_path: Path) -> None:
    path = written(
        tmp_path,
        "{'places': {'1': [0, 0], 'b': [3, 4]}, 'corridors': {'x': {'between': [1, 'b'], 'obstacles': 2, 'accuracy': 1,"
        " 'light': 0.5, 'speed_limit': 0.3, 'one_way': true, 'closed': true},"
        " 'y': {'between': ['b', '1'], 'length': 9}}}",
        "map.json",
    )
    x, y = load_map(path).corridors
    assert x == Corridor("x", "1", "b", 5.0, 2, 1.0, 0.5, 0.3, one_way=True, closed=True)
    assert y == Corridor("y", "b", "1", 9.0)
    assert x.origins() == ()
    assert y.origins() == ("b", "1")


def test_a_grid_in_a_file_is_the_grid_of_the_program(tmp_path: Path) -> None:
    path = written(tmp_path, "grid: {columns: 5, rows: 4, seed: 7, dark: 0.5, length: 8}\n")
    assert load_map(path) == grid_map(5, 4, 7, dark=0.5, length=8.0)


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("", 1, "not a map"),
        ("- 1\n", 1, "not a map"),
        (
            "places: {A: [0, 0]}\nroads: {}\n",
            2,
            "unknown key 'roads' in the file (allowed here: name, places, corridors, grid)",
        ),
        ("places:\n  A: [0]\n", 2, "places / A: does not fit here (two of them are expected"),
        ("places:\n  A: [0, north]\n", 2, "'north' does not fit here (a number is expected"),
        ("places:\n  A: [0, .nan]\n", 2, "a finite number is expected"),
        ("places:\n  A: [0, true]\n", 2, "a number is expected"),
        (
            "places: {A: [0, 0], B: [1, 0]}\ncorridors:\n  x: {between: [A]}\n",
            3,
            "corridors / x / between: does not fit here (two of them",
        ),
        ("places: {A: [0, 0], B: [1, 0]}\ncorridors:\n  x: {between: [A, Z]}\n", 3, "there is no place 'Z'"),
        ("places: {A: [0, 0], B: [1, 0]}\ncorridors:\n  x: {between: [A, A]}\n", 3, "same spot"),
        ("places: {A: [0, 0], B: [0, 0]}\ncorridors:\n  x: {between: [A, B]}\n", 3, "give its length"),
        ("places: {A: [0, 0], B: [1, 0]}\ncorridors:\n  x: {between: [A, B], light: 2}\n", 3, "from 0 to 1"),
        ("places: {A: [0, 0], B: [1, 0]}\ncorridors:\n  x: {between: [A, B], lights: 1}\n", 3, "did you mean 'light'?"),
        ("places: {A: [0, 0], B: [1, 0]}\ncorridors:\n  x: {between: [A, B], length: 0}\n", 3, "a number from 0.001 "),
        ("places: {A: [0, 0], B: [1, 0]}\ncorridors:\n  x: {between: [A, B], obstacles: 1.5}\n", 3, "whole number"),
        (
            "places: {A: [0, 0], B: [1, 0]}\ncorridors:\n  x: {between: [A, B], closed: 1}\n",
            3,
            "true or false is expected",
        ),
        ("places: {A: [0, 0]}\ncorridors: [x]\n", 2, "corridors: does not fit here (a mapping is expected"),
        ("grid: {columns: 0, rows: 2}\n", 1, "from 1 to 1000"),
        ("grid: {columns: 2, rows: 2, dark: 3}\n", 1, "from 0 to 1"),
        ("places: {A: [0, 0]\n", 2, "not valid YAML"),
        ("corridors: {}\n", 1, "the map has no places"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    with pytest.raises(InputError) as error:
        load_map(written(tmp_path, text))
    assert f"map.yaml:{line}:" in str(error.value)
    assert words in str(error.value)


def test_a_map_made_in_python_is_checked_as_well() -> None:
    with pytest.raises(InputError) as error:
        CorridorMap(
            (Place("A", 0, 0), Place("A", 1, 1), Place("B", float("nan"), 0)),
            (Corridor("x", "A", "Q", 1.0), Corridor("x", "A", "A", -1.0, obstacles=-1, light=7.0, speed_limit=0.0)),
        )
    for words in ("two places 'A'", "two corridors 'x'", "'B' is nowhere", "no place 'Q'", "to itself", "-1 m long",
                  "cannot ask for that", "light is 7", "the speed limit is 0"):  # fmt: skip
        assert words in str(error.value)


def test_a_corridor_or_place_that_is_not_there_is_named_with_its_neighbour() -> None:
    with pytest.raises(InputError, match=r"no corridor 'C11' on the paper \(did you mean 'C1'\?\)"):
        load_map(PAPER).corridor("C11")


# grids


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 8), st.integers(1, 8), st.integers(0, 1000), st.sampled_from([0.0, 0.4, 1.0]))
def test_every_place_of_a_grid_can_be_reached(columns: int, rows: int, seed: int, missing: float) -> None:
    corridors = grid_map(columns, rows, seed, missing=missing)
    graph = nx.Graph((c.start, c.end) for c in corridors.corridors)
    graph.add_nodes_from(place.name for place in corridors.places)
    assert len(corridors.places) == columns * rows
    assert nx.is_connected(graph)
    if missing == 1.0:
        assert nx.is_tree(graph)
    assert corridors == grid_map(columns, rows, seed, missing=missing)


@pytest.mark.parametrize("options", [{"columns": 0}, {"columns": 10**6}, {"dark": 1.5}, {"length": 0.0}])
def test_grids_that_cannot_be_are_refused(options: dict[str, Any]) -> None:
    with pytest.raises(InvalidValueError):
        grid_map(**{"columns": 3, "rows": 3, **options})


# the BRASS exemplar's format


def test_a_brass_map_is_read_unchanged(tmp_path: Path) -> None:
    corridors = load_map(write_brass_map(tmp_path / "cp3.json"))
    document = brass_document()
    assert len(corridors.places) == 57
    assert len(corridors.corridors) == 7 * 7 + 8 * 6
    one = next(entry for entry in document["time"] if "amcl-kinect-35" in entry)
    corridor = next(c for c in corridors.corridors if {c.start, c.end} == {one["from"], one["to"]})
    (hits,) = (e for e in document["hitrate"] if (e["from"], e["to"]) == (one["from"], one["to"]))
    measured = Drive(one["amcl-kinect-35"]["mean"], hits["amcl-kinect-35"]["hitrate"])
    assert corridor.measured[one["from"]].drive(AMCL_KINECT | {"move_base"}, 0.35) == measured
    assert corridor.measured[one["to"]].drive(AMCL_KINECT, 0.35) == measured, "as in the direction that is listed"
    assert not any("mean" in str(key) for key in corridor.measured[one["from"]].drives)


def test_a_configuration_without_an_entry_was_not_tried(tmp_path: Path) -> None:
    document = brass_document(2, 1)
    document["time"] = [
        {"from": "l1", "to": "l2", "amcl-kinect": {"mean": 20, "stdev": 1}, "aruco": {"mean": 9, "stdev": 1}}
    ]
    document["hitrate"] = [{"from": "l1", "to": "l2", "amcl-kinect": {"hitrate": 0.25}}]
    corridors = load_map(written(tmp_path, json.dumps(document), "map.json"))
    measured = corridors.corridors[0].measured["l1"]
    assert measured.drive(AMCL_KINECT, 0.68) == measured.drive(AMCL_KINECT, 0.24) == Drive(20.0, 0.25)
    assert measured.drive(frozenset({"aruco", "camera"}), 0.68) is None, "nobody counted its hits"
    assert measured.drive(frozenset({"mrpt", "lidar"}), 0.68) is None
    planner = CoAdaptivePlanner(corridors, options_on(corridors, agv_kb()))
    route = planner.route("l1", "l2", Objective.cheapest("time"))
    assert route is not None
    assert route.legs[0].configuration.designs[0] == "kinect + amcl"
    assert (
        CoAdaptivePlanner(corridors, options_on(corridors, agv_kb(["kinect"]))).route(
            "l1", "l2", Objective.cheapest("time")
        )
        is None
    )


def test_dark_corridors_need_light_and_illuminance_that_was_not_measured_counts_as_bright(tmp_path: Path) -> None:
    document = brass_document(4, 1)
    ways = [("l1", "l2"), ("l2", "l3"), ("l3", "l4")]
    document["min_illuminance"] = [
        {"from": one, "to": other, "mean": mean}
        for (one, other), mean in zip(ways, (51.0, -1210.0, 255.0), strict=True)
    ]
    corridors = load_map(written(tmp_path, json.dumps(document), "map.json"))
    assert [corridor.light for corridor in corridors.corridors] == [0.2, 1.0, 1.0]


def test_the_place_that_nothing_leads_to_is_there_and_out_of_reach(tmp_path: Path) -> None:
    corridors = load_map(write_brass_map(tmp_path / "map.json"))
    planner = CoAdaptivePlanner(corridors, options_on(corridors, agv_kb()))
    assert planner.route("l1", "l57", Objective.cheapest("time")) is None
    assert planner.route("l57", "l1", Objective.cheapest("time")) is None
    assert planner.route("l1", "l56", Objective.cheapest("time")) is not None


def test_a_brass_corridor_in_one_direction_only_is_one_way(tmp_path: Path) -> None:
    document = brass_document(2, 1)
    document["map"][1]["connected-to"] = []
    (corridor,) = load_map(written(tmp_path, json.dumps(document), "map.json")).corridors
    assert corridor.origins() == ("l1",)


def _renamed(document: dict[str, Any]) -> None:
    document["map"][0]["connected-to"].append("l99")


def _twice(document: dict[str, Any]) -> None:
    document["map"].append(document["map"][0])


def _late(document: dict[str, Any]) -> None:
    document["time"].append({"from": "l1", "to": "l2", "amcl-kinect": {"mean": "soon"}})


def _nowhere(document: dict[str, Any]) -> None:
    del document["map"][0]["coords"]


def _less_than_nothing(document: dict[str, Any]) -> None:
    document["hitrate"].append({"from": "l1", "to": "l2", "amcl-kinect": {"hitrate": -1}})


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (_renamed, "'l1' is connected to 'l99', which is no place"),
        (_twice, "place 'l1' is there twice"),
        (_late, "mean of amcl-kinect is 'soon' (a number is expected)"),
        (_nowhere, "map / 0 has no 'coords'"),
        (_less_than_nothing, "a number from 0 "),
    ],
)
def test_a_brass_map_that_is_wrong_is_refused_with_the_line(tmp_path: Path, spoil: Any, words: str) -> None:
    document = brass_document(3, 2)
    spoil(document)
    with pytest.raises(InputError, match=r"map.json:\d+: ") as error:
        load_map(written(tmp_path, json.dumps(document, indent=1), "map.json"))
    assert words in str(error.value)
