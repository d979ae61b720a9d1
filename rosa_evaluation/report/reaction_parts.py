"""Reaction times in their two parts: what the robot waited, and what the managing system computed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import fmean

from rosa_evaluation.report.distributions import draw_axis
from rosa_evaluation.report.scale import Scale
from rosa_evaluation.report.studies import Study, TimedReaction
from rosa_evaluation.report.style import PALE, figure_canvas, format_duration
from task_layer.svg import Canvas, tooltip

DELAY, COMPUTE = "#2f6db5", "#d9731a"
_WIDTH, _LEFT, _RIGHT, _TOP, _ROW = 760.0, 230.0, 24.0, 40.0, 24.0


@dataclass(frozen=True, slots=True)
class Parts:
    """The reactions of a group to an uncertainty, s; the parts are empty for other people's."""

    uncertainty: str
    group: str
    totals: tuple[float, ...]
    delays: tuple[float, ...]
    computes: tuple[float, ...]

    @property
    def means(self) -> tuple[float, float | None, float | None]:
        """Mean total, delay and computing."""
        return fmean(self.totals), _mean(self.delays), _mean(self.computes)


def reaction_parts(study: Study) -> list[Parts]:
    """All reactions by uncertainty and group, of those groups that reacted."""
    return list(_parts(study))


def _parts(study: Study) -> Iterator[Parts]:
    for uncertainty in study.uncertainties:
        for group in study.groups:
            reactions: Sequence[TimedReaction] = group.reactions(uncertainty)
            if reactions:
                yield Parts(
                    uncertainty,
                    group.label,
                    tuple(r.total_s for r in reactions),
                    tuple(r.delay_s for r in reactions if r.delay_s is not None),
                    tuple(r.compute_s for r in reactions if r.compute_s is not None),
                )


def draw_reaction_parts(parts: Sequence[Parts]) -> str:
    """Delay and computing of each group and uncertainty: the median, and a line from the 5th to the 95th percentile."""
    values = [value for part in parts for value in (*part.delays, *part.computes) if value > 0.0]
    bottom = _TOP + _ROW * len(parts)
    canvas = figure_canvas(_WIDTH, bottom + 46.0, "reaction times, split into simulated delay and computing")
    scale = Scale.over_decades(values or [1.0], _LEFT, _WIDTH - _RIGHT)
    draw_axis(canvas, scale, _TOP - 6.0, bottom, "median, and from the 5th to the 95th percentile")
    for x, fill, part_name in ((_LEFT, DELAY, "simulated delay"), (_LEFT + 140.0, COMPUTE, "time of computing")):
        canvas.circle((x, 16.0), 5.0, fill=fill)
        canvas.text((x + 10.0, 20.0), part_name)
    before = ""
    for row, part in enumerate(parts):
        y = _TOP + _ROW * (row + 0.5)
        if part.uncertainty != before:
            before = part.uncertainty
            canvas.text((12.0, y + 4.0), part.uncertainty, font_weight="700")
            canvas.line((12.0, y - _ROW / 2.0), (_WIDTH - _RIGHT, y - _ROW / 2.0), stroke=PALE, stroke_width="0.6")
        canvas.text((_LEFT - 14.0, y + 4.0), part.group, text_anchor="end")
        _draw_range(canvas, scale, part.delays, y - 4.0, DELAY)
        _draw_range(canvas, scale, part.computes, y + 4.0, COMPUTE)
    return canvas.document()


def _draw_range(canvas: Canvas, scale: Scale, values: Sequence[float], y: float, fill: str) -> None:
    if not values:
        return
    import numpy as np

    low, median, high = (float(q) for q in np.quantile(values, (0.05, 0.5, 0.95)))
    canvas.line((scale(low), y), (scale(high), y), stroke=fill, stroke_width=2)
    tooltip(
        canvas.circle((scale(median), y), 4.0, fill=fill),
        f"{format_duration(median)} ({format_duration(low)} to {format_duration(high)})",
    )


def _mean(values: Sequence[float]) -> float | None:
    return fmean(values) if values else None
