"""How nodes are written in XML: what a loaded node remembers of its file, and what follows from a node's class."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from py_trees.behaviour import Behaviour

from task_layer.bt.ports.blackboard import Blackboard
from task_layer.bt.ports.port import Port


class NodeKind(Enum):
    """The categories of BehaviorTree.CPP; the values are its tags."""

    ACTION = "Action"
    CONDITION = "Condition"
    CONTROL = "Control"
    DECORATOR = "Decorator"
    SUBTREE = "SubTree"


@dataclass(frozen=True, slots=True)
class NodeSource:
    """How a node is written.

    Attributes:
        tag: the name that it is registered under; of a SubTree the ID of its tree.
        kind: its category.
        ports: names and texts of the ports that are written.
        declared: the ports that nodes of this name have.
    """

    tag: str
    kind: NodeKind = NodeKind.ACTION
    ports: tuple[tuple[str, str], ...] = ()
    declared: tuple[Port, ...] = ()


CONDITION_ATTRIBUTES = {
    "_failureIf": "failure_if",
    "_successIf": "success_if",
    "_skipIf": "skip_if",
    "_while": "while_true",
    "_onSuccess": "on_success",
    "_onFailure": "on_failure",
    "_onHalted": "on_halted",
    "_post": "post",
}
"""The XML attributes of pre- and post-conditions, and the fields of
:class:`~task_layer.bt.engine.conditions.Conditions`."""


def set_source(node: Behaviour, source: NodeSource) -> None:
    """Say how a node is written in XML, if its class does not tell."""
    setattr(node, _SOURCE, source)


def source_of(node: Behaviour) -> NodeSource | None:
    """How the node is written, if that was said."""
    source: NodeSource | None = node.__dict__.get(_SOURCE)
    return source


def set_tree_id(root: Behaviour, tree_id: str) -> None:
    """Say which ``BehaviorTree ID`` the tree below this root has."""
    setattr(root, _TREE_ID, tree_id)


def tree_id_of(root: Behaviour) -> str | None:
    """The tree's ID, if one was said."""
    tree_id: str | None = root.__dict__.get(_TREE_ID)
    return tree_id


def set_blackboard(root: Behaviour, blackboard: Blackboard) -> None:
    """Say which blackboard the nodes of the tree below this root share."""
    setattr(root, _BLACKBOARD, blackboard)


def blackboard_of(root: Behaviour) -> Blackboard | None:
    """The tree's blackboard, if one was said."""
    blackboard: Blackboard | None = root.__dict__.get(_BLACKBOARD)
    return blackboard


_SOURCE = "bt_source"
_BLACKBOARD = "bt_blackboard"
_TREE_ID = "bt_tree_id"
