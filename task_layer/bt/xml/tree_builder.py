"""Makes nodes of their specifications."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from py_trees.behaviour import Behaviour

from rosa_core import InputError, RosaError
from rosa_core.errors import Location, Problem
from task_layer.bt.engine.conditions import Conditions, set_conditions
from task_layer.bt.engine.node import Node
from task_layer.bt.leaves.built_in_leaves import AlwaysFailure
from task_layer.bt.nodes.decorators import SubTree
from task_layer.bt.ports.blackboard import Blackboard
from task_layer.bt.ports.bound_ports import Literal, Ports, PortValue, Reference
from task_layer.bt.ports.conversion import parse_bool
from task_layer.bt.scripting import BoundCondition, BoundScript, Scope, Script
from task_layer.bt.types.node_source import NodeKind, NodeSource, set_blackboard, set_source
from task_layer.bt.types.node_type import NodeParts, NodeType
from task_layer.bt.xml.limits import MAX_DEPTH, MAX_NODES
from task_layer.bt.xml.node_specs import NodeSpec
from task_layer.bt.xml.tree_files import check_no_cycle

_PRE_CONDITIONS = frozenset(("failure_if", "success_if", "skip_if", "while_true"))


class TreeBuilder:
    """Makes the nodes of a tree.

    Args:
        specs: the specifications of the trees that it uses, by ID.
        enums: names and numbers of constants in scripts.
    """

    def __init__(self, specs: Mapping[str, NodeSpec], enums: Mapping[str, float]) -> None:
        self.problems: list[Problem] = []
        self._specs = specs
        self._enums = dict(enums)
        self._nodes = 0

    def build(self, spec: NodeSpec, blackboard: Blackboard, inside: tuple[str, ...], depth: int) -> Behaviour:
        """The node of a specification, with everything below it.

        Args:
            spec: its specification.
            blackboard: the blackboard of its tree.
            inside: the IDs of the trees that it is in.
            depth: its level, from 1 at the root.
        """
        self._nodes += 1
        if self._nodes > MAX_NODES:
            raise InputError(Problem(f"the tree has more than {MAX_NODES} nodes", spec.where))
        if depth > MAX_DEPTH:
            raise InputError(Problem(f"the tree is more than {MAX_DEPTH} levels deep, subtrees counted in", spec.where))
        scope = Scope(blackboard, self._enums)
        if spec.type is None:
            node = self._subtree(spec, blackboard, inside, depth)
        else:
            # The ports first: a type that is declared here applies to the nodes below.
            ports = self._ports(spec, spec.type, blackboard)
            children = [self.build(child, blackboard, inside, depth + 1) for child in spec.children]
            node = self._node(spec, spec.type, NodeParts(spec.name, ports, scope, children))
        if spec.conditions:
            set_conditions(node, _bound(spec.conditions, scope))
        return node

    def refuse_conditions(self, specs: Iterable[NodeSpec], where: str) -> None:
        """Report conditions that would have no effect: control nodes and decorators of this package evaluate them."""
        for spec in specs:
            if spec.conditions:
                what = f"the conditions of '{spec.name}' do not count {where}"
                self.problems.append(Problem(what, spec.where, "put it in a <Sequence>"))

    def _node(self, spec: NodeSpec, node_type: NodeType, parts: NodeParts) -> Behaviour:
        try:
            node = node_type.make(parts)
        except (RosaError, ValueError, TypeError) as error:
            self._problem(f"'{spec.name}' cannot be made: {error}", spec.where)
            return AlwaysFailure(spec.name)
        if not isinstance(node, Node):
            self.refuse_conditions(spec.children, f"below a '{node_type.tag}'")
        if not node_type.derived:
            set_source(node, NodeSource(node_type.tag, node_type.kind, spec.port_texts, node_type.ports))
        return node

    def _ports(self, spec: NodeSpec, node_type: NodeType, blackboard: Blackboard) -> Ports:
        declared = {port.name: port for port in node_type.ports}
        for name, value in spec.values.items():
            if isinstance(value, Reference):
                try:
                    blackboard.create(value.key, declared[name].type)
                except RosaError as error:
                    self._problem(f"{name}: {error}", spec.where)
        return Ports(node_type.ports, spec.values, blackboard)

    def _subtree(self, spec: NodeSpec, blackboard: Blackboard, inside: tuple[str, ...], depth: int) -> Behaviour:
        check_no_cycle(spec.subtree, inside, spec.where)
        own = _own_blackboard(spec, blackboard)
        body = self.build(self._specs[spec.subtree], own, (*inside, spec.subtree), depth + 1)
        set_blackboard(body, own)
        node = SubTree(spec.name, body)
        set_source(node, NodeSource(spec.subtree, NodeKind.SUBTREE, spec.port_texts))
        return node

    def _problem(self, what: str, where: Location) -> None:
        self.problems.append(Problem(what, where))


def _own_blackboard(spec: NodeSpec, above: Blackboard) -> Blackboard:
    """The blackboard of a subtree, with its remapped entries and constants."""
    values: Mapping[str, PortValue] = spec.values
    remapped = {name: value.key for name, value in values.items() if isinstance(value, Reference)}
    autoremap = parse_bool(dict(spec.port_texts).get("_autoremap", "false"))
    constants = {name: (value.value, value.text) for name, value in values.items() if isinstance(value, Literal)}
    return Blackboard(above, remapped, autoremap, constants)


def _bound(conditions: Mapping[str, Script], scope: Scope) -> Conditions:
    bound: dict[str, Any] = {
        field: BoundCondition(script, scope) if field in _PRE_CONDITIONS else BoundScript(script, scope)
        for field, script in conditions.items()
    }
    return Conditions(**bound)
