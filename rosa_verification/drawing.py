"""Fault trees as drawings: gates over their inputs, what several gates share drawn once."""

from __future__ import annotations

from dataclasses import dataclass, field

from rosa_core.errors import InputError, Problem
from rosa_verification.causes import Region, cause_text
from rosa_verification.fault_tree import FaultTree
from rosa_verification.structure import Combination
from task_layer.svg import Canvas, Point, drawing, tooltip

_WIDTH, _HEIGHT, _MARGIN = 150.0, 110.0, 12.0
"""Of the place of one node, and around the drawing, in px."""
_BOX = (138.0, 34.0)
_LETTERS = 24
_MOST_PLACES = 2_000
_COLOURS = {"failure": "#c0392b", "region": "#2471a3", "gate": "#333333"}


@dataclass
class _Drawn:
    """A node with its place: ``x`` counts places from the left, ``depth`` from the top."""

    label: str
    shape: str
    depth: int
    below: list[_Drawn] = field(default_factory=list)
    x: float = 0.0


def fault_tree_svg(tree: FaultTree) -> str:
    """A fault tree as an SVG document that stands on its own.

    A dome is an "and" gate, a pointed one an "or" gate; circles are failures of components, diamonds regions of
    measures. A triangle is what is drawn elsewhere.

    Args:
        tree: when something is unfeasible.

    Raises:
        InputError: if it is too large to be looked at.
    """
    root, places, depth = _laid_out(tree)
    width, height = places * _WIDTH + 2 * _MARGIN, (depth + 1) * _HEIGHT + 2 * _MARGIN
    canvas = drawing(
        width,
        height,
        title=tree.top.label,
        description=f"Fault tree: when {tree.top.label}",
        ink=_COLOURS["gate"],
        font_family="sans-serif",
        font_size=11,
        text_anchor="middle",
    )
    _draw(canvas, root)
    return canvas.document(indented=True)


def _laid_out(tree: FaultTree) -> tuple[_Drawn, int, int]:
    """The tree with its places, how many there are beside each other, and how many below."""
    drawn: set[str] = set()
    places = deepest = 0

    def place(name: str, depth: int) -> _Drawn:
        nonlocal places, deepest
        gate = tree.gates[name]
        if name in drawn:
            return leaf(_Drawn(gate.label, "elsewhere", depth))
        drawn.add(name)
        node = _Drawn(gate.label, gate.combination.value, depth)
        node.below = [place(below, depth + 1) for below in gate.gates]
        for cause in gate.causes:
            shape = "region" if isinstance(cause, Region) else "failure"
            node.below.append(leaf(_Drawn(cause_text(cause), shape, depth + 1)))
        if not node.below:
            node.shape = "always" if gate.combination is Combination.ALL else "never"
            return leaf(node)
        node.x = (node.below[0].x + node.below[-1].x) / 2
        return node

    def leaf(node: _Drawn) -> _Drawn:
        nonlocal places, deepest
        node.x = places
        places += 1
        deepest = max(deepest, node.depth)
        if places > _MOST_PLACES:
            what = f"the fault tree has more than {_MOST_PLACES} leaves"
            raise InputError(Problem(what, hint="too many to draw: write it as .xml or .dft"))
        return node

    # Elements are five levels deep at most, with a gate between two of them.
    return place(tree.top.name, 0), places, deepest


def _at(node: _Drawn) -> Point:
    return (_MARGIN + (node.x + 0.5) * _WIDTH, _MARGIN + node.depth * _HEIGHT)


def _draw(canvas: Canvas, node: _Drawn) -> None:
    x, y = _at(node)
    colour = _COLOURS.get(node.shape, _COLOURS["gate"])
    box = canvas.group()
    box.rect((x - _BOX[0] / 2, y), *_BOX, fill="#ffffff", stroke=colour, rx=3)
    lines = _lines(node.label)
    for number, line in enumerate(lines):
        box.text((x, y + (14 if len(lines) == 2 else 21) + 13 * number), line)
    tooltip(box.element, node.label)
    symbol = y + _BOX[1] + 6
    canvas.line((x, y + _BOX[1]), (x, symbol), stroke=colour)
    _SYMBOLS[node.shape](canvas, (x, symbol), colour)
    for below in node.below:
        below_x, below_y = _at(below)
        middle = below_y - 12
        canvas.polyline([(x, symbol + 26), (x, middle), (below_x, middle), (below_x, below_y)])
        _draw(canvas, below)


def _lines(label: str) -> list[str]:
    """A label in two lines at most: that gates are about what is unfeasible need not be said of each."""
    text = label.removesuffix(" unfeasible")
    if len(text) <= _LETTERS:
        return [text]
    at = text.find(" '")  # the kind of an element, then its name
    first = text[:at] if at > 0 else text[:_LETTERS].rsplit(" ", 1)[0]
    rest = text[len(first) :].strip()
    return [first, rest if len(rest) <= _LETTERS else rest[: _LETTERS - 1] + "…"]


def _and(canvas: Canvas, at: Point, colour: str) -> None:
    x, y = at
    canvas.path(f"M {x - 14:.1f} {y + 26:.1f} v -12 a 14 14 0 0 1 28 0 v 12 z", fill="#ffffff", stroke=colour)


def _or(canvas: Canvas, at: Point, colour: str) -> None:
    x, y = at
    sides = f"M {x - 14:.1f} {y + 26:.1f} q 0 -18 14 -26 q 14 8 14 26 q -14 -8 -28 0 z"
    canvas.path(sides, fill="#ffffff", stroke=colour)


def _circle(canvas: Canvas, at: Point, colour: str) -> None:
    canvas.circle((at[0], at[1] + 13), 13, fill="#ffffff", stroke=colour)


def _diamond(canvas: Canvas, at: Point, colour: str) -> None:
    x, y = at
    canvas.polygon([(x, y), (x + 16, y + 13), (x, y + 26), (x - 16, y + 13)], fill="#ffffff", stroke=colour)


def _triangle(canvas: Canvas, at: Point, colour: str) -> None:
    x, y = at
    canvas.polygon([(x, y), (x + 14, y + 26), (x - 14, y + 26)], fill="#ffffff", stroke=colour)


def _always(canvas: Canvas, at: Point, colour: str) -> None:
    _triangle(canvas, at, colour)
    canvas.text((at[0], at[1] + 22), "1")


def _never(canvas: Canvas, at: Point, colour: str) -> None:
    _triangle(canvas, at, colour)
    canvas.text((at[0], at[1] + 22), "0")


_SYMBOLS = {
    "all": _and,
    "any": _or,
    "failure": _circle,
    "region": _diamond,
    "elsewhere": _triangle,
    "always": _always,
    "never": _never,
}
