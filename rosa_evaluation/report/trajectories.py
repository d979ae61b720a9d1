"""Trajectories seen from above: what is in the world, where the robot was, and what happened where."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rosa_evaluation.report.spec import Landmark, Mark, Point
from rosa_evaluation.report.style import GRID, INK, PALE, figure_canvas
from rosa_simulation.run_record import RunRecord
from task_layer.svg import Canvas, tooltip

_WIDTH, _MARGIN, _LINE = 760.0, 34.0, 18.0
_MOST_HEIGHT = 520.0
_LEAST_DISTANCE = 2.0
"""Pixels between two points of a line."""
_LANDMARK = "#b9a26a"
_MARKS = ("#e08a1e", "#3a9142", "#8a4fa3", "#c1272d", "#2a9aa5", "#1d2733")


@dataclass(frozen=True, slots=True)
class Trajectory:
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


def trajectory_of(record: RunRecord) -> Trajectory | None:
    """The trajectory of a run; None if its trajectory has no time, x and y."""
    columns = record.trajectory_columns
    if not record.trajectory or not {"time_s", "x_m", "y_m"} <= set(columns):
        return None
    time, x, y = (columns.index(name) for name in ("time_s", "x_m", "y_m"))
    rows = record.trajectory
    return Trajectory(tuple(row[time] for row in rows), tuple((row[x], row[y]) for row in rows))


@dataclass(frozen=True, slots=True)
class TrajectoryPlot:
    """The trajectories of several runs in one world.

    ``marks`` are those of every trajectory, in the same order; only of the first all are drawn.
    """

    landmarks: Sequence[Landmark]
    trajectories: Sequence[Trajectory]
    marks: Sequence[Sequence[Mark]]


def draw_trajectories(description: str, plot: TrajectoryPlot, stroke: str, kinds: Mapping[str, str]) -> str:
    """The landmarks, all trajectories, and upon the first one what happened.

    Args:
        description: for who cannot see the figure.
        plot: the runs of one managing system.
        stroke: the colour of the trajectories.
        kinds: a colour for each kind of mark.
    """
    points = [point for trajectory in plot.trajectories for point in trajectory.points]
    points += [point for landmark in plot.landmarks for point in landmark.points]
    frame = _Frame.around(points)
    canvas = figure_canvas(_WIDTH, frame.height + _LINE * 1.5, description)
    _draw_grid(canvas, frame)
    for landmark in plot.landmarks:
        _draw_landmark(canvas, frame, landmark)
    for trajectory in plot.trajectories[1:]:
        line = _thinned([frame.at(point) for point in trajectory.points], _LEAST_DISTANCE)
        canvas.polyline(line, stroke=stroke, stroke_width=1, stroke_opacity="0.3")
    line = _thinned([frame.at(point) for point in plot.trajectories[0].points], _LEAST_DISTANCE)
    canvas.polyline(line, stroke=stroke, stroke_width="2")
    canvas.text((line[0][0], line[0][1] - 8.0), "start", text_anchor="middle", fill=PALE, font_size=11)
    _draw_marks(canvas, frame, plot, kinds)
    for column, (kind, fill) in enumerate(kinds.items()):
        x, y = _MARGIN + 150.0 * column, frame.height + 8.0
        canvas.circle((x + 5.0, y - 4.0), 4.5, fill=fill, stroke="#ffffff")
        canvas.text((x + 14.0, y), kind)
    return canvas.document()


def mark_colours(all_marks: Sequence[Sequence[Mark]]) -> dict[str, str]:
    """A colour for each kind of mark, the same in every figure of a study."""
    kinds = sorted({mark.kind for marks in all_marks for mark in marks})
    return {kind: _MARKS[number % len(_MARKS)] for number, kind in enumerate(kinds)}


def _draw_marks(canvas: Canvas, frame: _Frame, plot: TrajectoryPlot, kinds: Mapping[str, str]) -> None:
    for number, (trajectory, marks) in reversed(list(enumerate(zip(plot.trajectories, plot.marks, strict=True)))):
        drawn = marks if number == 0 else [mark for mark in marks if mark.kind in _single_kinds(marks)]
        for mark in drawn:
            size, opacity = (5.0, "1") if number == 0 else (2.6, "0.5")
            dot = canvas.circle(
                frame.at(trajectory.at(mark.time_s)),
                size,
                fill=kinds[mark.kind],
                fill_opacity=opacity,
                stroke="#ffffff",
            )
            if number == 0:
                tooltip(dot, f"{mark.time_s:.0f} s: {mark.text}")


def _single_kinds(marks: Sequence[Mark]) -> set[str]:
    """The kinds of which there is one mark, such as what was looked for: these are drawn on every trajectory."""
    kinds = [mark.kind for mark in marks]
    return {kind for kind in kinds if kinds.count(kind) == 1}


@dataclass(frozen=True, slots=True)
class _Frame:
    """Metres to pixels, alike in both directions."""

    left: float
    top: float
    scale: float
    right: float
    bottom: float

    @classmethod
    def around(cls, points: Sequence[Point]) -> _Frame:
        xs, ys = [x for x, _ in points], [y for _, y in points]
        wide, high = max(max(xs) - min(xs), 1.0), max(max(ys) - min(ys), 1.0)
        scale = min((_WIDTH - 2.0 * _MARGIN) / wide, _MOST_HEIGHT / high)
        return cls(min(xs), max(ys), scale, min(xs) + wide, max(ys) - high)

    @property
    def height(self) -> float:
        return 2.0 * _MARGIN + (self.top - self.bottom) * self.scale

    def at(self, point: Point) -> Point:
        return _MARGIN + (point[0] - self.left) * self.scale, _MARGIN + (self.top - point[1]) * self.scale


def _draw_grid(canvas: Canvas, frame: _Frame) -> None:
    step = next((s for s in (1, 2, 5, 10, 20, 50, 100, 200, 500) if (frame.right - frame.left) / s <= 12.0), 1000)
    for number in range(int(frame.left // step) + 1, int(frame.right // step) + 1):
        x, _ = frame.at((number * step, 0.0))
        canvas.line((x, _MARGIN / 2.0), (x, frame.height - _MARGIN / 2.0), stroke=GRID)
        canvas.text((x, frame.height - 6.0), f"{number * step}", text_anchor="middle", fill=PALE, font_size=10)
    for number in range(int(frame.bottom // step) + 1, int(frame.top // step) + 1):
        _, y = frame.at((0.0, number * step))
        canvas.line((_MARGIN / 2.0, y), (_WIDTH - _MARGIN / 2.0, y), stroke=GRID)
        canvas.text((4.0, y - 3.0), f"{number * step}", fill=PALE, font_size=10)
    canvas.text((_WIDTH - 4.0, frame.height - 6.0), "m", text_anchor="end", fill=PALE, font_size=10)


def _draw_landmark(canvas: Canvas, frame: _Frame, landmark: Landmark) -> None:
    points = [frame.at(point) for point in landmark.points]
    if len(points) == 1:
        x, y = points[0]
        drawn = canvas.rect((x - 5.0, y - 5.0), 10.0, 10.0, fill=_LANDMARK, stroke=INK)
    else:
        x, y = points[len(points) // 2]
        drawn = canvas.polyline(points, stroke=_LANDMARK, stroke_width=9, stroke_linecap="round", stroke_opacity="0.75")
    tooltip(drawn, landmark.name)
    canvas.text((x, y + 24.0), landmark.name, text_anchor="middle", fill="#7d6a35", font_size=11)


def _thinned(points: Sequence[Point], distance: float) -> list[Point]:
    """The points without those that are closer than ``distance`` to the one before; the last one stays."""
    kept = list(points[:1])
    for point in points[1:]:
        if math.dist(kept[-1], point) >= distance:
            kept.append(point)
    return [*kept, points[-1]] if kept and kept[-1] != points[-1] else kept
