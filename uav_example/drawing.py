"""Draws a flight as SVG: the area from above, with what was done where, and the battery over time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from rosa_simulation.run_record import RunRecord
from uav_example import skills

_COLOURS = {
    skills.SEARCH: "#8c8c8c",
    skills.ANALYZE: "#1f6fb4",
    skills.ANALYZE_IN_SITU: "#d9541e",
    skills.RETURN_BASE: "#3a9142",
    skills.LAND_FOLD: "#8a4fa3",
}
_NO_ACTION = "#000000"
_WIDTH, _MARGIN, _STRIP, _LINE = 720.0, 40.0, 90.0, 18.0

Point = tuple[float, float]


def draw_flight(record: RunRecord) -> str:
    """The flight of a run as an SVG document that stands on its own."""
    world = record.inputs["world"]
    scale = (_WIDTH - 2.0 * _MARGIN) / world["width"]
    ground = world["depth"] * scale + _MARGIN
    height = ground + _STRIP + 3.0 * _MARGIN + _LINE

    def on_map(x: float, y: float) -> Point:
        return _MARGIN + x * scale, ground - y * scale

    svg = Element("svg", xmlns="http://www.w3.org/2000/svg", viewBox=f"0 0 {_WIDTH:g} {height:.0f}")
    svg.set("font-family", "sans-serif")
    svg.set("font-size", "12")
    _add(svg, "rect", width=_WIDTH, height=height, fill="white")
    _add(svg, "rect", x=_MARGIN, y=_MARGIN, width=_WIDTH - 2.0 * _MARGIN, height=ground - _MARGIN, fill="#f3f0e6")
    stretches = list(_stretches(record))
    for action, rows in stretches:
        _line(svg, [on_map(x, y) for _, x, y, _, _ in rows], action)
    _draw_samples(svg, record, on_map)
    _text(svg, on_map(0.0, 0.0), "base", dy=_LINE)
    _draw_battery(svg, record, stretches, top=ground + _MARGIN)
    _draw_legend(svg, y=height - _MARGIN / 2.0)
    indent(svg)
    return tostring(svg, encoding="unicode") + "\n"


def _stretches(record: RunRecord) -> Iterator[tuple[str, list[tuple[float, ...]]]]:
    """The rows of the trajectory by what was being done, each stretch up to the first row of the next."""
    changes = [(0.0, ""), *_actions_begun(record)]
    ends = [time for time, _ in changes[1:]] + [float("inf")]
    for (begin, action), end in zip(changes, ends, strict=True):
        rows = [row for row in record.trajectory if begin - 1.0 <= row[0] <= end]
        if len(rows) > 1:
            yield action, rows


def _actions_begun(record: RunRecord) -> Iterator[tuple[float, str]]:
    for event in record.events:
        for fact in event.facts:
            if fact["fact"] == "actions" and fact["requested"]:
                yield event.time_s, fact["requested"][-1]


def _draw_samples(svg: Element, record: RunRecord, on_map: Any) -> None:
    how = _analyses(record)
    for sample in record.inputs["samples"]:
        number, (x, y) = str(sample["number"]), on_map(sample["x"], sample["y"])
        colour = _COLOURS.get(how.get(number, ""), "white")
        circle = _add(svg, "circle", cx=x, cy=y, r=6.0, fill=colour, stroke="black")
        SubElement(circle, "title").text = f"sample {number}: {how.get(number, 'not analysed')}"
        _text(svg, (x + 9.0, y - 6.0), number)


def _analyses(record: RunRecord) -> Mapping[str, str]:
    """By which action each sample was analysed, by the sample's number."""
    kinds = {"picked up": skills.ANALYZE, "in situ": skills.ANALYZE_IN_SITU}
    facts = (fact for event in record.events for fact in event.facts if fact["fact"] == "sample analysed")
    return {fact["subject"]: kinds[fact["analysis"]] for fact in facts}


def _draw_battery(svg: Element, record: RunRecord, stretches: Iterable[tuple[str, list[Any]]], *, top: float) -> None:
    wide, duration = _WIDTH - 2.0 * _MARGIN, max(record.duration_s, 1.0)

    def at(time: float, level: float) -> Point:
        return _MARGIN + wide * time / duration, top + _STRIP * (1.0 - level)

    for limit, action in ((0.25, skills.SEARCH), (0.5, skills.ANALYZE)):
        (x1, y1), (x2, y2) = at(0.0, limit), at(duration, limit)
        _add(svg, "line", x1=x1, y1=y1, x2=x2, y2=y2, stroke="#bbbbbb", stroke_dasharray="4 3")
        _text(svg, (x2, y2), action, dx=2.0, size=9)
    for action, rows in stretches:
        _line(svg, [at(row[0], row[-1]) for row in rows], action)
    _text(svg, (_MARGIN, top), "battery", dy=-4.0)
    _text(svg, at(duration, 0.0), f"{duration:.0f} s", dy=_LINE, dx=-24.0)


def _draw_legend(svg: Element, *, y: float) -> None:
    for column, (action, colour) in enumerate(_COLOURS.items()):
        x = _MARGIN + column * (_WIDTH - 2.0 * _MARGIN) / len(_COLOURS)
        _add(svg, "line", x1=x, y1=y - 4.0, x2=x + 20.0, y2=y - 4.0, stroke=colour, stroke_width=3)
        _text(svg, (x + 26.0, y), action)


def _line(svg: Element, points: list[Point], action: str) -> None:
    corners = [points[0], *(p for before, p in pairwise(points) if p != before)]
    coordinates = " ".join(f"{x:.1f},{y:.1f}" for x, y in corners)
    colour = _COLOURS.get(action, _NO_ACTION)
    _add(svg, "polyline", points=coordinates, fill="none", stroke=colour, stroke_width=2, stroke_linejoin="round")


def _text(svg: Element, at: Point, text: str, *, dx: float = 0.0, dy: float = 0.0, size: float = 12) -> None:
    _add(svg, "text", x=at[0] + dx, y=at[1] + dy, font_size=size).text = text


def _add(parent: Element, tag: str, **attributes: str | float) -> Element:
    given = {
        name.replace("_", "-"): value if isinstance(value, str) else f"{value:.1f}".removesuffix(".0")
        for name, value in attributes.items()
    }
    return SubElement(parent, tag, given)
