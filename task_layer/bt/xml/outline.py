"""Reads any BehaviorTree.CPP XML to be looked at: nobody needs to have registered its leaves.

What can be run is made by the loader, which knows every node and checks every port; here a node is a name with
children, whatever it is.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from rosa_core import InputError
from rosa_core.errors import Problem
from task_layer.bt.types.node_source import NodeKind, NodeSource, set_source, set_tree_id
from task_layer.bt.types.vocabulary import BUILT_IN
from task_layer.bt.xml.limits import MAX_DEPTH, MAX_OUTLINE_NODES
from task_layer.bt.xml.source import Element
from task_layer.bt.xml.tree_files import TreeFiles, read_tree_files

_CATEGORIES = {kind.value: kind for kind in NodeKind}
_NOT_PORTS = {"ID", "name", "_uid", "_fullpath"}
_WITHOUT_MEMORY = ("ReactiveSequence", "ReactiveFallback")


def read_outline(path: str | PathLike[str], tree: str | None = None) -> tuple[Behaviour, list[Problem]]:
    """The main tree of a file, subtrees included, as behaviours that can be displayed but do nothing.

    A SubTree that is in no file is a leaf. Each behaviour tells how it was written
    (:func:`~task_layer.bt.types.node_source.source_of`).

    Args:
        path: the XML file.
        tree: the ID of the tree; by default the one that would be run.

    Returns:
        the root; and what the loader would refuse, but does not keep the tree from being shown.

    Raises:
        InputError: if it is no XML or has entities, it is not clear which tree is meant, a tree is within itself, or
            is too deep or too large.
    """
    files = read_tree_files(Path(path))
    main = files.main_tree(tree)
    outline = _Outline(files)
    root = outline.node(outline.body(main), (main,), 1)
    set_tree_id(root, main)
    return root, files.problems


class _Outline:
    """The trees of a mission, as they are written."""

    def __init__(self, files: TreeFiles) -> None:
        self._files = files
        self._nodes = 0

    def node(self, element: Element, trees: tuple[str, ...], depth: int) -> Behaviour:
        """The node and all below it; ``trees`` are the IDs of those that it is in."""
        self._nodes += 1
        if depth > MAX_DEPTH:
            raise InputError(Problem(f"the tree is more than {MAX_DEPTH} levels deep", element.where))
        if self._nodes > MAX_OUTLINE_NODES:
            raise InputError(Problem(f"the tree has more than {MAX_OUTLINE_NODES} nodes", element.where))
        source = self._source(element)
        below = element.children
        if source.kind is NodeKind.SUBTREE and source.tag in self._files.trees:
            if source.tag in trees:
                names = " > ".join((*trees[trees.index(source.tag) :], source.tag))
                raise InputError(Problem(f"a tree contains itself: {names}", element.where))
            trees = (*trees, source.tag)
            below = [self.body(source.tag)]
        node = _behaviour(source, [self.node(child, trees, depth + 1) for child in below])
        node.name = element.attributes.get("name", source.tag)
        set_source(node, source)
        return node

    def body(self, tree: str) -> Element:
        """The node at the top of a tree."""
        element = self._files.trees[tree]
        if len(element.children) != 1:
            what = f"<BehaviorTree> has {len(element.children)} nodes in it"
            raise InputError(Problem(what, element.where, "it must have exactly one: its root"))
        return element.children[0]

    def _source(self, element: Element) -> NodeSource:
        if element.tag in _CATEGORIES:
            tag, kind = element.attributes.get("ID", element.tag), _CATEGORIES[element.tag]
        else:
            tag, kind = element.tag, self._kind(element)
        ports = tuple((name, text) for name, text in element.attributes.items() if name not in _NOT_PORTS)
        return NodeSource(tag, kind, ports)

    def _kind(self, element: Element) -> NodeKind:
        if element.tag in BUILT_IN:
            return BUILT_IN[element.tag].kind
        model = self._files.models.get(element.tag)
        return _GUESSED[min(len(element.children), 2)] if model is None else model.kind


_GUESSED = (NodeKind.ACTION, NodeKind.DECORATOR, NodeKind.CONTROL)
"""What an unknown node is, by the number of its children."""


class _OutlineLeaf(Behaviour):
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
    return composites.Sequence("", memory, children) if children else _OutlineLeaf("")
