"""The values on a tree's blackboards, as Groot2 shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any
from xml.etree import ElementTree as ET

import py_trees
from py_trees.behaviour import Behaviour

from task_layer.bt.nodes.decorators import SubTree
from task_layer.bt.ports.blackboard import EMPTY, Blackboard
from task_layer.bt.types.node_source import blackboard_of, tree_id_of
from task_layer.bt.xml.node_uids import node_uids

_MAX_DEPTH = 20
_MAX_LENGTH = 1000
_INTEGERS = range(-(2**63), 2**64)


def dump_blackboards(known: Mapping[str, Blackboard | None], names: Sequence[str]) -> bytes:
    """The blackboards of some names, in MessagePack: for each its values by key, or nil if it is empty."""
    import msgpack

    shown = {name: _packable(_values(known[name])) or None for name in sorted(set(names)) if name in known}
    packed: bytes = msgpack.packb(shown or None, unicode_errors="replace")
    return packed


def named_blackboards(root: Behaviour, xml: str) -> dict[str, Blackboard | None]:
    """The blackboards of a tree by the names that Groot2 asks for: the main tree's ID, and the paths of subtrees.

    None stands for the blackboard of py_trees, which the main tree uses if it has none of its own.

    Args:
        root: the tree.
        xml: its XML, with numbers and paths (:func:`~task_layer.bt.xml.saver.tree_xml`).
    """
    uids = node_uids(root)
    paths = {element.get("_uid"): element.get("_fullpath", "") for element in ET.fromstring(xml).iter("SubTree")}  # noqa: S314 - our own
    known: dict[str, Blackboard | None] = {tree_id_of(root) or "MainTree": blackboard_of(root)}
    for node in root.iterate():
        if isinstance(node, SubTree):
            known[paths[str(uids[node.id])]] = blackboard_of(node.decorated) or Blackboard()
    return known


def _values(blackboard: Blackboard | None) -> dict[str, Any]:
    if blackboard is None:
        return {key.lstrip("/"): value for key, value in py_trees.blackboard.Blackboard.storage.copy().items()}
    keys = blackboard.names()
    entries = {key: blackboard.entry(key) for key in keys}
    return {key: entry.value for key, entry in entries.items() if entry is not None and entry.value is not EMPTY}


def _packable(value: Any, depth: int = 0) -> Any:
    """The value as MessagePack can hold it; for other values their type."""
    if isinstance(value, Enum):
        return value.name
    if value is None or isinstance(value, bool | float):
        return value
    if isinstance(value, int):
        return int(value) if value in _INTEGERS else str(value)
    if isinstance(value, str):
        return value[:_MAX_LENGTH]
    if depth < _MAX_DEPTH:
        if isinstance(value, Mapping):
            return {str(key): _packable(item, depth + 1) for key, item in sorted(dict(value).items(), key=str)}
        if isinstance(value, list | tuple):
            return [_packable(item, depth + 1) for item in tuple(value)[:_MAX_LENGTH]]
    return f"<{type(value).__name__}>"
