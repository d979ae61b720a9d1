"""Behaviour trees as BehaviorTree.CPP v4 XML that Groot2 opens and :func:`task_layer.bt.load_tree` reads."""

from __future__ import annotations

import re
from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from xml.etree import ElementTree as ET

from py_trees.behaviour import Behaviour

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from task_layer.bt.engine.conditions import conditions_of
from task_layer.bt.ports.port import REQUIRED, Port
from task_layer.bt.types.node_source import (
    CONDITION_ATTRIBUTES,
    KINDS_BY_TAG,
    NodeKind,
    NodeSource,
    kind_by_children,
    tree_id_of,
)
from task_layer.bt.types.parameter_text import NotWritableError, text_of
from task_layer.bt.types.vocabulary import is_built_in
from task_layer.bt.types.xml_source import xml_source
from task_layer.bt.xml.limits import MAX_DEPTH
from task_layer.bt.xml.node_uids import node_uids

_NAME = re.compile(r"[A-Za-z_][\w.-]*", re.ASCII)
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_TYPES = {str: "std::string", int: "int", float: "double", bool: "bool", object: "BT::AnyTypeAllowed"}


def save_tree(root: Behaviour, path: str | PathLike[str], *, tree_id: str | None = None) -> None:
    """Write a tree to an XML file that Groot2 opens and :func:`task_layer.bt.load_tree` reads.

    Args:
        root: the tree, loaded or written in Python.
        path: the file, which is replaced if it exists.
        tree_id: the ID of the main tree; by default the one that it was loaded with, or ``MainTree``.

    Raises:
        InputError: if a part of the tree cannot be written in XML, such as a condition that is a Python function, with
            all such parts; or the file cannot be written.
    """
    text = tree_xml(root, tree_id=tree_id)
    try:
        Path(path).write_text(text, encoding="utf-8")
    except (OSError, ValueError) as error:
        raise InputError(Problem(f"cannot write it: {error}", Location(str(path)))) from None


def tree_xml(root: Behaviour, *, identified: bool = False, tree_id: str | None = None) -> str:
    """The XML of a tree, for BehaviorTree.CPP v4 and Groot2.

    Args:
        root: the tree, loaded or written in Python.
        identified: whether it has the attributes ``_uid`` and ``_fullpath`` and one ``BehaviorTree`` for each SubTree
            node, as BehaviorTree.CPP sends it to Groot2. Such XML is shown, not loaded: parts that cannot be written
            are left out.
        tree_id: the ID of the main tree; by default the one that it was loaded with, or ``MainTree``.

    Returns:
        the text of the document.

    Raises:
        InputError: if a part of the tree cannot be written in XML, with all such parts.

    >>> from py_trees.behaviours import Success
    >>> from task_layer.bt import Inverter
    >>> print(tree_xml(Inverter("not done", Success("AlwaysSuccess")), tree_id="M"), end="")
    <root BTCPP_format="4" main_tree_to_execute="M">
      <BehaviorTree ID="M">
        <Inverter name="not done">
          <AlwaysSuccess />
        </Inverter>
      </BehaviorTree>
    </root>
    """
    return _Writer(root, identified).text(tree_id or tree_id_of(root) or "MainTree")


