"""What was active when in a run, what was measured meanwhile, and what happened."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rosa_evaluation.report.scale import Scale
from rosa_evaluation.report.spec import Mark
from rosa_evaluation.report.style import GRID, PALE, colour, figure_canvas
from rosa_simulation.run_record import MissionEvent, RunRecord
from task_layer.svg import Canvas, tooltip

_WIDTH, _LEFT, _RIGHT, _TOP = 760.0, 190.0, 20.0, 24.0
_LANE, _STRIP = 17.0, 44.0
_MOST_LANES = 16
_NOT_MEASURED = ("time_s", "x_m", "y_m", "yaw_rad")
_ACTION, _COMPONENT = colour(0), colour(2)


@dataclass(frozen=True, slots=True)
class Span:
    """Something lasted, from when to when, s."""

    lane: str
    is_action: bool
    start: float
    end: float


def spans_of(record: RunRecord) -> list[Span]:
    """When which action was required, and which component active; what did not end lasted until the run did."""
    running: dict[tuple[str, bool], float] = {}
    spans: list[Span] = []
    only_plans = not any(fact.get("fact") == "activated" for event in record.events for fact in event.facts)
    for event in record.events:
        for name, is_action, begins in _changes(event, only_plans=only_plans):
            if begins:
                running.setdefault((name, is_action), event.time_s)
            elif (name, is_action) in running:
                spans.append(Span(name, is_action, running.pop((name, is_action)), event.time_s))
    spans += [Span(*lane, start, record.duration_s) for lane, start in running.items()]
    return sorted(spans, key=lambda span: (not span.is_action, span.start, span.lane))


def _changes(event: MissionEvent, *, only_plans: bool) -> Iterator[tuple[str, bool, bool]]:
    """Name, whether it is an action, and whether it begins; what ends comes first."""
    for fact in event.facts:
        what = fact.get("fact")
        if what == "actions":
            yield from ((name, True, False) for name, _ in fact["ended"])
            yield from ((name, True, True) for name in fact["requested"])
        elif what in ("activated", "deactivated") and "subject" in fact:
            yield fact["subject"], False, what == "activated"
        elif what == "reconfiguration plan" and only_plans:
            yield from ((name, False, False) for name in fact["deactivate"])
            yield from ((name, False, True) for name in fact["activate"])


def draw_timeline(record: RunRecord, marks: Sequence[Mark]) -> str:
    """Lanes of actions and components, strips of what was measured, and a line for every mark.

    Args:
        record: of the run; times in s.
        marks: what happened in it.

    Returns:
        an SVG document.
    """
    spans = spans_of(record)
    lanes = list(dict.fromkeys((span.lane, span.is_action) for span in spans))[:_MOST_LANES]
    measured = _varying(record)
    strips_top = _TOP + _LANE * len(lanes) + 10.0
    bottom = strips_top + _STRIP * len(measured)
    canvas = figure_canvas(_WIDTH, bottom + 34.0, f"what happened when under {record.manager}, seed {record.seed}")
    scale = Scale(0.0, max(record.duration_s, 1.0), _LEFT, _WIDTH - _RIGHT)
    for tick in Scale.over([record.duration_s or 1.0], 0.0, 1.0).ticks():
        if tick <= scale.high:
            canvas.line((scale(tick), _TOP - 6.0), (scale(tick), bottom), stroke=GRID)
            canvas.text((scale(tick), bottom + 16.0), f"{tick:g}", text_anchor="middle", fill=PALE, font_size=11)
    canvas.text((_WIDTH - _RIGHT, bottom + 30.0), "s of mission time", text_anchor="end", fill=PALE, font_size=11)
    for mark in marks:
        x = scale(mark.time_s)
        line = canvas.line(
            (x, _TOP - 8.0), (x, bottom), stroke="#c23b6b", stroke_opacity="0.45", stroke_dasharray="2 3"
        )
        tooltip(line, f"{mark.time_s:.2f} s: {mark.text}")
        tooltip(canvas.circle((x, _TOP - 10.0), 3.6, fill="#c23b6b"), f"{mark.time_s:.2f} s: {mark.text}")
    _draw_lanes(canvas, scale, spans, lanes)
    for number, name in enumerate(measured):
        _draw_strip(canvas, scale, record, name, strips_top + _STRIP * number)
    return canvas.document()


def _varying(record: RunRecord) -> list[str]:
    """What was measured and did not stay the same."""
    columns = record.trajectory_columns
    if "time_s" not in columns:
        return []
    rows = record.trajectory
    return [
        name
        for column, name in enumerate(columns)
        if name not in _NOT_MEASURED and any(row[column] != rows[0][column] for row in rows)
    ]


def _draw_lanes(canvas: Canvas, scale: Scale, spans: Sequence[Span], lanes: Sequence[tuple[str, bool]]) -> None:
    for number, (name, is_action) in enumerate(lanes):
        y = _TOP + _LANE * number
        fill = _ACTION if is_action else _COMPONENT
        shown = name if len(name) < 30 else f"{name[:28]}…"
        canvas.text((_LEFT - 10.0, y + 12.0), shown, text_anchor="end", font_size=11, fill=fill)
        for span in spans:
            if (span.lane, span.is_action) == (name, is_action):
                x = scale(span.start)
                wide = max(scale(span.end) - x, 1.5)
                bar = canvas.rect((x, y + 2.0), wide, _LANE - 5.0, fill=fill, fill_opacity="0.8", rx=2)
                tooltip(bar, f"{name}: {span.start:.2f} s to {span.end:.2f} s")


def _draw_strip(canvas: Canvas, scale: Scale, record: RunRecord, name: str, top: float) -> None:
    time, column = (record.trajectory_columns.index(wanted) for wanted in ("time_s", name))
    values = [row[column] for row in record.trajectory]
    low, high = min(values, default=0.0), max(values, default=1.0)
    vertical = Scale(low, high if high > low else low + 1.0, top + _STRIP - 8.0, top + 4.0)
    canvas.text((_LEFT - 10.0, top + 20.0), name.replace("_", " "), text_anchor="end", font_size=11)
    canvas.text((_LEFT - 10.0, top + 34.0), f"{low:.3g} to {high:.3g}", text_anchor="end", font_size=10, fill=PALE)
    points = [(scale(row[time]), vertical(row[column])) for row in record.trajectory]
    canvas.polyline(points, stroke=PALE, stroke_width="1.4")
