"""The numbers of a tree's nodes in Groot2's protocol and logs."""

from __future__ import annotations

from collections.abc import Iterator
from uuid import UUID

from py_trees.behaviour import Behaviour


def node_uids(root: Behaviour) -> dict[UUID, int]:
    """The numbers that BehaviorTree.CPP gives to the nodes of a tree.

    Args:
        root: the tree.

    Returns:
        1 to N by the behaviours' ``id``, each node before its children and these in order.
    """
    return {node.id: uid for uid, node in enumerate(_in_depth_first_order(root), start=1)}


def _in_depth_first_order(root: Behaviour) -> Iterator[Behaviour]:
    to_do = [root]
    while to_do:
        node = to_do.pop()
        yield node
        to_do.extend(reversed(node.children))