class _Writer:
    """Writes one tree."""

    def __init__(self, root: Behaviour, identified: bool) -> None:
        self._root = root
        self._identified = identified
        self._uids = node_uids(root)
        self._problems: list[Problem] = []
        self._models: dict[str, NodeSource] = {}
        self._bodies: dict[str, tuple[Behaviour, ET.Element]] = {}
        self._xml = ET.Element("root", BTCPP_format="4")

    def text(self, tree_id: str) -> str:
        """The whole document."""
        if not self._identified:
            self._xml.set("main_tree_to_execute", tree_id)
        self._tree(self._root, tree_id, "", 1)
        if self._models:
            models = ET.SubElement(self._xml, "TreeNodesModel")
            models.extend([_model(self._models[tag]) for tag in sorted(self._models)])
        if not self._identified:
            self._check_tree_names()
        for element in self._xml.iter():
            self._check_characters(element)
        if self._problems:
            raise InputError(self._problems)
        ET.indent(self._xml, "  ")
        return ET.tostring(self._xml, encoding="unicode") + "\n"

    def _tree(self, root: Behaviour, tree_id: str, path: str, depth: int) -> None:
        """Write the tree below ``root`` as a ``BehaviorTree``, and then those of its SubTree nodes."""
        tree = ET.Element("BehaviorTree", ID=tree_id)
        if self._identified:
            tree.set("_fullpath", path)
            self._xml.append(tree)
        elif tree_id in self._bodies:
            self._compare(root, tree_id, tree, depth)
            return
        else:
            self._bodies[tree_id] = (root, tree)
            self._xml.append(tree)
        self._body(root, tree, path, depth)

    def _compare(self, root: Behaviour, tree_id: str, tree: ET.Element, depth: int) -> None:
        self._body(root, tree, "", depth)
        if ET.tostring(tree) != ET.tostring(self._bodies[tree_id][1]):
            self._problem(root, f"it belongs to a second, different tree called '{tree_id}'", "rename one")

    def _body(self, root: Behaviour, tree: ET.Element, path: str, depth: int) -> None:
        subtrees: list[tuple[Behaviour, NodeSource, str, int]] = []
        to_do = [(root, tree, depth)]
        while to_do:
            node, parent, level = to_do.pop()
            if level > MAX_DEPTH:
                self._problem(node, f"it is more than {MAX_DEPTH} levels deep")
                break
            source = self._source(node)
            element = self._element(node, source, path)
            parent.append(element)
            if source.kind is NodeKind.SUBTREE:
                subtrees.append((node, source, element.get("_fullpath", ""), level + 1))
            else:
                to_do.extend((child, element, level + 1) for child in reversed(node.children))
        for node, source, its_path, level in subtrees:
            self._tree(node.children[0], source.tag, its_path, level)

    def _source(self, node: Behaviour) -> NodeSource:
        try:
            source = xml_source(node)
        except NotWritableError as error:
            source = NodeSource(type(node).__name__, kind_by_children(len(node.children)))
            if not self._identified:
                self._problem(node, str(error))
        if source.kind is not NodeKind.SUBTREE and not is_built_in(source.tag):
            known = self._models.setdefault(source.tag, source)
            if (known.kind, known.declared) != (source.kind, source.declared) and not self._identified:
                self._problem(node, f"it is a '{source.tag}' unlike another of that name", "rename one")
        return source

    def _element(self, node: Behaviour, source: NodeSource, path: str) -> ET.Element:
        if source.kind is NodeKind.SUBTREE:
            element = ET.Element("SubTree", ID=source.tag)
        elif _NAME.fullmatch(source.tag) and source.tag not in KINDS_BY_TAG:
            element = ET.Element(source.tag)
        else:
            element = ET.Element(source.kind.value, ID=source.tag)
        self._identify(element, node, source, path)
        for name, text in (*source.ports, *self._conditions(node)):
            if not (self._identified and name == "_autoremap"):  # BehaviorTree.CPP leaves it out as well
                element.set(name, text)
        return element

    def _identify(self, element: ET.Element, node: Behaviour, source: NodeSource, path: str) -> None:
        uid = str(self._uids[node.id])
        is_subtree = source.kind is NodeKind.SUBTREE
        if not is_subtree if self._identified else node.name != source.tag:
            element.set("name", node.name)
        if self._identified:
            if is_subtree:
                own = f"{source.tag}::{uid}" if node.name == source.tag else node.name
                element.set("_fullpath", f"{path}/{own}" if path else own)
            element.set("_uid", uid)

    def _conditions(self, node: Behaviour) -> Iterator[tuple[str, str]]:
        conditions = conditions_of(node)
        for attribute, field in CONDITION_ATTRIBUTES.items():
            condition = None if conditions is None else getattr(conditions, field)
            if condition is None:
                continue
            try:
                yield attribute, text_of(condition)
            except NotWritableError as error:
                if not self._identified:
                    self._problem(node, f"its {attribute} {error}", "write it as a script")

    def _check_tree_names(self) -> None:
        for tree_id, (root, _) in self._bodies.items():
            if is_built_in(tree_id) or tree_id in self._models:
                self._problem(root, f"its tree '{tree_id}' would have the name of a node", "give it another ID")

    def _check_characters(self, element: ET.Element) -> None:
        for name, text in element.items():
            if _NOT_XML.search(text):
                shown = element.get("name") or element.tag
                self._problems.append(Problem(f"{name} of '{shown}' has a character that XML cannot hold: {text!r}"))

    def _problem(self, node: Behaviour, what: str, hint: str | None = None) -> None:
        self._problems.append(Problem(f"'{node.name}' cannot be saved: {what}", None, hint))


def _model(source: NodeSource) -> ET.Element:
    element = ET.Element(source.kind.value, ID=source.tag)
    for port in source.declared:
        element.append(_port(port))
    return element


def _port(port: Port) -> ET.Element:
    element = ET.Element(port.direction.value, name=port.name, type=_TYPES.get(port.type, "std::string"))
    if port.default is not REQUIRED and port.default is not None:
        # A text may name an entry of the blackboard.
        element.set("default", port.default if isinstance(port.default, str) else text_of(port.default))
    element.text = port.description or None
    return element
