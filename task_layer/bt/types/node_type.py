"""What the loader knows about each kind of node: its ports, its children, and how one is made."""

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
    """What a node is made of.

    Attributes:
        name: its name in the tree.
        ports: its ports.
        scope: its blackboard, and the enums of scripts.
        children: what it ticks.
    """

    name: str
    ports: Ports
    scope: Scope
    children: Sequence[Behaviour] = ()


@dataclass(frozen=True, slots=True)
class NodeType:
    """A node that may stand in a tree.

    Attributes:
        tag: the name that it is registered under.
        kind: its category.
        ports: the ports that it has.
        make: makes one.
        children: how many children it takes, at least and at most (None: any number).
        derived: whether the saver can tell from such a node how it is written.
    """

    tag: str
    kind: NodeKind
    ports: tuple[Port, ...]
    make: Callable[[NodeParts], Behaviour]
    children: tuple[int, int | None] = (0, 0)
    derived: bool = False
