"""Reads any BehaviorTree.CPP XML in order to show it: its leaves need not be registered.

The loader makes trees that can be run; it knows every node and checks every port. Here a node is a name with children.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from rosa_core import InputError
from rosa_core.errors import Problem
from task_layer.bt.types.node_source import (
    KINDS_BY_TAG,
    NodeKind,
    NodeSource,
    kind_by_children,
    set_source,
    set_tree_id,
)
from task_layer.bt.types.vocabulary import BUILT_IN
from task_layer.bt.xml.file_reader import NO_PACKAGES, AnyPath, Packages, read_tree_files
from task_layer.bt.xml.limits import MAX_DEPTH, MAX_OUTLINE_NODES
from task_layer.bt.xml.source import Element
from task_layer.bt.xml.tree_files import TreeFiles, check_no_cycle, root_problem

_NOT_PORTS = {"ID", "name", "_uid", "_fullpath"}
_WITHOUT_MEMORY = ("ReactiveSequence", "ReactiveFallback")


def read_outline(
    path: AnyPath | Sequence[AnyPath],
    tree: str | None = None,
    *,
    nodes: Iterable[AnyPath] = (),
    ros_packages: Packages = NO_PACKAGES,
) -> tuple[Behaviour, list[Problem]]:
    """The main tree of a file or project, subtrees included, as behaviours that can be shown but not ticked.

    A SubTree that is in no file is a leaf. How each behaviour was written is its
    :func:`~task_layer.bt.types.node_source.source_of`.

    Args:
        path: the XML file, several files, or the folder of a project.
        tree: the ID of the tree; by default the one that would be run.
        nodes: files with models of nodes.
        ros_packages: the folders that ``<include ros_pkg=...>`` means, by the packages' names.

    Returns:
        the root; and problems for which the loader would refuse the tree, but which do not prevent showing it.

    Raises:
        InputError: if it is no XML or has entities, it is not clear which tree is meant, or a tree contains itself, is
            too deep or too large.
    """
    files = read_tree_files(path, nodes=nodes, ros_packages=ros_packages)
    main = files.main_tree(tree)
    outline = _Outline(files)
    root = outline.node(outline.body(main), (main,), 1)
    set_tree_id(root, main)
    return root, [*files.faults_of(outline.files_used), *outline.problems]


class _Outline:
    """Makes behaviours of elements."""

    def __init__(self, files: TreeFiles) -> None:
        self._files = files
        self._nodes = 0
        self.files_used: set[str] = set()
        self.problems: list[Problem] = []

    def node(self, element: Element, trees: tuple[str, ...], depth: int) -> Behaviour:
        """The behaviour of an element, with all below it; ``trees`` are the IDs of the trees that it is in."""
        self._nodes += 1
        if depth > MAX_DEPTH:
            raise InputError(Problem(f"the tree is more than {MAX_DEPTH} levels deep", element.where))
        if self._nodes > MAX_OUTLINE_NODES:
            raise InputError(Problem(f"the tree has more than {MAX_OUTLINE_NODES} nodes", element.where))
        source = self._source(element)
        below = element.children
        if source.kind is NodeKind.SUBTREE and source.tag in self._files.trees:
            check_no_cycle(source.tag, trees, element.where)
            trees = (*trees, source.tag)
            below = [self.body(source.tag)]
        elif source.kind is NodeKind.SUBTREE:
            what, hint = self._files.missing(source.tag, trees[-1])
            self.problems.append(Problem(what, element.where, hint))
        node = _behaviour(source, [self.node(child, trees, depth + 1) for child in below])
        node.name = element.attributes.get("name", source.tag)
        set_source(node, source)
        return node

    def body(self, tree: str) -> Element:
        """The element at the top of a tree."""
        element = self._files.definition(tree)
        self.files_used.add(element.where.file)
        problem = root_problem(element)
        if problem is not None:
            raise InputError(problem)
        return element.children[0]

    def _source(self, element: Element) -> NodeSource:
        if element.tag in KINDS_BY_TAG:
            tag, kind = element.attributes.get("ID", element.tag), KINDS_BY_TAG[element.tag]
        else:
            tag, kind = element.tag, self._kind(element)
        ports = tuple((name, text) for name, text in element.attributes.items() if name not in _NOT_PORTS)
        return NodeSource(tag, kind, ports)

    def _kind(self, element: Element) -> NodeKind:
        if element.tag in BUILT_IN:
            return BUILT_IN[element.tag].kind
        model = self._files.models.get(element.tag)
        return kind_by_children(len(element.children)) if model is None else model.kind


class _OutlineLeaf(Behaviour):
    """A leaf that is shown."""

    def update(self) -> Status:
        """Never ticked."""
        return Status.FAILURE


def _behaviour(source: NodeSource, children: list[Behaviour]) -> Behaviour:
    """A behaviour that py_trees displays with the symbol of the node."""
    memory = source.tag not in _WITHOUT_MEMORY
    if "Parallel" in source.tag and children:
        return composites.Parallel("", ParallelPolicy.SuccessOnAll(), children)
    if source.tag.endswith("Fallback") and children:
        return composites.Selector("", memory, children)
    if len(children) == 1 and source.kind in (NodeKind.DECORATOR, NodeKind.SUBTREE):
        return decorators.PassThrough("", children[0])
    return composites.Sequence("", memory, children) if children else _OutlineLeaf("")
