"""Trajectories seen from above: what is in the world, where the robot was, and what happened where."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rosa_evaluation.report.spec import Landmark, Mark, Point
from rosa_evaluation.report.svg import GRID, INK, PALE, Sheet, hint, thinned
from rosa_simulation.run_record import RunRecord

_WIDTH, _MARGIN, _LINE = 760.0, 34.0, 18.0
_HIGHEST = 520.0
_APART = 2.0
"""Pixels between two points of a line."""
_LANDMARK = "#b9a26a"
_MARKS = ("#e08a1e", "#3a9142", "#8a4fa3", "#c1272d", "#2a9aa5", "#1d2733")


@dataclass(frozen=True, slots=True)
class Way:
    """Where a robot was: times in s, points (x, y) in m."""

    times: tuple[float, ...]
    points: tuple[Point, ...]

    def at(self, time: float) -> Point:
        """Where it was at a time, straight between two samples."""
        after = bisect_right(self.times, time)
        if after in (0, len(self.times)):
            return self.points[0 if after == 0 else -1]
        t0, t1 = self.times[after - 1 : after + 1]
        (x0, y0), (x1, y1) = self.points[after - 1 : after + 1]
        share = (time - t0) / (t1 - t0)
        return x0 + share * (x1 - x0), y0 + share * (y1 - y0)


def way_of(record: RunRecord) -> Way | None:
    """The way of a run; None if its trajectory has no time, x and y."""
    columns = record.trajectory_columns
    if not record.trajectory or not {"time_s", "x_m", "y_m"} <= set(columns):
        return None
    time, x, y = (columns.index(name) for name in ("time_s", "x_m", "y_m"))
    rows = record.trajectory
    return Way(tuple(row[time] for row in rows), tuple((row[x], row[y]) for row in rows))


@dataclass(frozen=True, slots=True)
class Ways:
    """The ways of several runs in one world; the first is the one that is told about.

    ``marks`` are those of every way, in the same order; only of the first all are drawn.
    """

    landmarks: Sequence[Landmark]
    ways: Sequence[Way]
    marks: Sequence[Sequence[Mark]]


def draw_ways(description: str, ways: Ways, stroke: str, kinds: Mapping[str, str]) -> str:
    """The landmarks, all ways, and upon the first one what happened.

    Args:
        description: for who cannot see the figure.
        ways: of one managing system.
        stroke: the colour of the ways.
        kinds: a colour for each kind of mark.
    """
    points = [point for way in ways.ways for point in way.points]
    points += [point for landmark in ways.landmarks for point in landmark.points]
    paper = _Paper.around(points)
    sheet = Sheet(_WIDTH, paper.height + _LINE * 1.5, description)
    _draw_grid(sheet, paper)
    for landmark in ways.landmarks:
        _draw_landmark(sheet, paper, landmark)
    for way in ways.ways[1:]:
        line = thinned([paper.at(point) for point in way.points], _APART)
        sheet.path(line, stroke=stroke, stroke_width=1, stroke_opacity="0.3")
    line = thinned([paper.at(point) for point in ways.ways[0].points], _APART)
    sheet.path(line, stroke=stroke, stroke_width="2")
    sheet.text((line[0][0], line[0][1] - 8.0), "start", anchor="middle", fill=PALE, font_size=11)
    _draw_marks(sheet, paper, ways, kinds)
    for column, (kind, fill) in enumerate(kinds.items()):
        x, y = _MARGIN + 150.0 * column, paper.height + 8.0
        sheet.circle((x + 5.0, y - 4.0), 4.5, fill=fill, stroke="#ffffff")
        sheet.text((x + 14.0, y), kind)
    return sheet.svg()


def kinds_of_marks(all_marks: Sequence[Sequence[Mark]]) -> dict[str, str]:
    """A colour for each kind of mark, the same in every figure of a study."""
    kinds = sorted({mark.kind for marks in all_marks for mark in marks})
    return {kind: _MARKS[number % len(_MARKS)] for number, kind in enumerate(kinds)}


def _draw_marks(sheet: Sheet, paper: _Paper, ways: Ways, kinds: Mapping[str, str]) -> None:
    for number, (way, marks) in reversed(list(enumerate(zip(ways.ways, ways.marks, strict=True)))):
        told = marks if number == 0 else [mark for mark in marks if mark.kind in _once(marks)]
        for mark in told:
            size, opacity = (5.0, "1") if number == 0 else (2.6, "0.5")
            dot = sheet.circle(
                paper.at(way.at(mark.time_s)), size, fill=kinds[mark.kind], fill_opacity=opacity, stroke="#ffffff"
            )
            if number == 0:
                hint(dot, f"{mark.time_s:.0f} s: {mark.text}")


def _once(marks: Sequence[Mark]) -> set[str]:
    """The kinds of which there is one mark, such as what was looked for: they tell something of many ways at once."""
    kinds = [mark.kind for mark in marks]
    return {kind for kind in kinds if kinds.count(kind) == 1}


@dataclass(frozen=True, slots=True)
class _Paper:
    """Metres to pixels, alike in both directions."""

    left: float
    top: float
    scale: float
    right: float
    bottom: float

    @classmethod
    def around(cls, points: Sequence[Point]) -> _Paper:
        xs, ys = [x for x, _ in points], [y for _, y in points]
        wide, deep = max(max(xs) - min(xs), 1.0), max(max(ys) - min(ys), 1.0)
        scale = min((_WIDTH - 2.0 * _MARGIN) / wide, _HIGHEST / deep)
        return cls(min(xs), max(ys), scale, min(xs) + wide, max(ys) - deep)

    @property
    def height(self) -> float:
        return 2.0 * _MARGIN + (self.top - self.bottom) * self.scale

    def at(self, point: Point) -> Point:
        return _MARGIN + (point[0] - self.left) * self.scale, _MARGIN + (self.top - point[1]) * self.scale


def _draw_grid(sheet: Sheet, paper: _Paper) -> None:
    step = next((s for s in (1, 2, 5, 10, 20, 50, 100, 200, 500) if (paper.right - paper.left) / s <= 12.0), 1000)
    for number in range(int(paper.left // step) + 1, int(paper.right // step) + 1):
        x, _ = paper.at((number * step, 0.0))
        sheet.line((x, _MARGIN / 2.0), (x, paper.height - _MARGIN / 2.0), stroke=GRID)
        sheet.text((x, paper.height - 6.0), f"{number * step}", anchor="middle", fill=PALE, font_size=10)
    for number in range(int(paper.bottom // step) + 1, int(paper.top // step) + 1):
        _, y = paper.at((0.0, number * step))
        sheet.line((_MARGIN / 2.0, y), (_WIDTH - _MARGIN / 2.0, y), stroke=GRID)
        sheet.text((4.0, y - 3.0), f"{number * step}", fill=PALE, font_size=10)
    sheet.text((_WIDTH - 4.0, paper.height - 6.0), "m", anchor="end", fill=PALE, font_size=10)


def _draw_landmark(sheet: Sheet, paper: _Paper, landmark: Landmark) -> None:
    points = [paper.at(point) for point in landmark.points]
    if len(points) == 1:
        x, y = points[0]
        drawn = sheet.rect((x - 5.0, y - 5.0), 10.0, 10.0, fill=_LANDMARK, stroke=INK)
    else:
        x, y = points[len(points) // 2]
        drawn = sheet.path(points, stroke=_LANDMARK, stroke_width=9, stroke_linecap="round", stroke_opacity="0.75")
    hint(drawn, landmark.name)
    sheet.text((x, y + 24.0), landmark.name, anchor="middle", fill="#7d6a35", font_size=11)
