"""Draws the map with routes and the way that was driven, as SVG that stands on its own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from agv_example.corridors import FULL_LIGHT, Corridor, CorridorMap, Place
from task_layer.svg import Canvas, Point, drawing

WIDTH = 760.0
_MARGIN = 60.0
_LINE = 18.0
_MOST_LABELS = 60
_COLOURS = ("#1f6fb4", "#d9541e", "#3a9142", "#8a4fa3", "#b0892c", "#c23b6b")


@dataclass(frozen=True, slots=True)
class DrawnLeg:
    """One corridor of a route: from which place to which, and what is written beside it."""

    start: str
    end: str
    label: str = ""


@dataclass(frozen=True)
class DrawnRoute:
    """A route to be drawn.

    Args:
        title: what the legend calls it.
        legs: its corridors.
        planned: drawn with dashes; it was not driven to its end.
    """

    title: str
    legs: Sequence[DrawnLeg]
    planned: bool = False


@dataclass(frozen=True, slots=True)
class _MapCanvas:
    """A canvas for a map: metres to the right and upwards become pixels to the right and downwards."""

    corridors: CorridorMap
    canvas: Canvas
    left: float
    top: float
    scale: float
    height: float

    @property
    def labelled(self) -> bool:
        """Whether there is room for names."""
        return len(self.corridors.places) <= _MOST_LABELS

    def at(self, x: float, y: float) -> Point:
        return _MARGIN + (x - self.left) * self.scale, _MARGIN + (self.top - y) * self.scale

    def between(self, start: str, end: str) -> tuple[Point, Point]:
        """Two places, px."""
        one, other = self.corridors.place(start), self.corridors.place(end)
        return self.at(one.x, one.y), self.at(other.x, other.y)


def draw_map(
    corridors: CorridorMap,
    routes: Iterable[DrawnRoute] = (),
    trajectory: Iterable[Point] = (),
    *,
    marks: Mapping[str, Point] | None = None,
) -> str:
    """The map as SVG: dark corridors are drawn dark, closed ones crossed, obstacles as squares.

    Args:
        corridors: the map.
        routes: drawn next to each other, each in a colour of its own.
        trajectory: where the robot was, m.
        marks: points of interest by their labels, m.
    """
    drawn = list(routes)
    view = _map_canvas(corridors, len(drawn))
    for corridor in corridors.corridors:
        _draw_corridor(view, corridor)
    for number, route in enumerate(drawn):
        _draw_route(view, route, number)
    points = [view.at(*point) for point in trajectory]
    if points:
        view.canvas.polyline(points, stroke="#111", stroke_width=1.2)
    for place in corridors.places:
        x, y = view.at(place.x, place.y)
        view.canvas.circle((x, y), 9 if view.labelled else 3, fill="#fff", stroke="#333")
        if view.labelled:
            view.canvas.text((x, y + 4), place.name, text_anchor="middle", font_size=10)
    for label, where in (marks or {}).items():
        x, y = view.at(*where)
        view.canvas.circle((x, y), 6, fill="none", stroke="#c00", stroke_width=2.5)
        view.canvas.text((x, y - 12), label, text_anchor="middle", fill="#c00", font_weight="bold")
    _draw_legend(view, drawn)
    return view.canvas.document(indented=True)


def draw_run(
    inputs: Mapping[str, Any], facts: Iterable[Mapping[str, Any]], trajectory: Iterable[Sequence[float]] = ()
) -> str:
    """A run of the scenario ``agv``: the map, every route that was decided on, where it was dropped and why.

    Args:
        inputs: what the run was made of: ``record.inputs``, or ``inputs`` in ``run.json``.
        facts: the facts of all its events, in order.
        trajectory: its rows.
    """
    corridors = map_from_inputs(inputs["map"])
    routes: list[DrawnRoute] = []
    marks: dict[str, Point] = {}
    cause = ""
    rows = list(trajectory)
    for fact in facts:
        if fact["fact"] in _REASONS:
            cause = f"{fact.get('subject', '')} {_REASONS[fact['fact']]}"
        if fact["fact"] != "route" or fact["legs"] is None:
            continue
        if routes:
            marks.setdefault(cause, _point(corridors, str(fact["start"])))
            routes[-1] = DrawnRoute(routes[-1].title, routes[-1].legs, planned=True)
        legs = [DrawnLeg(leg["start"], leg["end"], leg["configuration"]) for leg in fact["legs"]]
        energy, time = (sum(leg[figure] for leg in fact["legs"]) for figure in ("energy", "time_s"))
        title = f"to {fact['goal']}{f', as {cause}' if routes else ''}: energy {energy:.0f}, {time:.0f} s"
        routes.append(DrawnRoute(title, legs))
    return draw_map(corridors, routes, [(row[1], row[2]) for row in rows], marks=marks)


def map_from_inputs(document: Mapping[str, Any]) -> CorridorMap:
    """The map of a run record, measured drives left out.

    Raises:
        InputError: if it is none.
    """
    places = tuple(Place(name, x, y) for name, (x, y) in document["places"].items())
    corridors = tuple(
        Corridor(**{key: value for key, value in corridor.items() if key != "surveys"})
        for corridor in document["corridors"]
    )
    return CorridorMap(places, corridors, document["name"])


_REASONS = {
    "component failed": "failed",
    "component recovered": "works again",
    "corridor closed": "is closed",
    "corridor opened": "is open again",
    "light changed": "changed its light",
}


def _point(corridors: CorridorMap, start: str) -> Point:
    """Where a route began, from its description: a place, or ``8.8 m into C1 from A``."""
    if start in corridors.place_index:
        place = corridors.place(start)
        return place.x, place.y
    metres, _, rest = start.partition(" m into ")
    name, _, origin = rest.rpartition(" from ")
    corridor = corridors.corridor(name)
    one, other = corridors.place(origin), corridors.place(corridor.other_end(origin))
    part = float(metres) / corridor.length
    return one.x + part * (other.x - one.x), one.y + part * (other.y - one.y)


def _map_canvas(corridors: CorridorMap, routes: int) -> _MapCanvas:
    places = corridors.places
    left, right = min(p.x for p in places), max(p.x for p in places)
    bottom, top = min(p.y for p in places), max(p.y for p in places)
    scale = (WIDTH - 2 * _MARGIN) / max(right - left, (top - bottom) / 1.5, 1e-9)
    height = (top - bottom) * scale + 2 * _MARGIN + _LINE * (routes + 1)
    canvas = drawing(WIDTH, height, font_family="sans-serif", font_size=12)
    return _MapCanvas(corridors, canvas, left, top, scale, height)


def _draw_corridor(view: _MapCanvas, corridor: Corridor) -> None:
    ends = view.between(corridor.start, corridor.end)
    grey = int(120 + 110 * corridor.light / FULL_LIGHT)
    width = 22 if view.labelled else 4
    view.canvas.line(*ends, stroke=f"rgb({grey},{grey},{grey})", stroke_width=width, stroke_linecap="round")
    if not view.labelled:
        return
    for number in range(corridor.obstacles):
        x, y = _between(*ends, (number + 1) / (corridor.obstacles + 1))
        view.canvas.rect((x - 4, y - 4), 8, 8, fill="#7a4b2a")
    middle = _between(*ends, 0.5)
    if corridor.closed:
        view.canvas.text((middle[0], middle[1] + 7), "✕", text_anchor="middle", font_size=22, fill="#c00")
    label = [corridor.name]
    if corridor.speed_limit is not None:
        label.append(f"max {corridor.speed_limit:g} m/s")
    if corridor.light < FULL_LIGHT:
        label.append(f"light {corridor.light:g}")
    _draw_label(view.canvas, ends, ", ".join(label), -1, "#555")


def _draw_route(view: _MapCanvas, route: DrawnRoute, number: int) -> None:
    """Routes share a corridor: each is shifted a little to its right."""
    style = _route_style(route, number)
    for leg in route.legs:
        if leg.start == leg.end:
            continue
        ends = view.between(leg.start, leg.end)
        start, end = _shifted(*ends, 3.0 + 3.0 * (number % 3))
        view.canvas.line(start, end, **style)
        if view.labelled and leg.label:
            _draw_label(view.canvas, ends, leg.label, number % 3, _colour(number))


def _route_style(route: DrawnRoute, number: int) -> dict[str, str | float]:
    dashes: dict[str, str | float] = {"stroke_dasharray": "7 5"} if route.planned else {}
    return {"stroke": _colour(number), "stroke_width": 3, **dashes}


def _colour(number: int) -> str:
    return _COLOURS[number % len(_COLOURS)]


def _draw_label(canvas: Canvas, ends: tuple[Point, Point], text: str, row: int, fill: str) -> None:
    """Text at a corridor: its name in row -1, above or on top; below that a row for each route."""
    x, y = _between(*ends, 0.5)
    if abs(ends[0][1] - ends[1][1]) <= abs(ends[0][0] - ends[1][0]):
        at, anchor = (x, y - 18 if row < 0 else y + 26 + 14 * row), "middle"
    elif x > WIDTH / 2:
        at, anchor = (x - 18, y + 14 * row), "end"
    else:
        at, anchor = (x + 18, y + 14 * row), "start"
    canvas.text(at, text, fill=fill, font_size=11, text_anchor=anchor)


def _draw_legend(view: _MapCanvas, routes: Sequence[DrawnRoute]) -> None:
    y = view.height - _LINE * (len(routes) + 0.5)
    for number, route in enumerate(routes):
        view.canvas.line((_MARGIN, y), (_MARGIN + 40, y), **_route_style(route, number))
        view.canvas.text((_MARGIN + 50, y + 4), route.title)
        y += _LINE


def _between(one: Point, other: Point, part: float) -> Point:
    return one[0] + part * (other[0] - one[0]), one[1] + part * (other[1] - one[1])


def _shifted(one: Point, other: Point, pixels: float) -> tuple[Point, Point]:
    dx, dy = other[0] - one[0], other[1] - one[1]
    length = (dx * dx + dy * dy) ** 0.5 or 1.0
    x, y = -dy / length * pixels, dx / length * pixels
    return (one[0] + x, one[1] + y), (other[0] + x, other[1] + y)
