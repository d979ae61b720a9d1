"""Behaviours with the typed ports of py_trees 2.6, on the blackboards of a loaded tree."""

from __future__ import annotations

from typing import Any

from py_trees.behaviour import Behaviour

from task_layer.bt.ports.bound_ports import Ports
from task_layer.bt.ports.port import REQUIRED, Direction, Port


def declared_ports(make: Any) -> tuple[Port, ...] | None:
    """The ports that a class declares in ``INPUT_PORTS`` and ``OUTPUT_PORTS``; None if it declares none."""
    inputs, outputs = getattr(make, "INPUT_PORTS", None), getattr(make, "OUTPUT_PORTS", None)
    if inputs is None or outputs is None:
        return None
    return (*_ports(inputs, Direction.IN), *_ports(outputs, Direction.OUT))


def connect(node: Behaviour, ports: Ports) -> None:
    """Connect the ports of a behaviour with the blackboard entries and values in its XML."""
    reading: Any = node
    reading.get_input = ports.get_or_raise
    reading._set_output = ports.__setitem__
    reading.get_last_output = ports.__getitem__


def _ports(declared: dict[str, Any], direction: Direction) -> list[Port]:
    return [
        Port(name, direction, port.data_type, _default(port, direction), port.description)
        for name, port in declared.items()
    ]


def _default(port: Any, direction: Direction) -> object:
    if direction is Direction.IN and port.default_value is not None:
        return port.default_value
    return REQUIRED if port.required else None
