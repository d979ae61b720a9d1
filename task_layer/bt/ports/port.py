"""Declarations of ports: the values that a node reads from its XML or blackboard, or writes to the blackboard."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any, Final


class Direction(Enum):
    """Whether a port is read, written or both; the values are the tags of BehaviorTree.CPP's TreeNodesModel."""

    IN = "input_port"
    OUT = "output_port"
    INOUT = "inout_port"


class _NoDefault(Enum):
    REQUIRED = "REQUIRED"
    OPTIONAL = "OPTIONAL"


REQUIRED: Final = _NoDefault.REQUIRED
"""The default of a port that has none, and must have a value if it is an input."""

OPTIONAL: Final = _NoDefault.OPTIONAL
"""The default of a port that has none, and may be left out."""


@dataclass(frozen=True, slots=True)
class Port:
    """The declaration of one port.

    Attributes:
        name: the name in the XML.
        direction: whether the node reads it, writes it, or both.
        type: the type of its value: ``str``, ``int``, ``float``, ``bool``, an ``Enum``, ``list[...]`` of these, or
            ``object`` for any.
        default: the value if the XML has none; a text such as ``"{key}"`` names an entry of the blackboard;
            :data:`REQUIRED` if the XML must have a value; :data:`OPTIONAL` if there may be none at all.
        description: for people who edit the tree.
    """

    name: str
    direction: Direction = Direction.IN
    type: Any = object
    default: object = REQUIRED
    description: str = ""


def InputPort(name: str, type: Any = object, default: object = REQUIRED, description: str = "") -> Port:  # noqa: A002, N802
    """A port that the node reads.

    Args:
        name: the port's name in the XML.
        type: the type of its value, as in :class:`Port`.
        default: the value if the XML has none; :data:`REQUIRED` if it must have one.
        description: for people who edit the tree.
    """
    return Port(name, Direction.IN, type, default, description)


def OutputPort(name: str, type: Any = object, default: object = REQUIRED, description: str = "") -> Port:  # noqa: A002, N802
    """A port that the node writes; in the XML it names an entry of the blackboard.

    Args:
        name: the port's name in the XML.
        type: the type of its value, as in :class:`Port`.
        default: the value if the XML has none; :data:`REQUIRED` if it must have one.
        description: for people who edit the tree.
    """
    return Port(name, Direction.OUT, type, default, description)


def InOutPort(name: str, type: Any = object, default: object = REQUIRED, description: str = "") -> Port:  # noqa: A002, N802
    """A port that the node reads and writes; in the XML it names an entry of the blackboard.

    Args:
        name: the port's name in the XML.
        type: the type of its value, as in :class:`Port`.
        default: the value if the XML has none; :data:`REQUIRED` if it must have one.
        description: for people who edit the tree.
    """
    return Port(name, Direction.INOUT, type, default, description)
