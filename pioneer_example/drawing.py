"""Draws a run as the paper's figure 4: the trajectory by route, dots for actions, squares where the route changes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from rosa_simulation.run_record import RunRecord
from task_layer.svg import Canvas, Point, drawing, tooltip

DELIBERATIVE, REACTIVE = "#1f6fb4", "#d9541e"
_SCALE = 150.0
_MARGIN = 50.0
_LEGEND = 90.0
_CHANGES = ("preempted", "handed back", "route")


def draw_run(record: RunRecord) -> str:
    """The run as an SVG document.

    Args:
        record: a run of the scenario ``pioneer``.
    """
    view = _View(record.inputs["arena"])
    view.draw_arena(record.inputs["arena"])
    rows = [row[1:] for row in record.trajectory]
    for points, reactive in _stretches(rows):
        colour = REACTIVE if reactive else DELIBERATIVE
        view.canvas.polyline([view.at(*point) for point in points], stroke=colour, stroke_width=2.5)
    for before, row in pairwise(rows):
        if row[5] > before[5]:
            view.canvas.circle(view.at(row[0], row[1]), 2.2, fill=REACTIVE if row[3] else DELIBERATIVE)
    for time, text in _changes(record):
        x, y = view.at(*_position(record.trajectory, time))
        colour = DELIBERATIVE if "hands the command back" in text or text.startswith("deliberative") else REACTIVE
        square = view.canvas.rect((x - 4.5, y - 4.5), 9, 9, fill="none", stroke=colour, stroke_width=1.8)
        tooltip(square, f"{time:.2f} s: {text}")
    view.draw_legend(record)
    return view.canvas.document(indented=True)


class _View:
    """Metres to the right and upwards become pixels to the right and downwards."""

    def __init__(self, arena: Mapping[str, Any]) -> None:
        walls = arena["walls"]
        self.left = min(wall["x"] - wall["half_x"] for wall in walls)
        self.top = max(wall["y"] + wall["half_y"] for wall in walls)
        width = max(wall["x"] + wall["half_x"] for wall in walls) - self.left
        height = self.top - min(wall["y"] - wall["half_y"] for wall in walls)
        self.bottom = height * _SCALE + 1.5 * _MARGIN
        self.canvas: Canvas = drawing(
            width * _SCALE + 2 * _MARGIN, self.bottom + _LEGEND, font_family="sans-serif", font_size=13
        )

    def at(self, x: float, y: float) -> Point:
        return _MARGIN + (x - self.left) * _SCALE, _MARGIN / 2 + (self.top - y) * _SCALE

    def draw_arena(self, arena: Mapping[str, Any]) -> None:
        for wall in arena["walls"]:
            self._rectangle(wall, "#8a8a92")
        self._rectangle(arena["box"], "#b98a55")
        for name, (x, y, _) in arena["starts"].items():
            colour = "#c22" if name == "pioneer" else "#36a"
            self.canvas.circle(self.at(x, y), 0.23 * _SCALE, fill="none", stroke=colour, stroke_dasharray="4 3")
            px, py = self.at(x, y)
            self.canvas.text((px, py - 0.23 * _SCALE - 5), f"{name} at first", text_anchor="middle", fill=colour)
        x, y = self.at(0.0, 0.0)
        self.canvas.line((x - 9, y), (x + 9, y), stroke="#111", stroke_width=2)
        self.canvas.line((x, y - 9), (x, y + 9), stroke="#111", stroke_width=2)
        self.canvas.text((x + 12, y + 18), "origin")

    def _rectangle(self, one: Mapping[str, float], fill: str) -> None:
        corner = self.at(one["x"] - one["half_x"], one["y"] + one["half_y"])
        self.canvas.rect(corner, 2 * one["half_x"] * _SCALE, 2 * one["half_y"] * _SCALE, fill=fill)

    def draw_legend(self, record: RunRecord) -> None:
        metrics, y = record.metrics, self.bottom + 16
        for colour, text, row in ((DELIBERATIVE, "deliberative route", 0), (REACTIVE, "reactive route", 1)):
            at = y + 20 * row
            self.canvas.line((_MARGIN, at), (_MARGIN + 36, at), stroke=colour, stroke_width=2.5)
            self.canvas.circle((_MARGIN + 18, at), 2.2, fill=colour)
            self.canvas.text((_MARGIN + 46, at + 4), text)
        self.canvas.rect((_MARGIN + 205, y - 5), 9, 9, fill="none", stroke=REACTIVE, stroke_width=1.8)
        self.canvas.text((_MARGIN + 222, y + 4), "change of route")
        self.canvas.text((_MARGIN + 205, y + 24), "dots: actions and commands")
        reached = f"reached in {metrics['time_s']:.1f} s" if metrics["reached_goal"] else "not reached"
        clearance = metrics["least_clearance_m"]
        text = (
            f"{record.manager}: {reached}, {metrics['path_length_m']:.2f} m driven, {metrics['collisions']} collisions"
        )
        text += "" if clearance is None else f", clearance at least {clearance:.2f} m"
        self.canvas.text((_MARGIN, y + 50), f"{text}; {metrics['route_switches']} changes of route")


def _stretches(rows: Sequence[Sequence[float]]) -> Iterator[tuple[list[Point], bool]]:
    """The trajectory, cut where the route changes; stretches share their ends."""
    points: list[Point] = []
    for number, row in enumerate(rows):
        points.append((row[0], row[1]))
        if number and row[3] != rows[number - 1][3]:
            yield points, bool(rows[number - 1][3])
            points = [(row[0], row[1])]
    if points:
        yield points, bool(rows[-1][3])


def _changes(record: RunRecord) -> Iterator[tuple[float, str]]:
    for event in record.events:
        if any(fact["fact"] in _CHANGES and not fact.get("from_reflex") for fact in event.facts):
            yield event.time_s, event.text


def _position(trajectory: Sequence[Sequence[float]], time: float) -> Point:
    """Where the robot was, between two samples."""
    for before, after in pairwise(trajectory):
        if before[0] <= time <= after[0]:
            part = (time - before[0]) / (after[0] - before[0])
            return before[1] + part * (after[1] - before[1]), before[2] + part * (after[2] - before[2])
    last = trajectory[-1]
    return last[1], last[2]
