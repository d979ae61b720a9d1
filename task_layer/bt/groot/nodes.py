"""The nodes of a tree in the order in which BehaviorTree.CPP lists them."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from rosa_core import InputError
from rosa_core.errors import Problem
from task_layer.bt.nodes.decorators import SubTree
from task_layer.bt.xml.node_uids import node_uids

MAX_NODES = 0xFFFF
"""The largest number of nodes: the protocol and the log have two bytes for a node's number."""


def list_nodes(root: Behaviour) -> list[tuple[Behaviour, int]]:
    """All nodes and their numbers: those of the main tree first, then those of each subtree in order.

    Raises:
        InputError: if there are too many nodes to number.
    """
    uids = node_uids(root)
    if len(uids) > MAX_NODES:
        raise InputError(Problem(f"the tree has {len(uids)} nodes; Groot2 supports {MAX_NODES}"))
    nodes: list[tuple[Behaviour, int]] = []
    trees = [root]
    while trees:
        own, below = [trees.pop()], list[Behaviour]()
        while own:
            node = own.pop()
            nodes.append((node, uids[node.id]))
            (below if isinstance(node, SubTree) else own).extend(reversed(node.children))
        trees.extend(reversed(below))
    return nodes
