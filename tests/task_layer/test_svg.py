"""Drawings are valid SVG, whatever is written into them."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from hypothesis import given
from hypothesis import strategies as st

from task_layer.svg import drawing, tooltip

SVG = "{http://www.w3.org/2000/svg}"
ANY_TEXT = st.text(st.characters())


@given(ANY_TEXT)
def test_any_text_can_be_drawn_and_is_escaped(text: str) -> None:
    canvas = drawing(10, 10, title=text, description=text)
    tooltip(canvas.circle((1, 1), 1, fill=text), text)
    canvas.text((0, 5), text, class_="label")
    root = ET.fromstring(canvas.document())
    assert [element.tag.removeprefix(SVG) for element in root] == ["title", "rect", "circle", "text"]
    shown = root.findtext(f"{SVG}text") or ""
    assert len(shown.replace("\n", "")) == len(text.replace("\r\n", "").replace("\r", "").replace("\n", ""))


def test_shapes_say_what_they_were_given() -> None:
    canvas = drawing(10.25, 20, ink="navy", background=None, fixed_size=True, font_size=12)
    canvas.line((0, 0), (1.04, 2.25))
    canvas.polyline([(0, 1), (2.55, 3)], stroke="red")
    canvas.polygon([(0, 0), (1, 0), (0, 1)], fill="blue")
    canvas.group(opacity="0.5").text((1, 2), "a", text_anchor="end")
    root = ET.fromstring(canvas.document(indented=True))
    assert dict(root.items()) == {"viewBox": "0 0 10.2 20", "width": "10.2", "height": "20", "font-size": "12"}
    line, polyline, polygon, group = root
    assert dict(line.items()) == {"x1": "0", "y1": "0", "x2": "1", "y2": "2.2", "stroke": "navy"}
    assert (polyline.get("points"), polyline.get("stroke")) == ("0,1 2.5,3", "red")
    assert polygon.get("points") == "0,0 1,0 0,1"
    assert (group.get("opacity"), group[0].get("fill"), group[0].get("text-anchor")) == ("0.5", "navy", "end")
