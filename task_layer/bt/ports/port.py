"""Ports: what a leaf reads from its tree's XML or blackboard, and what it writes there."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any, Final


class Direction(Enum):
    """Which way a value goes; the values are the tags of BehaviorTree.CPP's TreeNodesModel."""

    IN = "input_port"
    OUT = "output_port"
    INOUT = "inout_port"


class _Required(Enum):
    REQUIRED = "REQUIRED"


REQUIRED: Final = _Required.REQUIRED
"""Stands for the default of a port that has none."""


@dataclass(frozen=True, slots=True)
class Port:
    """The declaration of one port.

    Attributes:
        name: as it is written in the XML.
        direction: whether the node reads it, writes it, or both.
        type: what its value is: ``str``, ``int``, ``float``, ``bool``, an ``Enum``, ``list[...]`` of these, or
            ``object`` for anything.
        default: the value if the XML says nothing; a text such as ``"{key}"`` names an entry of the blackboard;
            :data:`REQUIRED` if there must be something.
        description: for people who edit the tree.
    """

    name: str
    direction: Direction = Direction.IN
    type: Any = object
    default: object = REQUIRED
    description: str = ""


def InputPort(name: str, type: Any = object, default: object = REQUIRED, description: str = "") -> Port:  # noqa: A002, N802
    """A port that the node reads."""
    return Port(name, Direction.IN, type, default, description)


def OutputPort(name: str, type: Any = object, default: object = REQUIRED, description: str = "") -> Port:  # noqa: A002, N802
    """A port that the node writes; in the XML it names an entry of the blackboard."""
    return Port(name, Direction.OUT, type, default, description)


def InOutPort(name: str, type: Any = object, default: object = REQUIRED, description: str = "") -> Port:  # noqa: A002, N802
    """A port that the node reads and writes; in the XML it names an entry of the blackboard."""
    return Port(name, Direction.INOUT, type, default, description)
