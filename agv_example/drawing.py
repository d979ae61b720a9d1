"""Draws the map with routes and the way that was driven, as SVG that stands on its own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Any

from agv_example.corridors import FULL_LIGHT, Corridor, CorridorMap, Place

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


@dataclass
class _Paper:
    """Where things come to lie: metres to the right and upwards become pixels to the right and downwards."""

    left: float
    top: float
    scale: float
    height: float
    parts: list[str] = field(default_factory=list)

    def at(self, x: float, y: float) -> tuple[float, float]:
        return _MARGIN + (x - self.left) * self.scale, _MARGIN + (self.top - y) * self.scale

    def line(self, one: tuple[float, float], other: tuple[float, float], style: str) -> None:
        (x1, y1), (x2, y2) = one, other
        self.parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" {style}/>')

    def text(self, where: tuple[float, float], text: str, style: str = "") -> None:
        x, y = where
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" {style}>{escape(text)}</text>')


def draw_map(
    corridors: CorridorMap,
    routes: Iterable[DrawnRoute] = (),
    trajectory: Iterable[tuple[float, float]] = (),
    *,
    marks: Mapping[str, tuple[float, float]] | None = None,
) -> str:
    """The map as SVG: dark corridors are drawn dark, closed ones crossed, obstacles as squares.

    Args:
        corridors: the map.
        routes: drawn beside one another, each in a colour of its own.
        trajectory: where the robot was, m.
        marks: points of interest by their labels, m.
    """
    drawn = list(routes)
    paper = _paper(corridors.places, len(drawn))
    many = len(corridors.places) > _MOST_LABELS
    for corridor in corridors.corridors:
        _draw_corridor(paper, corridors, corridor, labelled=not many)
    for number, route in enumerate(drawn):
        _draw_route(paper, corridors, route, number, labelled=not many)
    _draw_trajectory(paper, trajectory)
    for place in corridors.places:
        x, y = paper.at(place.x, place.y)
        paper.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{3 if many else 9}" fill="#fff" stroke="#333"/>')
        if not many:
            paper.text((x, y + 4), place.name, 'text-anchor="middle" font-size="10"')
    for label, where in (marks or {}).items():
        x, y = paper.at(*where)
        paper.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="6" fill="none" stroke="#c00" stroke-width="2.5"/>')
        paper.text((x, y - 12), label, 'text-anchor="middle" fill="#c00" font-weight="bold"')
    _draw_legend(paper, drawn)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:.0f} {paper.height:.0f}" '
        'font-family="sans-serif" font-size="12">'
    )
    return "\n".join((head, '<rect width="100%" height="100%" fill="#fff"/>', *paper.parts, "</svg>")) + "\n"


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
    marks: dict[str, tuple[float, float]] = {}
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
    """The map of a run record, surveys left out.

    Raises:
        InputError: if it is none.
    """
    places = tuple(Place(name, x, y) for name, (x, y) in document["places"].items())
    corridors = tuple(Corridor(**{**corridor, "surveys": {}}) for corridor in document["corridors"])
    return CorridorMap(places, corridors, document["name"])


_REASONS = {
    "component failed": "failed",
    "component recovered": "works again",
    "corridor closed": "is closed",
    "corridor opened": "is open again",
    "light changed": "changed its light",
}


def _point(corridors: CorridorMap, start: str) -> tuple[float, float]:
    """Where a route began, from how it is told: a place, or ``8.8 m into C1 from A``."""
    if start in corridors.place_index:
        place = corridors.place(start)
        return place.x, place.y
    metres, _, rest = start.partition(" m into ")
    name, _, origin = rest.rpartition(" from ")
    corridor = corridors.corridor(name)
    one, other = corridors.place(origin), corridors.place(corridor.other_end(origin))
    part = float(metres) / corridor.length
    return one.x + part * (other.x - one.x), one.y + part * (other.y - one.y)


def _paper(places: Sequence[Place], routes: int) -> _Paper:
    left, right = min(p.x for p in places), max(p.x for p in places)
    bottom, top = min(p.y for p in places), max(p.y for p in places)
    scale = (WIDTH - 2 * _MARGIN) / max(right - left, (top - bottom) / 1.5, 1e-9)
    height = (top - bottom) * scale + 2 * _MARGIN + _LINE * (routes + 1)
    return _Paper(left, top, scale, height)


def _draw_corridor(paper: _Paper, corridors: CorridorMap, corridor: Corridor, *, labelled: bool) -> None:
    one, other = (corridors.place(name) for name in (corridor.start, corridor.end))
    ends = paper.at(one.x, one.y), paper.at(other.x, other.y)
    grey = int(120 + 110 * corridor.light / FULL_LIGHT)
    thick = 22 if labelled else 4
    paper.line(*ends, f'stroke="rgb({grey},{grey},{grey})" stroke-width="{thick}" stroke-linecap="round"')
    if not labelled:
        return
    for number in range(corridor.obstacles):
        x, y = _between(*ends, (number + 1) / (corridor.obstacles + 1))
        paper.parts.append(f'<rect x="{x - 4:.1f}" y="{y - 4:.1f}" width="8" height="8" fill="#7a4b2a"/>')
    middle = _between(*ends, 0.5)
    if corridor.closed:
        paper.text((middle[0], middle[1] + 7), "✕", 'text-anchor="middle" font-size="22" fill="#c00"')
    told = [corridor.name]
    if corridor.speed_limit is not None:
        told.append(f"max {corridor.speed_limit:g} m/s")
    if corridor.light < FULL_LIGHT:
        told.append(f"light {corridor.light:g}")
    _beside(paper, ends, ", ".join(told), -1, "#555")


def _draw_route(paper: _Paper, corridors: CorridorMap, route: DrawnRoute, number: int, *, labelled: bool) -> None:
    """Routes lie side by side in a corridor: each is shifted a little to its right."""
    colour = _COLOURS[number % len(_COLOURS)]
    dashes = ' stroke-dasharray="7 5"' if route.planned else ""
    for leg in route.legs:
        if leg.start == leg.end:
            continue
        one, other = (corridors.place(name) for name in (leg.start, leg.end))
        ends = paper.at(one.x, one.y), paper.at(other.x, other.y)
        shift = 3.0 + 3.0 * (number % 3)
        start, end = _shifted(*ends, shift)
        paper.line(start, end, f'stroke="{colour}" stroke-width="3"{dashes}')
        if labelled and leg.label:
            _beside(paper, ends, leg.label, number % 3, colour)


def _beside(
    paper: _Paper, ends: tuple[tuple[float, float], tuple[float, float]], text: str, row: int, fill: str
) -> None:
    """Text beside a corridor: its name in row -1, above or on top; below that a row for each route."""
    x, y = _between(*ends, 0.5)
    style = f'fill="{fill}" font-size="11"'
    if abs(ends[0][1] - ends[1][1]) <= abs(ends[0][0] - ends[1][0]):
        paper.text((x, y - 18 if row < 0 else y + 26 + 14 * row), text, f'{style} text-anchor="middle"')
    elif x > WIDTH / 2:
        paper.text((x - 18, y + 14 * row), text, f'{style} text-anchor="end"')
    else:
        paper.text((x + 18, y + 14 * row), text, style)


def _draw_trajectory(paper: _Paper, trajectory: Iterable[tuple[float, float]]) -> None:
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in (paper.at(*point) for point in trajectory))
    if points:
        paper.parts.append(f'<polyline points="{points}" fill="none" stroke="#111" stroke-width="1.2"/>')


def _draw_legend(paper: _Paper, routes: Sequence[DrawnRoute]) -> None:
    y = paper.height - _LINE * (len(routes) + 0.5)
    for number, route in enumerate(routes):
        dashes = ' stroke-dasharray="7 5"' if route.planned else ""
        colour = _COLOURS[number % len(_COLOURS)]
        paper.line((_MARGIN, y), (_MARGIN + 40, y), f'stroke="{colour}" stroke-width="3"{dashes}')
        paper.text((_MARGIN + 50, y + 4), route.title)
        y += _LINE


def _between(one: tuple[float, float], other: tuple[float, float], part: float) -> tuple[float, float]:
    return one[0] + part * (other[0] - one[0]), one[1] + part * (other[1] - one[1])


def _shifted(
    one: tuple[float, float], other: tuple[float, float], pixels: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    dx, dy = other[0] - one[0], other[1] - one[1]
    length = (dx * dx + dy * dy) ** 0.5 or 1.0
    x, y = -dy / length * pixels, dx / length * pixels
    return (one[0] + x, one[1] + y), (other[0] + x, other[1] + y)
