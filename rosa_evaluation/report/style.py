"""How the figures of a report look: their canvas, colours and marks, and how durations are written."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from task_layer.svg import Canvas, Point, drawing

INK, PALE, GRID = "#1d2733", "#66727f", "#dfe4e9"
_COLOURS = (
    "#2f6db5",
    "#d9731a",
    "#3a9142",
    "#8a4fa3",
    "#b8892b",
    "#c23b6b",
    "#2a9aa5",
    "#7a5a3c",
    "#5b6b7b",
    "#94a11f",
)


def colour(number: int) -> str:
    """One of ten colours that are easy to distinguish; they repeat."""
    return _COLOURS[number % len(_COLOURS)]


def figure_canvas(width: float, height: float, description: str) -> Canvas:
    """An empty figure of a size in pixels.

    Args:
        width: of the figure, px.
        height: of the figure, px.
        description: what a reader who cannot see the figure is given to read.
    """
    font = "system-ui, 'Segoe UI', Roboto, Helvetica, Arial, sans-serif"
    return drawing(width, height, description=description, ink=INK, font_family=font, font_size=12)


def diamond(canvas: Canvas, centre: Point, size: float, **style: str | float) -> Element:
    """A diamond.

    Args:
        canvas: to draw on.
        centre: (x, y) in px.
        size: half its diagonal, px.
        style: attributes of the SVG element, as of :class:`~task_layer.svg.Canvas`.
    """
    x, y = centre
    return canvas.polygon(((x, y - size), (x + size, y), (x, y + size), (x - size, y)), **style)


def format_duration(seconds: float) -> str:
    """A duration in the unit that suits its size."""
    for limit, factor, unit in ((1e-3, 1e6, "µs"), (1.0, 1e3, "ms")):
        if abs(seconds) < limit:
            return f"{seconds * factor:.3g} {unit}"
    return f"{seconds:.3g} s" if seconds < 1000 else f"{seconds:.0f} s"
