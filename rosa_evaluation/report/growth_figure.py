"""How much there is to model, by number of adaptations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rosa_evaluation.effort import Growth
from rosa_evaluation.report.scale import Scale
from rosa_evaluation.report.style import GRID, PALE, colour, figure_canvas
from task_layer.svg import Canvas, tooltip

_WIDTH, _HEIGHT, _LEFT, _RIGHT, _TOP, _BOTTOM = 760.0, 330.0, 60.0, 190.0, 20.0, 280.0


def draw_growth(growths: Sequence[Growth]) -> str:
    """A line for each approach and kind of adaptation, with a point for every system that was counted."""
    lines = [
        (f"{growth.approach}, {sort}", number, dashes, {0: growth.base, **totals})
        for number, growth in enumerate(growths)
        for sort, dashes, totals in (
            ("structural", "none", growth.structural),
            ("parameter", "5 4", growth.parameter),
        )
    ]
    canvas = figure_canvas(_WIDTH, _HEIGHT, "elements to be modelled, by number of adaptations")
    most = max(max(totals) for *_, totals in lines)
    across = Scale.over([most], _LEFT, _WIDTH - _RIGHT)
    up = Scale.over([max(max(totals.values()) for *_, totals in lines)], _BOTTOM, _TOP)
    for tick in up.ticks():
        canvas.line((_LEFT, up(tick)), (_WIDTH - _RIGHT, up(tick)), stroke=GRID)
        canvas.text((_LEFT - 8.0, up(tick) + 4.0), f"{tick:g}", text_anchor="end", fill=PALE, font_size=11)
    for tick in across.ticks():
        canvas.text((across(tick), _BOTTOM + 17.0), f"{tick:g}", text_anchor="middle", fill=PALE, font_size=11)
    canvas.text(((_LEFT + _WIDTH - _RIGHT) / 2.0, _BOTTOM + 38.0), "adaptations of one action", text_anchor="middle")
    ends = _apart([up(totals[max(totals)]) for *_, totals in lines])
    for (name, number, dashes, totals), y in zip(lines, ends, strict=True):
        _draw_line(canvas, across, up, totals, colour(number), dashes)
        canvas.text((_WIDTH - _RIGHT + 14.0, y + 4.0), name, fill=colour(number), font_size=11)
    return canvas.document()


def _draw_line(canvas: Canvas, across: Scale, up: Scale, totals: Mapping[int, int], stroke: str, dashes: str) -> None:
    points = [(across(number), up(total)) for number, total in totals.items()]
    canvas.polyline(points, stroke=stroke, stroke_width=2, stroke_dasharray=dashes)
    for point, (number, total) in zip(points, totals.items(), strict=True):
        tooltip(canvas.circle(point, 3.0, fill=stroke), f"{number} adaptations: {total} elements")


def _apart(heights: Sequence[float]) -> list[float]:
    """Heights for labels, moved until none covers another."""
    placed: dict[int, float] = {}
    for index in sorted(range(len(heights)), key=lambda index: heights[index]):
        placed[index] = max(heights[index], *(y + 14.0 for y in placed.values()), 0.0)
    return [placed[index] for index in range(len(heights))]
