"""The types of leaves that a tree may use: those of the registry, completed by the models in its files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from rosa_core.errors import Problem, nearest
from task_layer.bt.ports.port import OPTIONAL, REQUIRED, Port
from task_layer.bt.types.node_source import NodeKind
from task_layer.bt.types.node_type import NodeType
from task_layer.bt.types.registry import Registry
from task_layer.bt.xml.node_models import NodeModel


class LeafTypes:
    """The registered types by name, as the models complete them.

    Args:
        registry: the leaves.
        models: the entries of all TreeNodesModels, by ID.
    """

    def __init__(self, registry: Registry, models: Mapping[str, NodeModel]) -> None:
        self._registry = registry
        self._models = {tag: model for tag, model in models.items() if model.kind is not NodeKind.SUBTREE}
        self._known: dict[str, tuple[NodeType, list[Problem]]] = {}

    def get(self, tag: str) -> tuple[NodeType | None, Iterable[Problem]]:
        """The type of that name, if there is one, and where its model contradicts it."""
        if tag not in self._known:
            leaf = self._registry.get(tag)
            if leaf is None:
                return None, ()
            model = self._models.get(tag)
            self._known[tag] = (leaf, []) if model is None else _with_model(leaf, model)
        return self._known[tag]

    def names(self) -> list[str]:
        """The names of all types."""
        return self._registry.names()

    def __contains__(self, tag: str) -> bool:
        return tag in self._registry


def of_kind(leaf: NodeType, kind: NodeKind) -> NodeType:
    """A type of leaves as the action or condition that the XML calls it: that does not follow from a function."""
    kinds = (NodeKind.ACTION, NodeKind.CONDITION)
    return replace(leaf, kind=kind) if kind in kinds and leaf.kind in kinds and kind is not leaf.kind else leaf


def _with_model(leaf: NodeType, model: NodeModel) -> tuple[NodeType, list[Problem]]:
    leaf = of_kind(leaf, model.kind)
    declared = {port.name: port for port in leaf.ports}
    if not declared:
        # A leaf that declares no ports has those of the model; Groot2 lists ports there that may be left out.
        return replace(leaf, ports=optional(model.ports)), []
    problems = []
    for port in model.ports:
        own = declared.get(port.name)
        if own is None:
            what = f"the model of '{leaf.tag}' has a port '{port.name[:60]}', which the registered leaf has not"
            problems.append(Problem(what, model.where, nearest(port.name[:60], declared)))
        elif own.direction is not port.direction:
            what = f"the port '{port.name}' of '{leaf.tag}' is an {own.direction.value}, not an {port.direction.value}"
            problems.append(Problem(what, model.where))
        else:
            declared[port.name] = _with_default(own, port)
    return replace(leaf, ports=tuple(declared.values())), problems


def optional(ports: Iterable[Port]) -> tuple[Port, ...]:
    """The ports, of which those without a default may be left out."""
    return tuple(replace(port, default=OPTIONAL) if port.default is REQUIRED else port for port in ports)


def _with_default(own: Port, modelled: Port) -> Port:
    default = modelled.default if own.default is REQUIRED else own.default
    return replace(own, default=default, description=own.description or modelled.description)
