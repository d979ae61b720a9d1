"""The entries of a TreeNodesModel: what files say about the ports of nodes and subtrees."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rosa_core.errors import Location, Problem
from task_layer.bt.ports.conversion import ConversionError, parse
from task_layer.bt.ports.port import REQUIRED, Direction, Port
from task_layer.bt.types.node_source import KINDS_BY_TAG, NodeKind
from task_layer.bt.xml.source import Element

Report = Callable[[str, Location, str | None], None]
"""Takes a problem: what, where, and the hint."""

_DIRECTIONS = {direction.value: direction for direction in Direction}
_TYPES = {
    "int": int,
    "int64_t": int,
    "unsigned": int,
    "unsigned int": int,
    "double": float,
    "float": float,
    "bool": bool,
    "std::string": str,
    "string": str,
}


@dataclass(frozen=True, slots=True)
class NodeModel:
    """The entry of a TreeNodesModel for a node or a subtree.

    Attributes:
        tag: the name of the node, or the ID of the subtree.
        kind: its category.
        ports: its ports; the default of a subtree's port is a text.
        where: its place in the file.
        warnings: defaults that are no values of their types; those ports have no default.
    """

    tag: str
    kind: NodeKind
    ports: tuple[Port, ...]
    where: Location
    warnings: tuple[Problem, ...] = ()


def node_model(element: Element, report: Report) -> NodeModel | None:
    """The model in an element of a TreeNodesModel; None, and a problem, if it is none."""
    kind, tag = KINDS_BY_TAG.get(element.tag), element.get("ID")
    if kind is None:
        report(f"<{element.tag[:60]}> cannot stand here", element.where, f"one of {', '.join(KINDS_BY_TAG)}")
        return None
    if not tag:
        report(f"<{element.tag}> without an ID", element.where, None)
        return None
    ports, warnings = [], []
    for child in element.children:
        direction = _DIRECTIONS.get(child.tag)
        if direction is None:
            continue
        port, warning = _port(child, direction, kind, report)
        ports += [] if port is None else [port]
        warnings += [] if warning is None else [warning]
    return NodeModel(tag, kind, tuple(ports), element.where, tuple(warnings))


def _port(element: Element, direction: Direction, kind: NodeKind, report: Report) -> tuple[Port | None, Problem | None]:
    name, text = element.get("name"), element.get("default")
    if not name:
        report(f"<{element.tag}> without a name", element.where, None)
        return None, None
    wanted = _TYPES.get(element.get("type") or "", object)
    description = " ".join(element.text.split())
    if text is None:
        return Port(name, direction, wanted, REQUIRED, description), None
    if kind is not NodeKind.SUBTREE and wanted is not object and not text.startswith("{"):
        try:
            parse(text, wanted)
        except ConversionError as error:
            warning = Problem(f"the default of port '{name}' counts for nothing: {error}", element.where)
            return Port(name, direction, wanted, REQUIRED, description), warning
    return Port(name, direction, wanted, text, description), None
