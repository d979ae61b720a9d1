"""The built-in types of nodes, and how they are made."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache

from py_trees.behaviour import Behaviour

from task_layer.bt.engine.outcome import OUTCOMES_BY_NAME
from task_layer.bt.nodes.blackboard_nodes import (
    Precondition,
    ScriptAction,
    ScriptCondition,
    SetBlackboard,
    UnsetBlackboard,
)
from task_layer.bt.nodes.branching import Switch
from task_layer.bt.nodes.loops import Loop
from task_layer.bt.nodes.updates import SkipUnlessUpdated, WaitValueUpdate, WasEntryUpdated
from task_layer.bt.ports.bound_ports import PortError
from task_layer.bt.ports.conversion import parse
from task_layer.bt.ports.parameter import Parameter, value_of
from task_layer.bt.scripting import BoundCondition, BoundScript
from task_layer.bt.types.node_source import NodeKind
from task_layer.bt.types.node_type import NodeParts, NodeType
from task_layer.bt.types.vocabulary import BLACKBOARD_NODES, BUILT_IN, LOOPS, BuiltIn


@lru_cache(maxsize=1)
def built_in_types() -> Mapping[str, NodeType]:
    """All built-in types, by tag."""
    types = {tag: _from_table(tag, built_in) for tag, built_in in BUILT_IN.items()}
    for tag, (kind, ports) in BLACKBOARD_NODES.items():
        children = (1, 1) if kind is NodeKind.DECORATOR else (0, 0)
        types[tag] = NodeType(tag, kind, ports, _MAKERS[tag], children)
    return types


def _from_table(tag: str, built_in: BuiltIn) -> NodeType:
    make = _switch if built_in.node is Switch else _maker(built_in)
    return NodeType(tag, built_in.kind, built_in.ports, make, built_in.children, derived=True)


def _maker(built_in: BuiltIn) -> Callable[[NodeParts], Behaviour]:
    node: Callable[..., Behaviour] = built_in.node

    def make(parts: NodeParts) -> Behaviour:
        parameters = {port.name: parts.ports.parameter(port.name) for port in built_in.ports}
        if built_in.kind is NodeKind.CONTROL:
            return node(parts.name, list(parts.children), **parameters)
        return node(parts.name, *parts.children, **parameters)

    return make


def _switch(parts: NodeParts) -> Behaviour:
    names = ("variable", *(f"case_{number}" for number in range(1, len(parts.children))))
    variable, *cases = (_switch_parameter(parts.ports.parameter(name), parts.scope.enums) for name in names)
    return Switch(parts.name, list(parts.children), variable=variable, cases=cases)


def _switch_parameter(parameter: Parameter[object], enums: Mapping[str, float]) -> Parameter[object]:
    return _SwitchParameter(parameter, enums) if callable(parameter) or parameter in enums else parameter


class _SwitchParameter:
    """A parameter of a Switch: None while its entry has no value; a constant's name stands for its number."""

    def __init__(self, parameter: Parameter[object], enums: Mapping[str, float]) -> None:
        self._parameter = parameter
        self._enums = enums

    @property
    def text(self) -> str:
        """The text in the XML."""
        return str(getattr(self._parameter, "text", self._parameter))

    def __call__(self) -> object:
        """The present value."""
        try:
            value = value_of(self._parameter)
        except PortError:
            return None
        return self._enums.get(value, value) if isinstance(value, str) else value


def _script(parts: NodeParts) -> Behaviour:
    return ScriptAction(parts.name, BoundScript(parts.ports["code"], parts.scope))


def _script_condition(parts: NodeParts) -> Behaviour:
    return ScriptCondition(parts.name, BoundCondition(parts.ports["code"], parts.scope))


def _precondition(parts: NodeParts) -> Behaviour:
    holds = BoundCondition(parts.ports["if"], parts.scope)
    return Precondition(parts.name, parts.children[0], holds, parts.ports.parameter("else"))


def _set_blackboard(parts: NodeParts) -> Behaviour:
    value = parts.ports.parameter("value")
    key = parts.ports.parameter("output_key")
    source = getattr(value, "key", None)
    return SetBlackboard(parts.name, parts.scope.blackboard, "" if source else value, source, key)


def _unset_blackboard(parts: NodeParts) -> Behaviour:
    return UnsetBlackboard(parts.name, parts.scope.blackboard, parts.ports.parameter("key"))


def _loop(item: type) -> Callable[[NodeParts], Behaviour]:
    def make(parts: NodeParts) -> Behaviour:
        queue, if_empty = parts.ports.parameter("queue"), parts.ports.parameter("if_empty")
        if isinstance(queue, str):
            parse(queue, list[item])  # type: ignore[valid-type]
        if isinstance(if_empty, str) and if_empty not in OUTCOMES_BY_NAME:
            raise PortError(f"if_empty: {if_empty!r} is not one of {', '.join(OUTCOMES_BY_NAME)}")

        def set_value(value: object) -> None:
            parts.ports["value"] = value

        return Loop(parts.name, parts.children[0], queue, set_value, item, if_empty)

    return make


def _was_entry_updated(parts: NodeParts) -> Behaviour:
    return WasEntryUpdated(parts.name, parts.scope.blackboard, parts.ports.key("entry"))


def _skip_unless_updated(parts: NodeParts) -> Behaviour:
    return SkipUnlessUpdated(parts.name, parts.children[0], parts.scope.blackboard, parts.ports.key("entry"))


def _wait_value_update(parts: NodeParts) -> Behaviour:
    return WaitValueUpdate(parts.name, parts.children[0], parts.scope.blackboard, parts.ports.key("entry"))


_MAKERS: dict[str, Callable[[NodeParts], Behaviour]] = {
    "Script": _script,
    "ScriptCondition": _script_condition,
    "Precondition": _precondition,
    "SetBlackboard": _set_blackboard,
    "UnsetBlackboard": _unset_blackboard,
    **{tag: _loop(item) for tag, item in LOOPS.items()},
    "WasEntryUpdated": _was_entry_updated,
    "SkipUnlessUpdated": _skip_unless_updated,
    "WaitValueUpdate": _wait_value_update,
}
