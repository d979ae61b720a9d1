"""The picture of a flight."""

from __future__ import annotations

from xml.etree import ElementTree

from tests.uav_example.flights import fly
from uav_example.drawing import draw_flight

SVG = "{http://www.w3.org/2000/svg}"


def test_every_sample_is_there_with_how_it_was_analysed() -> None:
    record = fly(samples=3)
    titles = [title.text for title in ElementTree.fromstring(draw_flight(record)).iter(f"{SVG}title")]
    assert len(titles) == 3
    assert all("analyze" in str(title) for title in titles)


def test_a_flight_that_nobody_managed_can_be_drawn_too() -> None:
    root = ElementTree.fromstring(draw_flight(fly(manager="none", time_limit=60.0)))
    titles = [title.text for title in root.iter(f"{SVG}title")]
    assert "sample 3: not analysed" in titles
    assert len(list(root.iter(f"{SVG}polyline"))) == 2


def test_a_flight_that_has_hardly_begun_can_be_drawn() -> None:
    ElementTree.fromstring(draw_flight(fly(time_limit=1.0)))
