"""The nodes that every tree may use, as the loader makes them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache

from py_trees.behaviour import Behaviour

from task_layer.bt.nodes.blackboard_nodes import (
    Precondition,
    ScriptAction,
    ScriptCondition,
    SetBlackboard,
    UnsetBlackboard,
)
from task_layer.bt.nodes.control import Switch
from task_layer.bt.ports.bound_ports import PortError
from task_layer.bt.ports.parameter import Parameter, value_of
from task_layer.bt.scripting import BoundCondition, BoundScript
from task_layer.bt.types.node_source import NodeKind
from task_layer.bt.types.node_type import Making, NodeType
from task_layer.bt.types.vocabulary import BLACKBOARD_NODES, BUILT_IN, BuiltIn


@lru_cache(maxsize=1)
def built_in_types() -> Mapping[str, NodeType]:
    """All of them, by tag."""
    types = {tag: _from_table(tag, built_in) for tag, built_in in BUILT_IN.items()}
    for tag, (kind, ports) in BLACKBOARD_NODES.items():
        children = (1, 1) if kind is NodeKind.DECORATOR else (0, 0)
        types[tag] = NodeType(tag, kind, ports, _MAKERS[tag], children)
    return types


def _from_table(tag: str, built_in: BuiltIn) -> NodeType:
    make = _switch if built_in.node is Switch else _maker(built_in)
    return NodeType(tag, built_in.kind, built_in.ports, make, built_in.children, derived=True)


def _maker(built_in: BuiltIn) -> Callable[[Making], Behaviour]:
    node: Callable[..., Behaviour] = built_in.node

    def make(making: Making) -> Behaviour:
        parameters = {port.name: making.ports.parameter(port.name) for port in built_in.ports}
        if built_in.kind is NodeKind.CONTROL:
            return node(making.name, list(making.children), **parameters)
        return node(making.name, *making.children, **parameters)

    return make


def _switch(making: Making) -> Behaviour:
    names = ("variable", *(f"case_{number}" for number in range(1, len(making.children))))
    variable, *cases = (_case(making.ports.parameter(name), making.scope.enums) for name in names)
    return Switch(making.name, list(making.children), variable=variable, cases=cases)


def _case(parameter: Parameter[object], enums: Mapping[str, float]) -> Parameter[object]:
    return _Case(parameter, enums) if callable(parameter) or parameter in enums else parameter


class _Case:
    """A parameter of a Switch: None while there is no such entry; the name of an enum's member means its number."""

    def __init__(self, parameter: Parameter[object], enums: Mapping[str, float]) -> None:
        self._parameter = parameter
        self._enums = enums

    @property
    def text(self) -> str:
        """What is written."""
        return str(getattr(self._parameter, "text", self._parameter))

    def __call__(self) -> object:
        """The value now."""
        try:
            value = value_of(self._parameter)
        except PortError:
            return None
        return self._enums.get(value, value) if isinstance(value, str) else value


def _script(making: Making) -> Behaviour:
    return ScriptAction(making.name, BoundScript(making.ports["code"], making.scope))


def _script_condition(making: Making) -> Behaviour:
    return ScriptCondition(making.name, BoundCondition(making.ports["code"], making.scope))


def _precondition(making: Making) -> Behaviour:
    holds = BoundCondition(making.ports["if"], making.scope)
    return Precondition(making.name, making.children[0], holds, making.ports.parameter("else"))


def _set_blackboard(making: Making) -> Behaviour:
    value = making.ports.parameter("value")
    key = making.ports.parameter("output_key")
    source = getattr(value, "key", None)
    return SetBlackboard(making.name, making.scope.blackboard, "" if source else value, source, key)


def _unset_blackboard(making: Making) -> Behaviour:
    return UnsetBlackboard(making.name, making.scope.blackboard, making.ports.parameter("key"))


_MAKERS: dict[str, Callable[[Making], Behaviour]] = {
    "Script": _script,
    "ScriptCondition": _script_condition,
    "Precondition": _precondition,
    "SetBlackboard": _set_blackboard,
    "UnsetBlackboard": _unset_blackboard,
}
