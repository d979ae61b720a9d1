"""How each node of a tree is written in XML: its tag, its category, and the texts of its ports."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from py_trees import behaviours, composites
from py_trees import decorators as stock_decorators
from py_trees.behaviour import Behaviour

from task_layer.bt.engine.status_changes import own_class
from task_layer.bt.leaves.action_ports import ACTION_NAME, action_ports
from task_layer.bt.leaves.function_leaves import Condition, InstantAction
from task_layer.bt.leaves.is_action_feasible import IsActionFeasible
from task_layer.bt.leaves.rosa_action import RosaAction
from task_layer.bt.nodes.branching import Switch
from task_layer.bt.nodes.decorators import SubTree
from task_layer.bt.types.node_source import NodeKind, NodeSource, source_of
from task_layer.bt.types.parameter_text import NotWritableError, text_of
from task_layer.bt.types.vocabulary import BUILT_IN, SWITCHES, is_built_in

_TAG_OF = {built_in.node: tag for tag, built_in in BUILT_IN.items() if built_in.node is not Switch}

_STOCK: dict[type[Behaviour], Callable[[Behaviour], str]] = {
    composites.Sequence: lambda node: "Sequence" if getattr(node, "memory", False) else "ReactiveSequence",
    composites.Selector: lambda node: "Fallback" if getattr(node, "memory", False) else "ReactiveFallback",
    stock_decorators.Inverter: lambda _: "Inverter",
    stock_decorators.FailureIsSuccess: lambda _: "ForceSuccess",
    stock_decorators.SuccessIsFailure: lambda _: "ForceFailure",
    behaviours.Success: lambda _: "AlwaysSuccess",
    behaviours.Failure: lambda _: "AlwaysFailure",
}


def xml_source(node: Behaviour) -> NodeSource:
    """How a node is written in XML: as it was loaded, or as it follows from its class.

    Raises:
        NotWritableError: if it cannot be written.
    """
    source = source_of(node)
    if source is not None:
        return source
    kind = own_class(node)
    if kind in _TAG_OF:
        return _built_in(node, _TAG_OF[kind])
    if kind in _STOCK:
        return _built_in(node, _STOCK[kind](node))
    if isinstance(node, Switch):
        return _switch(node)
    if isinstance(node, SubTree):
        return NodeSource(node.name, NodeKind.SUBTREE)
    if node.children:
        raise NotWritableError(f"BehaviorTree.CPP has no node like {kind.__module__}.{kind.__qualname__}")
    return _leaf(node)


def _built_in(node: Behaviour, tag: str) -> NodeSource:
    built_in = BUILT_IN[tag]
    values = ((port.name, getattr(node, port.name)) for port in built_in.ports)
    return NodeSource(tag, built_in.kind, tuple(_texts(values)), built_in.ports)


def _switch(node: Switch) -> NodeSource:
    if len(node.cases) not in SWITCHES:
        raise NotWritableError(f"it has {len(node.cases)} cases; in XML a Switch has {SWITCHES[0]} to {SWITCHES[-1]}")
    values = [("variable", node.variable), *((f"case_{n}", case) for n, case in enumerate(node.cases, start=1))]
    tag = f"Switch{len(node.cases)}"
    return NodeSource(tag, NodeKind.CONTROL, tuple(_texts(values)), BUILT_IN[tag].ports)


def _leaf(node: Behaviour) -> NodeSource:
    source = _leaf_source(node)
    if is_built_in(source.tag):
        raise NotWritableError(f"it would be written as '{source.tag}', which is the name of a built-in node")
    return source


def _leaf_source(node: Behaviour) -> NodeSource:
    if isinstance(node, IsActionFeasible):
        ports = _texts([("action_name", node.action_name)])
        return NodeSource("IsActionFeasible", NodeKind.CONDITION, tuple(ports), (ACTION_NAME,))
    if isinstance(node, RosaAction):
        ports = _texts([] if node.preference is None else [("preference", node.preference)])
        return NodeSource(node.action_name, NodeKind.ACTION, tuple(ports), action_ports(node.action_name))
    if isinstance(node, Condition):
        return NodeSource(node.name, NodeKind.CONDITION)
    return NodeSource(node.name if isinstance(node, InstantAction) else type(node).__name__)


def _texts(values: Iterable[tuple[str, object]]) -> Iterator[tuple[str, str]]:
    for name, value in values:
        try:
            yield name, text_of(value)
        except NotWritableError as error:
            raise NotWritableError(f"its {name} {error}") from None
