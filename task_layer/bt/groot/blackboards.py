"""The values on a tree's blackboards, as Groot2 shows them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any

import py_trees
from py_trees.behaviour import Behaviour

from task_layer.bt.node_source import tree_id_of

_DEEPEST = 20
_LONGEST = 1000
_INTEGERS = range(-(2**63), 2**64)


def dump_blackboards(nodes: Sequence[tuple[Behaviour, int]], names: Sequence[str]) -> bytes:
    """The blackboards of these names, in MessagePack: for each the values by key.

    A subtree's blackboard has the subtree's path as name. A tree that uses the blackboard of py_trees has that one,
    under the name of the main tree.
    """
    import msgpack

    known = _blackboards(nodes)
    shown = {name: _shown(known[name]) or None for name in sorted(set(names)) if name in known}
    packed: bytes = msgpack.packb(shown or None, unicode_errors="replace")
    return packed


def _blackboards(nodes: Sequence[tuple[Behaviour, int]]) -> dict[str, Mapping[str, Any]]:
    main = tree_id_of(nodes[0][0]) or "MainTree"
    return {main: {key.lstrip("/"): value for key, value in py_trees.blackboard.Blackboard.storage.copy().items()}}


def _shown(value: Any, depth: int = 0) -> Any:
    """The value as far as MessagePack has a like; of anything else its type."""
    if isinstance(value, Enum):
        return value.name
    if value is None or isinstance(value, bool | float):
        return value
    if isinstance(value, int):
        return int(value) if value in _INTEGERS else str(value)
    if isinstance(value, str):
        return value[:_LONGEST]
    if depth < _DEEPEST:
        if isinstance(value, Mapping):
            return {str(key): _shown(item, depth + 1) for key, item in sorted(dict(value).items(), key=str)}
        if isinstance(value, list | tuple):
            return [_shown(item, depth + 1) for item in tuple(value)[:_LONGEST]]
    return f"<{type(value).__name__}>"
