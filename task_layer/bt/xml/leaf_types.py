"""The types of leaves that a tree may use: those of the registry, completed by the TreeNodesModel of its files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rosa_core.errors import Problem, nearest
from task_layer.bt.ports.port import REQUIRED, Port
from task_layer.bt.types.node_source import NodeKind
from task_layer.bt.types.node_type import NodeType
from task_layer.bt.types.registry import Registry
from task_layer.bt.xml.tree_files import NodeModel, TreeFiles


def leaf_types(files: TreeFiles, registry: Registry) -> Mapping[str, NodeType]:
    """The registered types by name; contradictions are added to the problems of ``files``."""
    leaves = {name: leaf for name in registry.names() if (leaf := registry.get(name)) is not None}
    for tag, model in files.models.items():
        if model.kind is not NodeKind.SUBTREE and tag in leaves:
            leaves[tag] = _with_model(leaves[tag], model, files)
    return leaves


def of_kind(leaf: NodeType, kind: NodeKind) -> NodeType:
    """A type of leaves as the action or condition that the XML calls it: that does not follow from a function."""
    kinds = (NodeKind.ACTION, NodeKind.CONDITION)
    return replace(leaf, kind=kind) if kind in kinds and leaf.kind in kinds and kind is not leaf.kind else leaf


def _with_model(leaf: NodeType, model: NodeModel, files: TreeFiles) -> NodeType:
    leaf = of_kind(leaf, model.kind)
    declared = {port.name: port for port in leaf.ports}
    if not declared:
        # A leaf that declares no ports has those of the model.
        return replace(leaf, ports=model.ports)
    for port in model.ports:
        own = declared.get(port.name)
        if own is None:
            what = f"the model of '{leaf.tag}' has a port '{port.name[:60]}', which the registered leaf has not"
            files.report(Problem(what, model.where, nearest(port.name[:60], declared)))
        elif own.direction is not port.direction:
            what = f"the port '{port.name}' of '{leaf.tag}' is an {own.direction.value}, not an {port.direction.value}"
            files.report(Problem(what, model.where))
        else:
            declared[port.name] = _with_default(own, port)
    return replace(leaf, ports=tuple(declared.values()))


def _with_default(own: Port, modelled: Port) -> Port:
    default = modelled.default if own.default is REQUIRED else own.default
    return replace(own, default=default, description=own.description or modelled.description)
