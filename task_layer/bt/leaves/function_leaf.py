"""Plain functions as leaves: their parameters are the ports."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Container, Iterable, Mapping
from functools import partial
from typing import Any, Generic, TypeVar, get_args, get_origin, get_type_hints

from py_trees.common import Status

from task_layer.bt.engine.failing import Leaf
from task_layer.bt.engine.status import as_status
from task_layer.bt.ports.bound_ports import Ports
from task_layer.bt.ports.port import REQUIRED, Direction, Port

_T = TypeVar("_T")


class Output(Generic[_T]):
    """The argument that a function registered as a leaf gets for an output port.

    The parameter is annotated with ``Output[T]``, where T is the type of the values.

    Args:
        ports: the ports of the leaf.
        name: the port's name.
    """

    def __init__(self, ports: Ports, name: str) -> None:
        self._ports = ports
        self._name = name

    def set(self, value: _T) -> None:
        """Write the entry that the port names; nothing happens if it names none.

        Raises:
            PortError: if the value is not of the port's type.
        """
        self._ports[self._name] = value


class InOut(Output[_T]):
    """The argument that a function registered as a leaf gets for a port that it reads and writes (``InOut[T]``).

    Args:
        ports: the ports of the leaf.
        name: the port's name.
    """

    def get(self) -> _T:
        """The port's present value.

        Raises:
            PortError: if it has none, or not one of the port's type.
        """
        value: _T = self._ports[self._name]
        return value


_OUTPUTS: Mapping[Any, tuple[Direction, Callable[[Ports, str], Any]]] = {
    Output: (Direction.OUT, Output),
    InOut: (Direction.INOUT, InOut),
}


class FunctionLeaf(Leaf):
    """Calls a function at every tick, with the values of its ports.

    Its result is the status: True and None mean SUCCESS, False FAILURE; a ``Status`` or ``SkillStatus`` means itself.

    Args:
        name: the behaviour's name in the tree.
        function: the function.
        ports: the ports that its arguments are read from.
        declared: its ports, each with the name of one of its parameters; an input without a value is left out.
    """

    def __init__(self, name: str, function: Callable[..., object], ports: Ports, declared: Iterable[Port]) -> None:
        super().__init__(name)
        self._function = function
        self._arguments = {
            port.name: _argument_reader(ports, port)
            for port in declared
            if port.direction is not Direction.IN or port.name in ports
        }

    def update(self) -> Status:
        """Call the function."""
        return as_status(self._function(**{name: read() for name, read in self._arguments.items()}))


def ports_of_function(function: Callable[..., object], without: Container[str] = ()) -> tuple[Port, ...]:
    """The ports that follow from the parameters of a function, or of a class, and their annotations.

    Args:
        function: the function or class.
        without: parameters that are not ports.

    Raises:
        TypeError: if it has parameters without names, such as ``*args``, and all are to be ports.
    """
    hints = _type_hints(inspect.getattr_static(function, "__init__") if isinstance(function, type) else function)
    ports = []
    for name, parameter in inspect.signature(function).parameters.items():
        if name in without:
            continue
        if parameter.kind not in (parameter.POSITIONAL_OR_KEYWORD, parameter.KEYWORD_ONLY):
            if without:
                continue
            raise TypeError(f"the parameters of {function!r} are to be ports, but '{parameter}' has no name")
        direction, kind = _direction(hints.get(name, object))
        default = REQUIRED if parameter.default is parameter.empty else parameter.default
        ports.append(Port(name, direction, kind, default))
    return tuple(ports)


def returns_bool(function: Callable[..., object]) -> bool:
    """Whether a function is annotated as a condition."""
    return _type_hints(function).get("return") is bool


def _direction(hint: Any) -> tuple[Direction, Any]:
    origin = get_origin(hint) or hint
    if origin in _OUTPUTS:
        (kind,) = get_args(hint) or (object,)
        return _OUTPUTS[origin][0], kind
    return Direction.IN, object if hint is Any else hint


def _argument_reader(ports: Ports, port: Port) -> Callable[[], Any]:
    if port.direction is Direction.IN:
        parameter = ports.parameter(port.name)
        return parameter if callable(parameter) else lambda: parameter
    bound = Output(ports, port.name) if port.direction is Direction.OUT else InOut[Any](ports, port.name)
    return lambda: bound


def _type_hints(function: Callable[..., object]) -> dict[str, Any]:
    target: Any = function
    if isinstance(target, partial):
        target = target.func
    elif not inspect.isroutine(target) and not isinstance(target, type):
        target = type(target).__call__
    try:
        return get_type_hints(target)
    except (NameError, TypeError):
        # Annotations may name types that exist only for type checkers.
        return {}
