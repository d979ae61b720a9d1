"""The leaves that a mission may name, and what each stands for."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from enum import Enum
from typing import Any

from py_trees import composites
from py_trees import decorators as stock_decorators
from py_trees.behaviour import Behaviour

from task_layer.bt.leaves.action_ports import ACTION_NAME, PREFERENCE, action_ports
from task_layer.bt.leaves.function_leaf import FunctionLeaf, ports_of_function, returns_bool
from task_layer.bt.leaves.is_action_feasible import IsActionFeasible
from task_layer.bt.leaves.rosa_action import RosaAction
from task_layer.bt.leaves.skill_action import SkillAction
from task_layer.bt.ports.bound_ports import PortError
from task_layer.bt.ports.port import InputPort, Port
from task_layer.bt.ports.typed_ports import connect, declared_ports
from task_layer.bt.types.node_source import NodeKind
from task_layer.bt.types.node_type import NodeParts, NodeType
from task_layer.bt.types.vocabulary import is_built_in
from task_layer.skill import Skill

_NOT_PORTS = ("self", "name", "ports", "child", "children", "skill")


FEASIBILITY_CONDITIONS = ("IsActionFeasible", "is_action_feasible")
"""The names of the condition in missions that checks whether an action is feasible."""


class Registry:
    """The leaves that a mission may use, by the names that stand for them in XML.

    A leaf may be

    - a :class:`~task_layer.skill.Skill`, the class or an instance: a :class:`RosaAction` of that name carries it out,
      or with ``request=False`` a :class:`SkillAction`;
    - a plain function: its result True or None means SUCCESS, False FAILURE, a status itself; its parameters are its
      input ports, and those annotated with ``Output`` its output ports;
    - a class of py_trees behaviours, or any function with a parameter ``name`` that makes one. A parameter ``ports``
      gets its :class:`~task_layer.bt.ports.bound_ports.Ports`; the other parameters are ports whose values must be
      known when the tree is loaded. Typed ports of py_trees (``INPUT_PORTS``, ``OUTPUT_PORTS``) work as well.

    ``IsActionFeasible``, ``is_action_feasible`` and ``RosaAction`` (port ``action_name``) are always registered.

    Args:
        leaves: names and leaves.
        enums: names and numbers of constants in scripts.

    Raises:
        TypeError: if something is no leaf.
        ValueError: if a name is that of a built-in node.

    >>> def charged(level: float) -> bool:
    ...     return level > 0.2
    >>> Registry({"charged": charged}).names()
    ['IsActionFeasible', 'RosaAction', 'charged', 'is_action_feasible']
    """

    def __init__(self, leaves: Mapping[str, Any] | None = None, *, enums: Mapping[str, float] | None = None) -> None:
        self.enums: dict[str, float] = dict(enums or {})
        self._types: dict[str, NodeType] = {}
        for name in FEASIBILITY_CONDITIONS:
            self.add(name, IsActionFeasible)
        ports = (InputPort("action_name", str, description=ACTION_NAME.description), PREFERENCE)
        self._types["RosaAction"] = NodeType("RosaAction", NodeKind.ACTION, ports, self._rosa_action)
        for name, leaf in (leaves or {}).items():
            self.add(name, leaf)

    @classmethod
    def of(cls, leaves: Registry | Mapping[str, Any]) -> Registry:
        """The registry itself, or one of the leaves in a dictionary."""
        return leaves if isinstance(leaves, Registry) else cls(leaves)

    def add(
        self,
        name: str,
        leaf: Any,
        *,
        ports: Iterable[Port] | None = None,
        kind: NodeKind | None = None,
        request: bool = True,
    ) -> Registry:
        """Register a leaf, in place of one of the same name.

        Args:
            name: the name in the XML.
            leaf: the skill, function or class.
            ports: its ports, where they do not follow from the leaf.
            kind: whether editors show it as an action or as a condition.
            request: whether a skill's action is requested from the knowledge base.

        Returns:
            the registry, so that calls can be chained.

        Raises:
            TypeError: if no leaf can be made of it.
            ValueError: if the name is that of a built-in node.
        """
        if is_built_in(name):
            raise ValueError(f"'{name}' is the name of a built-in node")
        self._types[name] = _node_type(name, leaf, None if ports is None else tuple(ports), kind, request)
        return self

    def count_all_as_feasible(self) -> Registry:
        """Let ``IsActionFeasible`` always succeed, for a robot without a knowledge base; return the registry."""
        for name in FEASIBILITY_CONDITIONS:
            self.add(name, _always_feasible)
        return self

    def add_enum(self, enum: type[Enum]) -> Registry:
        """Let scripts use the names of an enum's members as their numbers; return the registry."""
        self.enums |= {name: float(member.value) for name, member in enum.__members__.items()}
        return self

    def get(self, name: str) -> NodeType | None:
        """The type of nodes that is registered under a name, if there is one."""
        return self._types.get(name)

    def names(self) -> list[str]:
        """All names, sorted."""
        return sorted(self._types)

    def __contains__(self, name: str) -> bool:
        return name in self._types

    def _rosa_action(self, parts: NodeParts) -> Behaviour:
        action = parts.ports.constant("action_name")
        leaf = self.get(action)
        if leaf is None or leaf.tag == "RosaAction" or "preference" not in {port.name for port in leaf.ports}:
            raise PortError(f"there is no skill for the action '{action}' in the registry")
        return leaf.make(parts)


