"""The XML that nodes were loaded from: their tags and ports, the ID of their tree, and its blackboard."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from py_trees.behaviour import Behaviour

from task_layer.bt.ports.blackboard import Blackboard
from task_layer.bt.ports.port import Port


class NodeKind(Enum):
    """BehaviorTree.CPP's categories of nodes; the values are its tags."""

    ACTION = "Action"
    CONDITION = "Condition"
    CONTROL = "Control"
    DECORATOR = "Decorator"
    SUBTREE = "SubTree"


KINDS_BY_TAG = {kind.value: kind for kind in NodeKind}
"""The categories by their tags in XML: ``<Action ID="...">`` and the others."""


def kind_by_children(count: int) -> NodeKind:
    """The category that a node of unknown type probably has, by the number of its children."""
    return (NodeKind.ACTION, NodeKind.DECORATOR, NodeKind.CONTROL)[min(count, 2)]


@dataclass(frozen=True, slots=True)
class NodeSource:
    """How a node is written in XML.

    Attributes:
        tag: the name that it is registered under; of a SubTree the ID of its tree.
        kind: its category.
        ports: names and texts of the ports in its XML.
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
    """Set how a node is written in XML, where that does not follow from its class.

    Args:
        node: the node.
        source: its tag, category and ports.

    >>> from py_trees.behaviours import Success
    >>> from task_layer.bt import tree_xml
    >>> leaf = Success("arrive")
    >>> set_source(leaf, NodeSource("MoveTo", NodeKind.ACTION, (("goal", "dock"),)))
    >>> '<MoveTo name="arrive" goal="dock" />' in tree_xml(leaf)
    True
    """
    setattr(node, _SOURCE, source)


def source_of(node: Behaviour) -> NodeSource | None:
    """How the node is written in XML, if it was set."""
    source: NodeSource | None = node.__dict__.get(_SOURCE)
    return source


def set_tree_id(root: Behaviour, tree_id: str) -> None:
    """Set the ``BehaviorTree ID`` of the tree below a root."""
    setattr(root, _TREE_ID, tree_id)


def tree_id_of(root: Behaviour) -> str | None:
    """The ID of the tree below a root, if it was set."""
    tree_id: str | None = root.__dict__.get(_TREE_ID)
    return tree_id


def set_blackboard(root: Behaviour, blackboard: Blackboard) -> None:
    """Set the blackboard of the tree below a root."""
    setattr(root, _BLACKBOARD, blackboard)


def blackboard_of(root: Behaviour) -> Blackboard | None:
    """The blackboard of the tree below a root, if it was set."""
    blackboard: Blackboard | None = root.__dict__.get(_BLACKBOARD)
    return blackboard


_SOURCE = "bt_source"
_BLACKBOARD = "bt_blackboard"
_TREE_ID = "bt_tree_id"
