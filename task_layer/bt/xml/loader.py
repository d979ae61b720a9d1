"""Loads BehaviorTree.CPP v4 XML, as Groot2 saves it, as py_trees behaviours."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from py_trees.behaviour import Behaviour

from rosa_core import InputError
from rosa_core.errors import Problem
from task_layer.bt.engine.failing import Leaf, let_fail
from task_layer.bt.engine.node import Node
from task_layer.bt.ports.blackboard import Blackboard
from task_layer.bt.tree_source import TreeSource
from task_layer.bt.types.node_source import set_blackboard, set_tree_id
from task_layer.bt.types.registry import Registry
from task_layer.bt.xml.file_reader import NO_PACKAGES, AnyPath, Packages, read_tree_files
from task_layer.bt.xml.node_specs import NodeSpec, TreeSpecs
from task_layer.bt.xml.problem_list import first_problems
from task_layer.bt.xml.tree_builder import TreeBuilder
from task_layer.bt.xml.tree_files import TreeFiles

_log = logging.getLogger("task_layer.bt")


def load_tree(
    path: AnyPath | Sequence[AnyPath],
    registry: Registry | Mapping[str, Any],
    *,
    tree: str | None = None,
    blackboard: Blackboard | None = None,
    nodes: Iterable[AnyPath] = (),
    ros_packages: Packages = NO_PACKAGES,
) -> Behaviour:
    """Load a behaviour tree from BehaviorTree.CPP v4 XML.

    A fault in a tree that is not used is logged as a warning.

    Args:
        path: the XML file, several files, the folder of a project, or a :class:`~task_layer.bt.TreeSource`, which
            says all but ``blackboard``.
        registry: the leaves by name: a :class:`~task_layer.bt.types.registry.Registry`, or a dictionary of leaves.
        tree: the ID of the tree to be run; by default ``main_tree_to_execute``, or the only one there is.
        blackboard: the main tree's blackboard, for a caller that writes or reads it.
        nodes: files with models of nodes (``TreeNodesModel``), such as Nav2's ``nav2_tree_nodes.xml``.
        ros_packages: the folders that ``<include ros_pkg=...>`` means, by the packages' names.

    Returns:
        the root of the tree.

    Raises:
        InputError: if the tree cannot be used, with all its problems: each with file and line, and a hint where there
            is one.
    """
    if isinstance(path, TreeSource):
        tree, nodes, ros_packages = tree or path.tree, (*nodes, *path.nodes), {**path.ros_packages, **ros_packages}
    project = load_trees(path, registry, nodes=nodes, ros_packages=ros_packages)
    root = project.build(tree, blackboard=blackboard)
    for warning in () if project.is_folder else project.warnings(tree):
        _log.warning("%s", warning)
    return root


def load_trees(
    paths: AnyPath | Sequence[AnyPath],
    registry: Registry | Mapping[str, Any],
    *,
    nodes: Iterable[AnyPath] = (),
    ros_packages: Packages = NO_PACKAGES,
) -> TreeProject:
    """Read all trees of a folder or of several files, which may use one another without an ``<include>``.

    Args:
        paths: the folder of a project, its files, or a single file.
        registry: the leaves by name.
        nodes: files with models of nodes.
        ros_packages: the folders that ``<include ros_pkg=...>`` means, by the packages' names.

    Returns:
        the trees, each of which can be built; their problems are found then.

    Raises:
        InputError: if a file that was named cannot be read.

    >>> project = load_trees("examples/fetch.xml", {"move_to": lambda place: True})
    >>> project.ids
    ('Fetch', 'GoTo')
    """
    return TreeProject(read_tree_files(paths, nodes=nodes, ros_packages=ros_packages), Registry.of(registry))


class TreeProject:
    """The trees of some files, from :func:`load_trees`.

    Args:
        files: the files.
        registry: the leaves.
    """

    def __init__(self, files: TreeFiles, registry: Registry) -> None:
        self._files = files
        self._registry = registry
        self._specs = TreeSpecs(files, registry)

    @property
    def ids(self) -> tuple[str, ...]:
        """The IDs of all trees, in the order in which they were read."""
        return tuple(self._files.trees)

    @property
    def is_folder(self) -> bool:
        """Whether these are several files, or those of a folder: trees that are not used are no surprise there."""
        return self._files.is_project

    def main_tree(self, tree: str | None = None) -> str:
        """The ID of the tree to be run.

        Args:
            tree: the one wanted; by default the one that the files name, or the only one.

        Raises:
            InputError: if there is no such tree, or it is not clear which one is meant.
        """
        return self._files.main_tree(tree)

    def build(self, tree: str | None = None, *, blackboard: Blackboard | None = None) -> Behaviour:
        """The root of a new tree.

        Args:
            tree: its ID, as for :meth:`main_tree`.
            blackboard: its blackboard, for a caller that writes or reads it.

        Raises:
            InputError: with all problems of the tree, and of those that it uses.
        """
        main, specs = self.specs(tree)
        builder = TreeBuilder(specs, self._registry.enums)
        blackboard = Blackboard() if blackboard is None else blackboard
        root = builder.build(specs[main], blackboard, (main,), 1)
        if not isinstance(root, Node):
            builder.refuse_conditions((specs[main],), "at the root")
            if not isinstance(root, Leaf):
                let_fail(root)
        if builder.problems:
            raise InputError(first_problems(builder.problems, self._files.where))
        set_tree_id(root, main)
        set_blackboard(root, blackboard)
        return root

    def specs(self, tree: str | None = None) -> tuple[str, dict[str, NodeSpec]]:
        """The ID of a tree, and the specifications of it and of the trees that it uses, by ID.

        Raises:
            InputError: as :meth:`build`.
        """
        if not self._files.trees and self._files.faults:
            raise InputError(first_problems(self._files.faults, self._files.where))
        main = self._files.main_tree(tree)
        errors = self._specs.errors(main)
        if errors:
            raise InputError(first_problems(errors, self._files.where))
        specs = {tree_id: self._specs.of(tree_id) for tree_id in self._specs.reached_from(main)}
        return main, {tree_id: spec for tree_id, spec in specs.items() if spec is not None}

    def warnings(self, tree: str | None = None) -> list[Problem]:
        """What is wrong with trees, files and models that a tree does not use, at most a hundred.

        Args:
            tree: its ID, as for :meth:`main_tree`.
        """
        return first_problems(self._specs.warnings(self._files.main_tree(tree)), self._files.where)

    def __repr__(self) -> str:
        return f"<{len(self.ids)} behaviour trees of {Path(self._files.where.file).name}>"
