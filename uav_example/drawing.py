"""Draws a flight as SVG: the area from above, with what was done where, and the battery over time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any

from rosa_simulation.run_record import RunRecord
from task_layer.svg import Canvas, Point, drawing, tooltip
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


def draw_flight(record: RunRecord) -> str:
    """The flight of a run as an SVG document that stands on its own."""
    world = record.inputs["world"]
    scale = (_WIDTH - 2.0 * _MARGIN) / world["width"]
    ground = world["depth"] * scale + _MARGIN
    height = ground + _STRIP + 3.0 * _MARGIN + _LINE

    def on_map(x: float, y: float) -> Point:
        return _MARGIN + x * scale, ground - y * scale

    canvas = drawing(_WIDTH, height, font_family="sans-serif", font_size=12)
    canvas.rect((_MARGIN, _MARGIN), _WIDTH - 2.0 * _MARGIN, ground - _MARGIN, fill="#f3f0e6")
    stretches = list(_stretches(record))
    for action, rows in stretches:
        _draw_stretch(canvas, [on_map(x, y) for _, x, y, _, _ in rows], action)
    _draw_samples(canvas, record, on_map)
    canvas.text((_MARGIN, ground + _LINE), "base")
    _draw_battery(canvas, record, stretches, top=ground + _MARGIN)
    _draw_legend(canvas, y=height - _MARGIN / 2.0)
    return canvas.document(indented=True)


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


def _draw_samples(canvas: Canvas, record: RunRecord, on_map: Callable[[float, float], Point]) -> None:
    how = _analyses(record)
    for sample in record.inputs["samples"]:
        number, (x, y) = str(sample["number"]), on_map(sample["x"], sample["y"])
        colour = _COLOURS.get(how.get(number, ""), "white")
        circle = canvas.circle((x, y), 6.0, fill=colour, stroke="black")
        tooltip(circle, f"sample {number}: {how.get(number, 'not analysed')}")
        canvas.text((x + 9.0, y - 6.0), number)


def _analyses(record: RunRecord) -> Mapping[str, str]:
    """By which action each sample was analysed, by the sample's number."""
    kinds = {"picked up": skills.ANALYZE, "in situ": skills.ANALYZE_IN_SITU}
    facts = (fact for event in record.events for fact in event.facts if fact["fact"] == "sample analysed")
    return {fact["subject"]: kinds[fact["analysis"]] for fact in facts}


def _draw_battery(canvas: Canvas, record: RunRecord, stretches: Iterable[tuple[str, list[Any]]], *, top: float) -> None:
    wide, duration = _WIDTH - 2.0 * _MARGIN, max(record.duration_s, 1.0)

    def at(time: float, level: float) -> Point:
        return _MARGIN + wide * time / duration, top + _STRIP * (1.0 - level)

    for limit, action in ((0.25, skills.SEARCH), (0.5, skills.ANALYZE)):
        x, y = at(duration, limit)
        canvas.line(at(0.0, limit), (x, y), stroke="#bbbbbb", stroke_dasharray="4 3")
        canvas.text((x + 2.0, y), action, font_size=9)
    for action, rows in stretches:
        _draw_stretch(canvas, [at(row[0], row[-1]) for row in rows], action)
    canvas.text((_MARGIN, top - 4.0), "battery")
    x, y = at(duration, 0.0)
    canvas.text((x - 24.0, y + _LINE), f"{duration:.0f} s")


def _draw_legend(canvas: Canvas, *, y: float) -> None:
    for column, (action, colour) in enumerate(_COLOURS.items()):
        x = _MARGIN + column * (_WIDTH - 2.0 * _MARGIN) / len(_COLOURS)
        canvas.line((x, y - 4.0), (x + 20.0, y - 4.0), stroke=colour, stroke_width=3)
        canvas.text((x + 26.0, y), action)


def _draw_stretch(canvas: Canvas, points: list[Point], action: str) -> None:
    corners = [points[0], *(p for before, p in pairwise(points) if p != before)]
    canvas.polyline(corners, stroke=_COLOURS.get(action, _NO_ACTION), stroke_width=2)
