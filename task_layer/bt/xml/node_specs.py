"""Specifications of nodes: the XML of trees, checked against the registry and the declarations in the files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rosa_core.errors import Location, Problem, nearest
from task_layer.bt.ports.bound_ports import Literal, PortValue, Reference, referenced_key
from task_layer.bt.ports.conversion import ConversionError, parse, type_name
from task_layer.bt.ports.port import REQUIRED, Direction, Port
from task_layer.bt.scripting import Script, ScriptError, compile_script
from task_layer.bt.types.built_in_types import built_in_types
from task_layer.bt.types.node_source import CONDITION_ATTRIBUTES, KINDS_BY_TAG, NodeKind
from task_layer.bt.types.node_type import NodeType
from task_layer.bt.types.registry import Registry
from task_layer.bt.types.vocabulary import CHILD_COUNTS, NOT_SUPPORTED, REPLACED
from task_layer.bt.xml.leaf_types import leaf_types, of_kind
from task_layer.bt.xml.source import Element
from task_layer.bt.xml.tree_files import TreeFiles, root_problem


@dataclass(frozen=True, slots=True)
class NodeSpec:
    """The specification of a node, of which any number of nodes can be made.

    Attributes:
        name: its name in the tree.
        type: its type; None for a SubTree.
        subtree: of a SubTree, the ID of its tree.
        values: the values of its ports, defaults included.
        port_texts: names and texts of the ports in its XML.
        conditions: its pre- and post-conditions, by the field of ``Conditions``.
        children: its children.
        where: its place in the file.
    """

    name: str
    type: NodeType | None
    subtree: str
    values: Mapping[str, PortValue]
    port_texts: tuple[tuple[str, str], ...]
    conditions: Mapping[str, Script]
    children: tuple[NodeSpec, ...]
    where: Location


def tree_specs(files: TreeFiles, registry: Registry) -> dict[str, NodeSpec]:
    """The specification of each tree by its ID; problems are added to those of ``files``."""
    reader = _SpecReader(files, registry)
    specs = {}
    for tree_id, element in files.trees.items():
        spec = reader.tree(element)
        if spec is not None:
            specs[tree_id] = spec
    return specs


class _SpecReader:
    """Checks elements, and makes specifications of them."""

    def __init__(self, files: TreeFiles, registry: Registry) -> None:
        self._files = files
        self._registry = registry
        self._leaves = leaf_types(files, registry)

    def tree(self, element: Element) -> NodeSpec | None:
        """The specification of the root of a ``BehaviorTree`` element."""
        problem = root_problem(element)
        if problem is not None:
            self._files.report(problem)
        specs = [self._node(child) for child in element.children]
        return specs[0] if specs else None

    def _node(self, element: Element) -> NodeSpec | None:
        if element.tag == NodeKind.SUBTREE.value:
            return self._subtree(element)
        node_type = self._type(element)
        values: dict[str, PortValue] = {}
        if node_type is not None:
            self._check_children(element, node_type)
            values |= self._values(element, node_type)
            self._check_child_counts(element, node_type, values)
        conditions = dict(self._conditions(element))
        children = tuple(spec for spec in map(self._node, element.children) if spec is not None)
        if node_type is None:
            return None
        return NodeSpec(
            name=element.get("name") or node_type.tag,
            type=node_type,
            subtree="",
            values=values,
            port_texts=tuple((name, text) for name, text in self._ports(element) if name in values),
            conditions=conditions,
            children=children,
            where=element.where,
        )

    def _subtree(self, element: Element) -> NodeSpec | None:
        tree_id = element.get("ID")
        if tree_id not in self._files.trees:
            what = "<SubTree> without an ID" if tree_id is None else f"there is no tree '{tree_id[:60]}'"
            self._problem(what, element, nearest((tree_id or "")[:60], self._files.trees))
            return None
        if element.children:
            self._problem("<SubTree> cannot have children", element)
        texts = dict(self._ports(element))
        model = self._files.models.get(tree_id)
        for port in model.ports if model is not None and model.kind is NodeKind.SUBTREE else ():
            if port.default is not REQUIRED and port.name not in texts:
                texts[port.name] = str(port.default)
        autoremap = element.get("_autoremap")
        port_texts = (*texts.items(), *(() if autoremap is None else (("_autoremap", autoremap),)))
        if autoremap is not None:
            self._converted("_autoremap", autoremap, bool, element)
        values = {name: _value(name, text) for name, text in texts.items()}
        return NodeSpec(
            name=element.get("name") or tree_id,
            type=None,
            subtree=tree_id,
            values=values,
            port_texts=port_texts,
            conditions=dict(self._conditions(element)),
            children=(),
            where=element.where,
        )

    def _type(self, element: Element) -> NodeType | None:
        tag = element.tag
        if tag in KINDS_BY_TAG:
            named = element.get("ID")
            if not named:
                self._problem(f"<{tag}> without an ID", element, f'write <{tag} ID="..."/>')
                return None
            tag = named
        elif "ID" in element.attributes:
            self._problem(f"<{tag[:60]}> cannot have an ID", element, f'write name="..." or <Action ID="{tag[:60]}">')
        node_type = built_in_types().get(tag) or self._leaves.get(tag)
        if node_type is None:
            self._unknown(tag, element)
        elif element.tag in KINDS_BY_TAG and tag not in self._files.models:
            node_type = of_kind(node_type, NodeKind(element.tag))
        return node_type

    def _unknown(self, tag: str, element: Element) -> None:
        if tag in self._files.trees:
            self._problem(f"'{tag}' is a tree, not a node", element, f'write <SubTree ID="{tag}"/>')
        elif tag in NOT_SUPPORTED:
            self._problem(f"the node '{tag}' of BehaviorTree.CPP is not supported", element)
        elif tag in REPLACED:
            self._problem(f"the node '{tag}' is of BehaviorTree.CPP v3", element, f"write {REPLACED[tag]}")
        else:
            hint = nearest(tag[:60], [*built_in_types(), *self._leaves, NodeKind.SUBTREE.value])
            self._problem(f"unknown node '{tag[:60]}'", element, hint or "register it, or declare the tree")

    def _check_children(self, element: Element, node_type: NodeType) -> None:
        least, most = node_type.children
        count = len(element.children)
        if least <= count and (most is None or count <= most):
            return
        if most is None:
            wanted = f"at least {least}"
        elif most == 0:
            wanted = "none"
        else:
            wanted = f"{least}" if least == most else f"{least} to {most}"
        self._problem(f"<{element.tag}> has {count} children", element, f"{node_type.tag} takes {wanted}")

    def _check_child_counts(self, element: Element, node_type: NodeType, values: Mapping[str, PortValue]) -> None:
        count = len(element.children)
        for port in CHILD_COUNTS.get(node_type.tag, ()):
            value = values.get(port)
            if isinstance(value, Literal) and value.value > count:
                what = f"{port} is {value.value}, but <{element.tag}> has {count} children"
                self._problem(what, element, f"at most {count}, or -1 for all of them")

    def _ports(self, element: Element) -> Iterator[tuple[str, str]]:
        """The attributes that are ports."""
        for name, text in element.attributes.items():
            if name not in ("ID", "name") and not name.startswith("_"):
                yield name, text

    def _values(self, element: Element, node_type: NodeType) -> Iterator[tuple[str, PortValue]]:
        declared = {port.name: port for port in node_type.ports}
        for name, text in self._ports(element):
            port = declared.get(name)
            if port is None:
                known = f"it has {', '.join(declared)}" if declared else "it has none"
                hint = nearest(name[:60], declared) or known
                self._problem(f"{node_type.tag} has no port '{name[:60]}'", element, hint)
                continue
            value = self._port_value(port, text, element)
            if value is not None:
                yield name, value
        for port in node_type.ports:
            if port.name not in element.attributes:
                yield from self._default(port, element, node_type)

    def _default(self, port: Port, element: Element, node_type: NodeType) -> Iterator[tuple[str, PortValue]]:
        if isinstance(port.default, str):
            value = self._port_value(port, port.default, element)
            if value is not None:
                yield port.name, value
        elif port.default is not REQUIRED:
            yield port.name, Literal(port.default, str(port.default))
        elif port.direction is not Direction.OUT:
            self._problem(f"{node_type.tag} needs the port '{port.name}'", element, f'write {port.name}="..."')

    def _port_value(self, port: Port, text: str, element: Element) -> PortValue | None:
        if port.type is Script:
            script = self._script(port.name, text, element)
            return None if script is None else Literal(script, text)
        key = referenced_key(text, port.name)
        if key is not None:
            return Reference(key, text)
        if port.direction is not Direction.IN:
            hint = f'write {port.name}="{{{text.strip()[:60] or "key"}}}"'
            self._problem(f"the port '{port.name}' must name an entry of the blackboard", element, hint)
            return None
        return self._converted(port.name, text, port.type, element)

    def _converted(self, name: str, text: str, kind: object, element: Element) -> Literal | None:
        try:
            return Literal(parse(text, kind), text)
        except ConversionError as error:
            self._problem(f"{name}: {error}", element, f"a value of type {type_name(kind)}, or {{key}}")
            return None

    def _conditions(self, element: Element) -> Iterator[tuple[str, Script]]:
        for name, text in element.attributes.items():
            if name in CONDITION_ATTRIBUTES:
                script = self._script(name, text, element)
                if script is not None:
                    yield CONDITION_ATTRIBUTES[name], script
            elif name.lower() in _CONDITIONS_BY_LOWER_CASE:
                self._problem(
                    f"unknown attribute '{name}'", element, f"did you mean '{_CONDITIONS_BY_LOWER_CASE[name.lower()]}'?"
                )

    def _script(self, name: str, text: str, element: Element) -> Script | None:
        try:
            script = compile_script(text)
        except ScriptError as error:
            self._problem(f"{name}: {error}", element)
            return None
        if not script.statements and name != "code":
            self._problem(f"{name}: the script is empty", element, "leave it out")
        return script

    def _problem(self, what: str, element: Element, hint: str | None = None) -> None:
        self._files.report(Problem(what, element.where, hint))


_CONDITIONS_BY_LOWER_CASE = {name.lower(): name for name in CONDITION_ATTRIBUTES}


def _value(name: str, text: str) -> PortValue:
    key = referenced_key(text, name)
    return Literal(text, text) if key is None else Reference(key, text)