def _node_type(name: str, leaf: Any, ports: tuple[Port, ...] | None, kind: NodeKind | None, request: bool) -> NodeType:
    if isinstance(leaf, Behaviour):
        raise TypeError(f"'{name}': a behaviour can stand in one place only; register its class, or a function")
    if isinstance(leaf, Skill) or (isinstance(leaf, type) and issubclass(leaf, Skill)):
        return _skill(name, leaf, ports, request)
    if isinstance(leaf, type) and issubclass(leaf, IsActionFeasible):
        return NodeType(
            name,
            NodeKind.CONDITION,
            (ACTION_NAME,),
            lambda parts: leaf(parts.ports.constant("action_name"), parts.name),
        )
    if isinstance(leaf, type) and issubclass(leaf, RosaAction):
        return NodeType(name, NodeKind.ACTION, action_ports(name), lambda parts: _rosa_action(leaf, parts))
    if not callable(leaf):
        raise TypeError(f"'{name}' must be a behaviour class, a Skill or a function, not {leaf!r}")
    if isinstance(leaf, type) or "name" in inspect.signature(leaf).parameters:
        return _factory(name, leaf, ports, kind)
    declared = ports_of_function(leaf) if ports is None else ports
    if kind is None:
        kind = NodeKind.CONDITION if returns_bool(leaf) else NodeKind.ACTION
    return NodeType(name, kind, declared, lambda parts: FunctionLeaf(parts.name, leaf, parts.ports, declared))


def _skill(name: str, skill: Skill | type[Skill], ports: tuple[Port, ...] | None, request: bool) -> NodeType:
    takes_ports = isinstance(skill, type) and "ports" in inspect.signature(skill).parameters

    def new(parts: NodeParts) -> Skill:
        if not isinstance(skill, type):
            return skill
        make: Callable[..., Skill] = skill
        return make(ports=parts.ports) if takes_ports else make()

    own: tuple[Port, ...] = getattr(skill, "PORTS", ()) if ports is None else ports
    if not request:
        return NodeType(name, NodeKind.ACTION, own, lambda parts: SkillAction(parts.name, new(parts)))
    return NodeType(
        name,
        NodeKind.ACTION,
        (*action_ports(name), *own),
        lambda parts: _rosa_action(RosaAction, parts, skill=new(parts)),
    )


def _rosa_action(make: Callable[..., RosaAction], parts: NodeParts, **more: Any) -> RosaAction:
    preference = parts.ports.constant("preference") or None
    return make(parts.ports.constant("action_name"), name=parts.name, preference=preference, **more)


def _factory(
    name: str, make: Callable[..., Behaviour], ports: tuple[Port, ...] | None, kind: NodeKind | None
) -> NodeType:
    if isinstance(make, type) and not issubclass(make, Behaviour):
        raise TypeError(f"'{name}' must be a class of behaviours or skills, not {make!r}")
    typed = declared_ports(make)
    takes_ports = "ports" in inspect.signature(make).parameters
    if ports is None:
        ports = typed
    if ports is None:
        ports = tuple(getattr(make, "PORTS", ())) if takes_ports else ports_of_function(make, _NOT_PORTS)

    def make_node(parts: NodeParts) -> Behaviour:
        arguments: dict[str, Any] = {"name": parts.name, **_children(own_kind, parts)}
        if takes_ports:
            arguments["ports"] = parts.ports
        elif typed is None:
            arguments |= {port.name: parts.ports.constant(port.name) for port in ports if port.name in parts.ports}
        node = make(**arguments)
        if typed is not None:
            connect(node, parts.ports)
        return node

    own_kind, children = _category(make)
    return NodeType(name, kind or own_kind, ports, make_node, children)


def _category(make: Any) -> tuple[NodeKind, tuple[int, int | None]]:
    if isinstance(make, type) and issubclass(make, stock_decorators.Decorator):
        return NodeKind.DECORATOR, (1, 1)
    if isinstance(make, type) and issubclass(make, composites.Composite):
        return NodeKind.CONTROL, (1, None)
    return NodeKind.ACTION, (0, 0)


def _children(kind: NodeKind, parts: NodeParts) -> dict[str, Any]:
    if kind is NodeKind.DECORATOR:
        return {"child": parts.children[0]}
    return {"children": list(parts.children)} if kind is NodeKind.CONTROL else {}


def _always_feasible(action_name: str) -> bool:  # noqa: ARG001 - the leaf's port
    return True
