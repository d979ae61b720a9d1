"""Reads any BehaviorTree.CPP XML to be looked at: nobody needs to have registered its leaves.

What can be run is made by the loader, which knows every node and checks every port; here a node is a name with
children, whatever it is.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from xml.etree import ElementTree as ET

from defusedxml import DefusedXmlException
from defusedxml import ElementTree as SafeET
from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from task_layer.bt.node_source import NodeKind, NodeSource, set_source
from task_layer.bt.xml_vocabulary import BUILT_IN, DEEPEST

MOST_NODES = 10_000
"""Nobody can look at more; subtrees within subtrees may be many more than there are lines in the file."""

_CATEGORIES = {kind.value: kind for kind in NodeKind}
_NOT_PORTS = {"ID", "name", "_uid", "_fullpath", "_autoremap"}
_WITHOUT_MEMORY = ("ReactiveSequence", "ReactiveFallback")


def read_outline(path: str | PathLike[str]) -> Behaviour:
    """The main tree of a file, subtrees included, as behaviours that can be displayed but do nothing.

    A SubTree that the file does not hold is a leaf. Each behaviour tells how it was written
    (:func:`~task_layer.bt.node_source.source_of`).

    Raises:
        InputError: if it cannot be read, is no XML or has entities, is no behaviour tree, has a subtree within itself,
            or is too deep or too large.
    """
    where = Location(str(path))
    try:
        root = SafeET.fromstring(Path(path).read_bytes(), forbid_dtd=True)
    except ET.ParseError as error:
        problem = Problem(f"this is not XML: {error.msg}", Location(str(path), error.position[0]))
        raise InputError(problem) from None
    except DefusedXmlException:
        mend = "take the document type declaration and its entities out"
        raise InputError(Problem("XML with its own entities is not read", where, mend)) from None
    except (OSError, ValueError, LookupError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise InputError(Problem(f"cannot read it: {reason}", where)) from None
    return _Outline(root, where).main_tree()


class _Outline:
    """The trees of one file."""

    def __init__(self, root: ET.Element, where: Location) -> None:
        self._where = where
        self._kinds = {model.get("ID"): model.tag for model in root.iterfind("TreeNodesModel/*")}
        self._trees = {tree.get("ID", ""): tree for tree in root.iterfind("BehaviorTree")}
        self._main = root.get("main_tree_to_execute") or next(iter(self._trees), "")
        self._nodes = 0
        if root.tag != "root" or not self._trees:
            mend = "a file of BehaviorTree.CPP or Groot2 has <BehaviorTree> in <root>"
            raise self._refused("there is no behaviour tree in this file", mend)

    def main_tree(self) -> Behaviour:
        """The tree that the file is about."""
        if self._main not in self._trees:
            raise self._refused(f"there is no tree '{self._main}'", nearest(self._main, self._trees))
        return self._node(self._body(self._main), (self._main,), 1)

    def _node(self, element: ET.Element, trees: tuple[str, ...], depth: int) -> Behaviour:
        """The node and all below it; ``trees`` are the IDs of those that it is in."""
        self._nodes += 1
        if depth > DEEPEST:
            raise self._refused(f"the tree is more than {DEEPEST} levels deep")
        if self._nodes > MOST_NODES:
            raise self._refused(f"the tree has more than {MOST_NODES} nodes")
        source = self._source(element)
        within = trees
        if source.kind is NodeKind.SUBTREE and source.tag in self._trees:
            if source.tag in trees:
                raise self._refused(f"the tree '{source.tag}' is within itself: {' > '.join((*trees, source.tag))}")
            within = (*trees, source.tag)
            below = [self._body(source.tag)]
        else:
            below = list(element)
        node = _behaviour(source, [self._node(child, within, depth + 1) for child in below])
        node.name = element.get("name", source.tag)
        set_source(node, source)
        return node

    def _body(self, tree: str) -> ET.Element:
        body = list(self._trees[tree])
        if len(body) != 1:
            raise self._refused(f"the tree '{tree}' must have one node at its top, not {len(body)}")
        return body[0]

    def _source(self, element: ET.Element) -> NodeSource:
        tag = element.get("ID", element.tag) if element.tag in _CATEGORIES else element.tag
        if element.tag in _CATEGORIES:
            kind = _CATEGORIES[element.tag]
        elif tag in BUILT_IN:
            kind = BUILT_IN[tag].kind
        else:
            kind = _CATEGORIES.get(self._kinds.get(tag, ""), _GUESSED[min(len(element), 2)])
        ports = tuple((name, text) for name, text in element.items() if name not in _NOT_PORTS)
        return NodeSource(tag, kind, ports)

    def _refused(self, what: str, mend: str | None = None) -> InputError:
        return InputError(Problem(what, self._where, mend))


_GUESSED = (NodeKind.ACTION, NodeKind.DECORATOR, NodeKind.CONTROL)
"""What an unknown node is, by the number of its children."""


class _Looks(Behaviour):
    """A leaf to be looked at."""

    def update(self) -> Status:
        """Never ticked."""
        return Status.FAILURE


def _behaviour(source: NodeSource, children: list[Behaviour]) -> Behaviour:
    """What py_trees displays as the node ought to be displayed."""
    memory = source.tag not in _WITHOUT_MEMORY
    if "Parallel" in source.tag and children:
        return composites.Parallel("", ParallelPolicy.SuccessOnAll(), children)
    if source.tag.endswith("Fallback") and children:
        return composites.Selector("", memory, children)
    if len(children) == 1 and source.kind in (NodeKind.DECORATOR, NodeKind.SUBTREE):
        return decorators.PassThrough("", children[0])
    return composites.Sequence("", memory, children) if children else _Looks("")
