"""The types of nodes that a tree may use: their ports, their children, and how a node is made."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from py_trees.behaviour import Behaviour

from task_layer.bt.ports.bound_ports import Ports
from task_layer.bt.ports.port import Port
from task_layer.bt.scripting import Scope
from task_layer.bt.types.node_source import NodeKind


@dataclass(frozen=True, slots=True)
class NodeParts:
    """The parts that a node is made of.

    Attributes:
        name: its name in the tree.
        ports: its ports.
        scope: its blackboard, and the constants of scripts.
        children: its children.
    """

    name: str
    ports: Ports
    scope: Scope
    children: Sequence[Behaviour] = ()


@dataclass(frozen=True, slots=True)
class NodeType:
    """A type of nodes.

    Attributes:
        tag: the name that it is registered under.
        kind: its category.
        ports: the ports that its nodes have.
        make: makes a node of its parts.
        children: the smallest and the largest number of children (None: no limit).
        derived: whether the XML of such a node follows from its class, so that it need not be kept.
    """

    tag: str
    kind: NodeKind
    ports: tuple[Port, ...]
    make: Callable[[NodeParts], Behaviour]
    children: tuple[int, int | None] = (0, 0)
    derived: bool = False
