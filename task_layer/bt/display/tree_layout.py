"""Places the nodes of a tree: children below their parent, in order, without overlap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from py_trees.behaviour import Behaviour


@dataclass(frozen=True, slots=True)
class PlacedNode:
    """A node and its place: the middle and the width of its box, px, and its level from 0 at the root."""

    node: Behaviour
    x: float
    level: int
    width: float


def place(root: Behaviour, width_of: Callable[[Behaviour], float], gap: float) -> list[PlacedNode]:
    """Place every node, each parent above the middle of its children (Reingold and Tilford, 1981).

    Subtrees are moved together until, at some level, they are ``gap`` apart.

    Args:
        root: the top of the tree.
        width_of: the width of a node's box, px.
        gap: the smallest distance between boxes, px.

    Returns:
        all nodes, children before their parents; the leftmost box begins at x = 0.
    """
    order = list(root.iterate())
    offsets: dict[int, float] = {id(root): 0.0}  # from the parent's middle
    outlines: dict[int, _Outline] = {}
    for node in order:
        half = width_of(node) / 2
        below = [outlines.pop(id(child)) for child in node.children]
        shifts, merged = _arrange(below, gap)
        offsets.update((id(child), shift) for child, shift in zip(node.children, shifts, strict=True))
        outlines[id(node)] = _Outline([-half, *merged.left], [half, *merged.right])
    middle = -min(outlines[id(root)].left)
    return _absolute(root, order, offsets, middle, width_of)


@dataclass(slots=True)
class _Outline:
    """The extent of a subtree to the left and to the right of its root's middle, level by level."""

    left: list[float]
    right: list[float]


def _arrange(below: list[_Outline], gap: float) -> tuple[list[float], _Outline]:
    """How far each subtree is moved, and the outline of all; 0 is halfway between the first and the last."""
    merged, shifts = _Outline([], []), list[float]()
    for outline in below:
        overlaps = zip(merged.right, outline.left, strict=False)
        shift = max((right - left + gap for right, left in overlaps), default=0.0)
        shifts.append(shift)
        known = len(merged.left)
        merged.left.extend(left + shift for left in outline.left[known:])
        merged.right[: len(outline.right)] = [right + shift for right in outline.right]
    middle = (shifts[0] + shifts[-1]) / 2 if shifts else 0.0
    centred = _Outline([left - middle for left in merged.left], [right - middle for right in merged.right])
    return [shift - middle for shift in shifts], centred


def _absolute(
    root: Behaviour,
    order: list[Behaviour],
    offsets: dict[int, float],
    middle: float,
    width_of: Callable[[Behaviour], float],
) -> list[PlacedNode]:
    where = {id(root): (middle, 0)}
    for node in reversed(order):
        x, level = where[id(node)]
        where.update((id(child), (x + offsets[id(child)], level + 1)) for child in node.children)
    return [PlacedNode(node, *where[id(node)], width_of(node)) for node in order]
