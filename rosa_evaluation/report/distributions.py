"""Figures of distributions: every value as a point, and a box over them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rosa_evaluation.report.scale import Scale
from rosa_evaluation.report.style import GRID, INK, PALE, diamond, figure_canvas, format_duration
from task_layer.svg import Canvas, tooltip

_WIDTH, _LEFT, _RIGHT, _TOP, _ROW = 760.0, 170.0, 24.0, 30.0, 46.0
_GOLDEN = 0.6180339887498949
_MOST_POINTS = 400
"""More points in a row are a smear that makes the file large; the box is of all of them."""


@dataclass(frozen=True, slots=True)
class PublishedPoint:
    """A published mean with its standard deviation."""

    mean: float
    sd: float | None
    source: str


def draw_distributions(
    what: str,
    samples: Mapping[str, Sequence[float]],
    published: Mapping[str, Sequence[PublishedPoint]],
    colours: Mapping[str, str],
    *,
    logarithmic: bool = False,
) -> str:
    """A row for each sample: its points, quartiles, median (line) and mean (diamond); published means are hollow.

    Args:
        what: the measure with its unit, written below the axis.
        samples: by their labels; those without values keep an empty row.
        published: what is shown with a sample, by the same labels.
        colours: of the samples, by the same labels.
        logarithmic: for positive values over several orders of magnitude, in s.
    """
    values = [value for sample in samples.values() for value in sample if value > 0.0 or not logarithmic]
    means = [point.mean for label in samples for point in published.get(label, ())]
    bottom = _TOP + _ROW * len(samples)
    canvas = figure_canvas(_WIDTH, bottom + 46.0, f"distributions of {what}")
    make = Scale.over_decades if logarithmic else Scale.over
    scale = make([*values, *means] or [1.0], _LEFT, _WIDTH - _RIGHT)
    draw_axis(canvas, scale, _TOP - 8.0, bottom, what)
    for row, (label, sample) in enumerate(samples.items()):
        middle = _TOP + _ROW * (row + 0.5)
        canvas.text((_LEFT - 14.0, middle + 4.0), label, text_anchor="end", font_weight="600")
        if len(sample):
            _draw_points(canvas, scale, sample, middle, colours[label])
            _draw_box(canvas, scale, sample, middle, colours[label])
        for point in published.get(label, ()):
            _draw_published(canvas, scale, point, middle + 15.0)
    return canvas.document()


def draw_axis(canvas: Canvas, scale: Scale, top: float, bottom: float, what: str) -> None:
    """An axis below, with lines up to the top.

    Args:
        canvas: what is drawn on.
        scale: of the values.
        top: where the lines end, px.
        bottom: where the axis is, px.
        what: its title.
    """
    written: Callable[[float], str] = format_duration if scale.logarithmic else "{:g}".format
    for tick in scale.ticks():
        x = scale(tick)
        canvas.line((x, top), (x, bottom), stroke=GRID)
        canvas.text((x, bottom + 17.0), written(round(tick, 12)), text_anchor="middle", fill=PALE, font_size=11)
    canvas.line((scale.start, bottom), (scale.end, bottom), stroke=PALE)
    canvas.text(((scale.start + scale.end) / 2.0, bottom + 37.0), what, text_anchor="middle")


def _draw_points(canvas: Canvas, scale: Scale, sample: Sequence[float], middle: float, fill: str) -> None:
    step = max(1, -(-len(sample) // _MOST_POINTS))
    for number, value in enumerate(sorted(sample)[::step]):
        # Values that follow one another are drawn far apart, the same way every time.
        offset = ((number * _GOLDEN) % 1.0 - 0.5) * 20.0
        canvas.circle((scale(value), middle + offset), 2.2, fill=fill, fill_opacity="0.38")


def _draw_box(canvas: Canvas, scale: Scale, sample: Sequence[float], middle: float, stroke: str) -> None:
    import numpy as np

    lower, median, upper = (float(q) for q in np.quantile(sample, (0.25, 0.5, 0.75)))
    reach = 1.5 * (upper - lower)
    inside = [value for value in sample if lower - reach <= value <= upper + reach]
    for end, whisker in ((lower, min(inside)), (upper, max(inside))):
        canvas.line((scale(end), middle), (scale(whisker), middle), stroke=INK)
        canvas.line((scale(whisker), middle - 5.0), (scale(whisker), middle + 5.0), stroke=INK)
    left, right = scale(lower), scale(upper)
    box = canvas.rect(
        (left, middle - 10.0),
        max(right - left, 1.0),
        20.0,
        fill=stroke,
        fill_opacity="0.18",
        stroke=INK,
        stroke_width=1,
    )
    tooltip(box, f"n = {len(sample)}, median {median:.4g}, quartiles {lower:.4g} and {upper:.4g}")
    canvas.line((scale(median), middle - 10.0), (scale(median), middle + 10.0), stroke=INK, stroke_width="2.2")
    mean = float(np.mean(sample))
    tooltip(diamond(canvas, (scale(mean), middle), 5.0, fill=INK), f"mean {mean:.4g}")


def _draw_published(canvas: Canvas, scale: Scale, point: PublishedPoint, y: float) -> None:
    if point.sd is not None:
        ends = (scale(point.mean - point.sd), y), (scale(point.mean + point.sd), y)
        canvas.line(*ends, stroke=PALE, stroke_dasharray="3 2")
    figures = f"{point.mean:g}" if point.sd is None else f"{point.mean:g} ({point.sd:g})"
    mark = diamond(canvas, (scale(point.mean), y), 4.5, fill="#ffffff", stroke=PALE, stroke_width="1.4")
    tooltip(mark, f"published: {figures}, {point.source}")
