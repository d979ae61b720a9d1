"""Drawings as SVG documents that stand on their own; ElementTree escapes every text and attribute."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree import ElementTree as ET

Point = tuple[float, float]

_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclass(frozen=True, slots=True)
class Canvas:
    """A drawing, or a group of shapes in one: x to the right and y downwards, in pixels.

    Every method that draws adds one SVG element and returns it. Its keywords are the element's attributes, with ``_``
    for ``-`` and a trailing ``_`` left out (``stroke_width=2``, ``class_="name"``); numbers get one decimal at most.

    Attributes:
        element: the SVG element that the shapes are added to.
        ink: the colour of lines and texts that say none; None leaves it to the style sheet.

    >>> canvas = drawing(30, 20, background=None)
    >>> _ = canvas.line((0, 0), (30, 12.25), stroke="red", stroke_width=2)
    >>> _ = canvas.text((5, 15), "a < b")
    >>> print(canvas.document(indented=True), end="")
    <svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 30 20">
      <line x1="0" y1="0" x2="30" y2="12.2" stroke="red" stroke-width="2" />
      <text x="5" y="15">a &lt; b</text>
    </svg>
    """

    element: ET.Element
    ink: str | None = None

    def line(self, start: Point, end: Point, **style: str | float) -> ET.Element:
        """A straight line.

        Args:
            start: (x, y) in px.
            end: (x, y) in px.
            style: attributes; without a ``stroke``, the ink.
        """
        (x1, y1), (x2, y2) = start, end
        return self.shape("line", x1=x1, y1=y1, x2=x2, y2=y2, **self._inked("stroke", style))

    def rect(self, corner: Point, width: float, height: float, **style: str | float) -> ET.Element:
        """A rectangle, by its upper left corner.

        Args:
            corner: the upper left one, (x, y) in px.
            width: px.
            height: px.
            style: attributes.
        """
        return self.shape("rect", x=corner[0], y=corner[1], width=width, height=height, **style)

    def circle(self, centre: Point, radius: float, **style: str | float) -> ET.Element:
        """A circle.

        Args:
            centre: (x, y) in px.
            radius: px.
            style: attributes.
        """
        return self.shape("circle", cx=centre[0], cy=centre[1], r=radius, **style)

    def polyline(self, points: Iterable[Point], **style: str | float) -> ET.Element:
        """A line through points, with round joins and nothing filled."""
        joined = {"fill": "none", "stroke_linejoin": "round", **self._inked("stroke", style)}
        return self.shape("polyline", points=_coordinates(points), **joined)

    def polygon(self, points: Iterable[Point], **style: str | float) -> ET.Element:
        """An area with these corners."""
        return self.shape("polygon", points=_coordinates(points), **style)

    def path(self, data: str, **style: str | float) -> ET.Element:
        """A path, in SVG's path language."""
        return self.shape("path", d=data, **style)

    def text(self, at: Point, text: str, **style: str | float) -> ET.Element:
        """A line of text; characters that XML does not allow are replaced.

        Args:
            at: (x, y) in px, on the base line.
            text: as it is to be read.
            style: attributes; ``text_anchor`` is start, middle or end; without a ``fill``, the ink.
        """
        element = self.shape("text", x=at[0], y=at[1], **self._inked("fill", style))
        element.text = xml_text(text)
        return element

    def group(self, **style: str | float) -> Canvas:
        """A canvas inside this one, whose shapes share a style."""
        return Canvas(self.shape("g", **style), self.ink)

    def shape(self, tag: str, **attributes: str | float) -> ET.Element:
        """Any other element of SVG."""
        return ET.SubElement(self.element, tag, _attributes(attributes))

    def document(self, *, indented: bool = False) -> str:
        """The SVG document, one element a line if it is indented."""
        if indented:
            ET.indent(self.element)
        return ET.tostring(self.element, encoding="unicode") + "\n"

    def _inked(self, attribute: str, style: dict[str, str | float]) -> dict[str, str | float]:
        return style if self.ink is None else {attribute: self.ink, **style}


def drawing(
    width: float,
    height: float,
    *,
    fixed_size: bool = False,
    title: str | None = None,
    description: str | None = None,
    style_sheet: str | None = None,
    background: str | None = "#ffffff",
    ink: str | None = None,
    **attributes: str | float,
) -> Canvas:
    """An empty drawing.

    Args:
        width: of the view box, px.
        height: of the view box, px.
        fixed_size: shown in this size, and not in that of what it is shown in.
        title: what a browser calls the document.
        description: what a reader who cannot see the drawing is given to read.
        style_sheet: CSS for the whole drawing.
        background: the colour that it is filled with; None for none.
        ink: the colour of lines and texts that say none.
        attributes: of the ``svg`` element, written as those of shapes: ``font_size=12``.
    """
    view_box = f"0 0 {_number(width)} {_number(height)}"
    svg = ET.Element("svg", {"xmlns": "http://www.w3.org/2000/svg", "viewBox": view_box, **_attributes(attributes)})
    canvas = Canvas(svg, ink)
    if fixed_size:
        svg.set("width", _number(width))
        svg.set("height", _number(height))
    if title is not None:
        tooltip(svg, title)
    if description is not None:
        svg.set("role", "img")
        svg.set("aria-label", xml_text(description))
    if style_sheet is not None:
        canvas.shape("style").text = xml_text(style_sheet)
    if background is not None:
        canvas.rect((0.0, 0.0), width, height, fill=background)
    return canvas


def tooltip(element: ET.Element, text: str) -> None:
    """Show a text while the pointer rests on an element.

    Args:
        element: an SVG element.
        text: as it is to be read.
    """
    ET.SubElement(element, "title").text = xml_text(text)


def xml_text(text: str) -> str:
    r"""The text with a replacement character for each that XML cannot hold.

    >>> xml_text("red\x1b[0m <&>")
    'red�[0m <&>'
    """
    return _NOT_XML.sub("\ufffd", text)


def _coordinates(points: Iterable[Point]) -> str:
    return " ".join(f"{_number(x)},{_number(y)}" for x, y in points)


def _attributes(given: dict[str, str | float]) -> dict[str, str]:
    return {
        name.removesuffix("_").replace("_", "-"): xml_text(value) if isinstance(value, str) else _number(value)
        for name, value in given.items()
    }


def _number(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")
