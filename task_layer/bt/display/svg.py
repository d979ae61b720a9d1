"""Draws trees as SVG."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.display.description import name_and_ports, printable, source_or_guess
from task_layer.bt.display.tree_layout import PlacedNode, place
from task_layer.bt.types.node_source import NodeKind, NodeSource
from task_layer.svg import Canvas, drawing

_GAP, _LEVEL_GAP, _MARGIN = 18.0, 34.0, 16.0
_LINE, _PADDING = 16.0, 9.0
_HEADER = _LINE + _PADDING / 2
_LETTER_WIDTH = 7.3
"""Width of a letter of the 12 px typeface, in px; a little more than most have."""
_MAX_LETTERS = 40

_KIND_COLOURS = {
    NodeKind.CONTROL: "#3b6ea8",
    NodeKind.DECORATOR: "#8a5aa8",
    NodeKind.SUBTREE: "#2f8077",
    NodeKind.CONDITION: "#a8761c",
    NodeKind.ACTION: "#4d5663",
}
_STATUS_FILLS = {Status.RUNNING: "#fff0c2", Status.SUCCESS: "#d6f2dc", Status.FAILURE: "#fbd9d6"}
_STYLE = (
    "text{font:12px 'DejaVu Sans Mono',Menlo,Consolas,monospace;text-anchor:middle;fill:#20262e}"
    ".tag{fill:#fff}.port{font-size:11px;fill:#5a6470}path{fill:none;stroke:#9aa4b0;stroke-width:1.3}"
)


def tree_svg(root: Behaviour) -> str:
    """Draw a tree: every node with its kind, its name and its ports, filled by its status unless it is idle.

    Args:
        root: the tree, from :func:`~task_layer.bt.xml.outline.read_outline`, loaded, or written in Python.

    Returns:
        an SVG document that stands on its own.
    """
    texts = {id(node): _texts(node) for node in root.iterate()}
    heights = {key: _height(lines) for key, (_, lines) in texts.items()}

    def width_of(node: Behaviour) -> float:
        source, lines = texts[id(node)]
        return max(map(len, (source.tag, *lines))) * _LETTER_WIDTH + 2 * _PADDING

    placed = place(root, width_of, _GAP)
    tops = _tops(placed, heights)
    width = max(one.x + one.width / 2 for one in placed) + 2 * _MARGIN
    height = max(tops[one.level] + heights[id(one.node)] for one in placed) + _MARGIN
    canvas = drawing(width, height, fixed_size=True, title=printable(root.name), style_sheet=_STYLE)
    for line in _lines(placed, tops, heights):
        canvas.path(line)
    for one in placed:
        _draw_box(canvas.group(), one, tops[one.level], *texts[id(one.node)])
    return canvas.document(indented=True)


def _texts(node: Behaviour) -> tuple[NodeSource, list[str]]:
    """The node's tag and category, and the lines below its tag."""
    source = source_or_guess(node)
    lines = [_short(line) for line in name_and_ports(node, source)]
    return NodeSource(_short(printable(source.tag)), source.kind), lines


def _short(text: str) -> str:
    return text if len(text) <= _MAX_LETTERS else f"{text[: _MAX_LETTERS - 1]}…"


def _height(lines: list[str]) -> float:
    return _HEADER + (_LINE * len(lines) + _PADDING / 2 if lines else 0.0)


def _tops(placed: list[PlacedNode], heights: dict[int, float]) -> list[float]:
    """The upper edge of each level: below the tallest box of the level above."""
    tallest = [0.0] * (1 + max(one.level for one in placed))
    for one in placed:
        tallest[one.level] = max(tallest[one.level], heights[id(one.node)])
    tops, top = [], _MARGIN
    for height in tallest:
        tops.append(top)
        top += height + _LEVEL_GAP
    return tops


def _lines(placed: list[PlacedNode], tops: list[float], heights: dict[int, float]) -> Iterator[str]:
    """From the middle of each parent's lower edge to the middle of each child's upper edge."""
    at = {id(one.node): one for one in placed}
    for one in placed:
        bottom = tops[one.level] + heights[id(one.node)]
        for child in (at[id(child)] for child in one.node.children):
            top = tops[child.level]
            half = top - _LEVEL_GAP / 2
            x, to = one.x + _MARGIN, child.x + _MARGIN
            yield f"M{x:.1f} {bottom:.1f}V{half:.1f}H{to:.1f}V{top:.1f}"


def _draw_box(canvas: Canvas, one: PlacedNode, top: float, source: NodeSource, lines: list[str]) -> None:
    corner, middle = (one.x - one.width / 2 + _MARGIN, top), one.x + _MARGIN
    colour = _KIND_COLOURS[source.kind]
    fill = _STATUS_FILLS.get(one.node.status, "#f7f8fa")
    canvas.rect(corner, one.width, _height(lines), rx=4, fill=fill, stroke=colour)
    canvas.rect(corner, one.width, _HEADER, rx=4, fill=colour)
    for number, line in enumerate((source.tag, *lines)):
        y = top + _LINE * (number + 0.8) + (_PADDING / 2 if number else 0)
        kind = "tag" if number == 0 else "name" if line.startswith('"') else "port"
        canvas.text((middle, y), line, class_=kind)
