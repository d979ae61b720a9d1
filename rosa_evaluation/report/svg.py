"""A sheet for figures: SVG that stands on its own, with every text escaped."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement, tostring

Point = tuple[float, float]

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
    """One of a few colours that can be told apart, again and again."""
    return _COLOURS[number % len(_COLOURS)]


class Sheet:
    """A drawing of a size in pixels, x to the right and y downwards.

    ``description`` is what a reader who cannot see the figure is told.
    """

    def __init__(self, width: float, height: float, description: str) -> None:
        self.width, self.height = width, height
        view = f"0 0 {_number(width)} {_number(height)}"
        self._svg = Element("svg", {"xmlns": "http://www.w3.org/2000/svg", "viewBox": view, "role": "img"})
        self._svg.set("font-family", "system-ui, 'Segoe UI', Roboto, Helvetica, Arial, sans-serif")
        self._svg.set("font-size", "12")
        self._svg.set("aria-label", description)
        self.rect((0.0, 0.0), width, height, fill="#ffffff")

    def line(self, one: Point, other: Point, **style: str | float) -> Element:
        """A straight line."""
        (x1, y1), (x2, y2) = one, other
        return self._add("line", x1=x1, y1=y1, x2=x2, y2=y2, **{"stroke": INK, **style})

    def rect(self, at: Point, width: float, height: float, **style: str | float) -> Element:
        """A rectangle, by its upper left corner."""
        return self._add("rect", x=at[0], y=at[1], width=width, height=height, **style)

    def circle(self, at: Point, radius: float, **style: str | float) -> Element:
        """A circle."""
        return self._add("circle", cx=at[0], cy=at[1], r=radius, **style)

    def path(self, points: Iterable[Point], **style: str | float) -> Element:
        """A line through points."""
        told = " ".join(f"{_number(x)},{_number(y)}" for x, y in points)
        return self._add(
            "polyline", points=told, **{"fill": "none", "stroke": INK, "stroke-linejoin": "round", **style}
        )

    def diamond(self, at: Point, size: float, **style: str | float) -> Element:
        """A diamond."""
        (x, y), s = at, size
        points = f"{_number(x)},{_number(y - s)} {_number(x + s)},{_number(y)} {_number(x)},{_number(y + s)} "
        return self._add("polygon", points=points + f"{_number(x - s)},{_number(y)}", **style)

    def text(self, at: Point, text: str, **style: str | float) -> Element:
        """A line of text; ``anchor`` is start, middle or end."""
        if "anchor" in style:
            style["text-anchor"] = style.pop("anchor")
        element = self._add("text", x=at[0], y=at[1], **{"fill": INK, **style})
        element.text = printable(text)
        return element

    def svg(self) -> str:
        """The document."""
        return tostring(self._svg, encoding="unicode") + "\n"

    def _add(self, tag: str, **attributes: str | float) -> Element:
        told = {
            name.replace("_", "-"): value if isinstance(value, str) else _number(value)
            for name, value in attributes.items()
        }
        return SubElement(self._svg, tag, told)


def hint(element: Element, text: str) -> None:
    """What is shown while the pointer rests on an element."""
    SubElement(element, "title").text = printable(text)


def printable(text: str) -> str:
    """Without the characters that XML cannot hold, whoever wrote them into a record."""
    return "".join(sign if sign >= " " or sign in "\t\n" else "�" for sign in text if not "\ud800" <= sign <= "\udfff")


def _number(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")


@dataclass(frozen=True, slots=True)
class Scale:
    """Values to pixels, linearly or by their logarithm."""

    low: float
    high: float
    start: float
    end: float
    logarithmic: bool = False

    @classmethod
    def over(cls, values: Sequence[float], start: float, end: float) -> Scale:
        """Linear, from 0 or the least value, with round ends."""
        low, high = min(0.0, *values), max(values)
        step = _step(high - low or 1.0)
        return cls(math.floor(low / step) * step, max(math.ceil(high / step - 1e-9), 1) * step, start, end)

    @classmethod
    def over_decades(cls, values: Sequence[float], start: float, end: float) -> Scale:
        """Logarithmic, in whole decades around the values, which are positive."""
        low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)) + 1e-9)
        return cls(10.0**low, 10.0 ** max(high, low + 1), start, end, logarithmic=True)

    def __call__(self, value: float) -> float:
        """Where a value lies; at an end, if it is beyond it."""
        inside = min(max(value, self.low), self.high)
        if self.logarithmic:
            share = math.log(inside / self.low) / math.log(self.high / self.low)
        else:
            share = (inside - self.low) / (self.high - self.low)
        return self.start + share * (self.end - self.start)

    def ticks(self) -> list[float]:
        """Round values, to be written beside the axis."""
        if self.logarithmic:
            decades = round(math.log10(self.high / self.low))
            return [self.low * 10.0**power for power in range(decades + 1)]
        step = _step(self.high - self.low)
        return [self.low + number * step for number in range(round((self.high - self.low) / step) + 1)]


def _step(span: float) -> float:
    """A round distance between ticks, of which there are then five to ten."""
    power = 10.0 ** math.floor(math.log10(span / 5.0))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if span / (factor * power) <= 8.0)


def told_time(seconds: float) -> str:
    """A duration in the unit that suits its size."""
    for limit, factor, unit in ((1e-3, 1e6, "µs"), (1.0, 1e3, "ms")):
        if abs(seconds) < limit:
            return f"{seconds * factor:.3g} {unit}"
    return f"{seconds:.3g} s" if seconds < 1000 else f"{seconds:.0f} s"


def thinned(points: Sequence[Point], distance: float) -> list[Point]:
    """The points without those that are closer than ``distance`` to the one before; the last one stays."""
    kept = list(points[:1])
    for point in points[1:]:
        if math.dist(kept[-1], point) >= distance:
            kept.append(point)
    return [*kept, points[-1]] if kept and kept[-1] != points[-1] else kept
