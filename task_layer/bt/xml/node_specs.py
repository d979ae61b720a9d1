"""Specifications of nodes: the XML of trees, checked against the registry and the declarations in the files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from task_layer.bt.ports.bound_ports import Literal, PortValue, Reference, referenced_key
from task_layer.bt.ports.conversion import ConversionError, number_or_text, parse, type_name
from task_layer.bt.ports.port import OPTIONAL, REQUIRED, Direction, Port
from task_layer.bt.scripting import Script, ScriptError, compile_script
from task_layer.bt.types.built_in_types import built_in_types
from task_layer.bt.types.node_source import CONDITION_ATTRIBUTES, KINDS_BY_TAG, NodeKind
from task_layer.bt.types.node_type import NodeType
from task_layer.bt.types.registry import Registry
from task_layer.bt.types.vocabulary import CHILD_COUNTS, NOT_BUILT_IN, REPLACED, TIMES, is_built_in
from task_layer.bt.xml.leaf_types import LeafTypes, of_kind
from task_layer.bt.xml.problem_list import ProblemList, TooManyProblemsError
from task_layer.bt.xml.source import Element
from task_layer.bt.xml.tree_files import TreeFiles, root_problem, subtrees_in


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


class TreeSpecs:
    """The specifications of trees, and the problems of each; a tree is read when it is asked for.

    Args:
        files: the files that they are in.
        registry: the leaves.
    """

    def __init__(self, files: TreeFiles, registry: Registry) -> None:
        self._files = files
        self._registry = registry
        self._leaves = LeafTypes(registry, files.models)
        self._read: dict[str, tuple[NodeSpec | None, list[Problem]]] = {}

    def of(self, tree_id: str) -> NodeSpec | None:
        """The specification of a tree; None if it has problems that leave nothing of it."""
        return self._tree(tree_id)[0]

    def problems_of(self, tree_id: str) -> list[Problem]:
        """The problems of a tree, those of its subtrees left out."""
        return self._tree(tree_id)[1]

    def reached_from(self, main: str) -> list[str]:
        """The IDs of a tree and of all trees that it uses, directly or through others."""
        reached, to_do = {main: None}, [main]
        while to_do:
            for element in self._files.trees[to_do.pop()]:
                for tree_id in subtrees_in(element):
                    if tree_id in self._files.trees and tree_id not in reached:
                        reached[tree_id] = None
                        to_do.append(tree_id)
        return list(reached)

    def errors(self, main: str) -> list[Problem]:
        """The reasons why a tree cannot be run: problems of the trees that it uses, and of the files they are in."""
        reached = self.reached_from(main)
        files = {tree.where.file for tree_id in reached for tree in self._files.trees[tree_id]}
        found = self._files.faults_of(files)
        return [*found, *(problem for tree_id in reached for problem in self.problems_of(tree_id))]

    def warnings(self, main: str) -> list[Problem]:
        """Problems that do not count because nothing uses the tree or the default that they concern."""
        reached = set(self.reached_from(main))
        of_models = [warning for model in self._files.models.values() for warning in model.warnings]
        of_trees = [
            problem for tree_id in self._files.trees if tree_id not in reached for problem in self.problems_of(tree_id)
        ]
        errors = set(self.errors(main))
        return [problem for problem in (*of_models, *self._files.faults, *of_trees) if problem not in errors]

    def _tree(self, tree_id: str) -> tuple[NodeSpec | None, list[Problem]]:
        if tree_id not in self._read:
            reader = _SpecReader(tree_id, self._files, self._registry, self._leaves)
            spec = None
            try:
                spec = reader.tree(self._files.definition(tree_id))
            except InputError as error:
                reader.problems.found.extend(error.problems)
            except TooManyProblemsError:
                pass
            self._read[tree_id] = (spec, reader.problems.found)
        return self._read[tree_id]


class _SpecReader:
    """Checks the elements of one tree, and makes specifications of them."""

    def __init__(self, tree_id: str, files: TreeFiles, registry: Registry, leaves: LeafTypes) -> None:
        self.problems = ProblemList()
        self._tree_id = tree_id
        self._files = files
        self._registry = registry
        self._leaves = leaves
        self._subtree_names: set[str] = set()

    def tree(self, element: Element) -> NodeSpec | None:
        """The specification of the root of a ``BehaviorTree`` element."""
        problem = root_problem(element)
        if problem is not None:
            self.problems.add(problem.what, problem.where, problem.hint)
        if is_built_in(self._tree_id) or self._tree_id in self._leaves:
            self._problem(f"the tree '{self._tree_id}' has the name of a node", element, "give it another ID")
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
            self._check_time(element, node_type, values)
            self._check_reactive(element, node_type)
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
        if not tree_id:
            self._problem("<SubTree> without an ID", element)
            return None
        if tree_id not in self._files.trees:
            what, hint = self._files.missing(tree_id, self._tree_id)
            self._problem(what, element, hint)
            return None
        if element.children:
            self._problem("<SubTree> cannot have children", element)
        self._check_subtree_name(element)
        autoremap = element.get("_autoremap")
        is_autoremapped = False
        if autoremap is not None:
            literal = self._converted("_autoremap", autoremap, bool, element)
            is_autoremapped = literal is not None and bool(literal.value)
        texts = dict(self._ports(element))
        if not is_autoremapped:
            texts |= self._modelled(tree_id, texts, element)
        port_texts = (*texts.items(), *(() if autoremap is None else (("_autoremap", autoremap),)))
        return NodeSpec(
            name=element.get("name") or tree_id,
            type=None,
            subtree=tree_id,
            values={name: _subtree_value(name, text) for name, text in texts.items()},
            port_texts=port_texts,
            conditions=dict(self._conditions(element)),
            children=(),
            where=element.where,
        )

    def _check_subtree_name(self, element: Element) -> None:
        name = element.get("name")
        if name and name in self._subtree_names:
            what = f"there is a second SubTree named '{name[:60]}' in this tree"
            self._problem(what, element, "give it another name, or leave the name out")
        self._subtree_names.add(name or "")

    def _modelled(self, tree_id: str, texts: Mapping[str, str], element: Element) -> dict[str, str]:
        """The defaults that the model of a subtree has for ports that are left out; those without one are demanded."""
        model = self._files.models.get(tree_id)
        if model is None or model.kind is not NodeKind.SUBTREE:
            return {}
        left_out = [port for port in model.ports if port.name not in texts]
        for port in left_out:
            if port.default in (REQUIRED, ""):
                hint = f'write {port.name}="...", or _autoremap="true"'
                self._problem(f"the SubTree '{tree_id[:60]}' needs the port '{port.name[:60]}'", element, hint)
        return {port.name: str(port.default) for port in left_out if port.default not in (REQUIRED, "")}

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
        node_type = built_in_types().get(tag)
        if node_type is None:
            node_type, contradictions = self._leaves.get(tag)
            for problem in contradictions:
                self.problems.add(problem.what, problem.where, problem.hint)
        if node_type is None:
            self._unknown(tag, element)
        elif element.tag in KINDS_BY_TAG and tag not in self._files.models:
            node_type = of_kind(node_type, NodeKind(element.tag))
        return node_type

    def _unknown(self, tag: str, element: Element) -> None:
        if tag in self._files.trees:
            self._problem(f"'{tag}' is a tree, not a node", element, f'write <SubTree ID="{tag}"/>')
        elif tag in NOT_BUILT_IN:
            self._problem(f"the node '{tag}' of BehaviorTree.CPP is not built in", element, NOT_BUILT_IN[tag])
        elif tag in REPLACED:
            self._problem(f"the node '{tag}' is of BehaviorTree.CPP v3", element, f"write {REPLACED[tag]}")
        else:
            hint = nearest(tag[:60], [*built_in_types(), *self._leaves.names(), NodeKind.SUBTREE.value])
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

    def _check_time(self, element: Element, node_type: NodeType, values: Mapping[str, PortValue]) -> None:
        name = TIMES.get(node_type.tag)
        value = None if name is None else values.get(name)
        if isinstance(value, Literal) and value.value < 0:
            self._problem(f"{name} is {value.value}: a time cannot be negative", element, "a number of ms, 0 or more")

    def _check_reactive(self, element: Element, node_type: NodeType) -> None:
        yielding = [child for child in element.children if _tag_of(child) == "AsyncSequence"]
        if node_type.tag == "ReactiveSequence" and len(yielding) > 1:
            what = "a ReactiveSequence cannot have more than one AsyncSequence: each would interrupt the other"
            self._problem(what, yielding[1], "put them into one AsyncSequence, or into a Sequence")

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
        elif port.default is OPTIONAL:
            return
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
        if port.direction is Direction.OUT:
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
        self.problems.add(what, element.where, hint)


_CONDITIONS_BY_LOWER_CASE = {name.lower(): name for name in CONDITION_ATTRIBUTES}


def _tag_of(element: Element) -> str:
    """The name that an element's node is registered under."""
    return (element.get("ID") or "") if element.tag in KINDS_BY_TAG else element.tag


def _subtree_value(name: str, text: str) -> PortValue:
    """A port of a SubTree: an entry of the tree above, a number, or a text."""
    key = referenced_key(text, name)
    return Literal(number_or_text(text), text) if key is None else Reference(key, text)
