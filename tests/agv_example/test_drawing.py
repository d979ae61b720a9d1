"""Maps and runs drawn as SVG."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from agv_example.corridors import Corridor, CorridorMap, Place
from agv_example.drawing import DrawnLeg, DrawnRoute, draw_map, draw_run, map_from_inputs
from agv_example.grids import grid_map
from agv_example.scenario import AGV
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver
from tests.agv_example.maps import paper_corridors

ROOT = Path(__file__).resolve().parents[2]
SVG = "{http://www.w3.org/2000/svg}"


def texts(svg: str) -> list[str]:
    return [element.text or "" for element in ET.fromstring(svg).iter(f"{SVG}text")]


def drawn(record: RunRecord) -> str:
    facts = [fact for event in record.events for fact in event.facts]
    return draw_run(record.inputs, facts, record.trajectory)


@pytest.fixture(scope="module")
def record() -> RunRecord:
    return AGV.run(RunRequest(), SilentObserver())


def test_the_picture_in_the_docs_is_the_one_that_the_program_draws(record: RunRecord) -> None:
    assert (ROOT / "docs" / "agv.svg").read_text(encoding="utf-8") == drawn(record)


def test_a_run_is_drawn_with_what_it_would_have_been_and_why_it_changed(record: RunRecord) -> None:
    svg = drawn(record)
    said = texts(svg)
    for words in ("A", "B", "C", "D", "C1", "C3, light 0.3", "C4, max 0.35 m/s", "kinect failed"):
        assert words in said
    assert said.count("kinect + amcl, high speed") == 1
    assert any(text.startswith("to B: energy") for text in said)
    assert any(text.startswith("to B, as kinect failed: energy") for text in said)
    dashed = [line for line in ET.fromstring(svg).iter(f"{SVG}line") if "stroke-dasharray" in line.attrib]
    assert len(dashed) == 2, "the first route and its entry in the legend"
    (line,) = ET.fromstring(svg).iter(f"{SVG}polyline")
    assert len(line.attrib["points"].split()) == len(record.trajectory)


def test_the_map_comes_back_from_a_record(record: RunRecord) -> None:
    corridors = map_from_inputs(record.inputs["map"])
    assert [corridor.name for corridor in corridors.corridors] == ["C1", "C4", "C3", "C2"]
    assert corridors.corridor("C3").light == 0.3


def test_obstacles_and_closed_corridors_are_shown() -> None:
    assert len(list(ET.fromstring(draw_map(paper_corridors(obstacles=7))).iter(f"{SVG}rect"))) == 1 + 7
    assert "✕" in texts(draw_map(paper_corridors(closed=True)))
    assert "✕" not in texts(draw_map(paper_corridors()))


def test_names_are_text_whatever_they_are() -> None:
    places = (Place("<script>", 0, 0), Place("&", 1, 1))
    corridors = CorridorMap(places, (Corridor("</svg>", "<script>", "&", 1.0),))
    svg = draw_map(corridors, [DrawnRoute("<b>", [DrawnLeg("<script>", "&", '"quoted"')])], marks={"<i>": (0, 0)})
    assert {"<script>", "&", "</svg>", "<b>", '"quoted"', "<i>"} <= set(texts(svg))


def test_a_large_map_is_drawn_without_labels() -> None:
    assert texts(draw_map(grid_map(12, 10))) == []
    assert texts(draw_map(CorridorMap((Place("A", 3, 3),), ()))) == ["A"]
