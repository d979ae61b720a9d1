"""The content of the XML files of a mission: the trees in them, the main one, and the models of nodes."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from task_layer.bt.types.node_source import NodeKind
from task_layer.bt.xml.node_models import NodeModel
from task_layer.bt.xml.source import Element


@dataclass(slots=True)
class TreeFiles:
    """The content of files that belong together.

    Attributes:
        where: the file or folder that was asked for.
        trees: the ``BehaviorTree`` elements by ID: more than one if several trees have the same ID.
        models: the entries of all TreeNodesModels, by ID.
        mains: the IDs of the trees that the files say to run.
        candidates: the IDs of the trees in the files themselves, those that they include left out.
        needed: the files whose faults count whether their trees are used or not.
        faults: the problems of the files, the trees left out.
        unread: the files that cannot be read.
        is_project: whether these are several files that were asked for, or a folder.
    """

    where: Location
    trees: dict[str, list[Element]] = field(default_factory=dict)
    models: dict[str, NodeModel] = field(default_factory=dict)
    mains: list[str] = field(default_factory=list)
    candidates: list[str] = field(default_factory=list)
    needed: set[str] = field(default_factory=set)
    faults: list[Problem] = field(default_factory=list)
    unread: list[str] = field(default_factory=list)
    is_project: bool = False

    def main_tree(self, wanted: str | None) -> str:
        """The ID of the tree to be run: the one wanted, the one that the files name, or the only one.

        Raises:
            InputError: if there is no such tree, or none is named and there are several.
        """
        chosen = wanted
        if chosen is None and len(self.mains) == 1:
            chosen = self.mains[0]
        if chosen is None and len(set(self.candidates)) == 1:
            chosen = self.candidates[0]
        if chosen is None:
            raise InputError([Problem("it does not say which tree to run", self.where, self._which()), *self._unread()])
        if chosen not in self.trees:
            hint = nearest(chosen[:60], self.trees) or f"there is: {_listed(sorted(self.trees)) or 'none'}"
            raise InputError([Problem(f"there is no tree '{chosen[:60]}'", self.where, hint), *self._unread()])
        return chosen

    def definition(self, tree_id: str) -> Element:
        """The element of a tree.

        Raises:
            InputError: if several trees have that ID.
        """
        first, *others = self.trees[tree_id]
        if others:
            places = ", ".join(str(tree.where) for tree in (first, *others))
            what = f"there is more than one tree '{tree_id[:60]}': {places[:500]}"
            raise InputError(Problem(what, others[0].where, "rename all but one"))
        return first

    def missing(self, tree_id: str, user: str) -> tuple[str, str | None]:
        """What is wrong with a SubTree whose tree is nowhere, and the hint.

        Args:
            tree_id: the ID that is nowhere.
            user: the ID of the tree that the SubTree is in.
        """
        hint = nearest(tree_id[:60], self.trees)
        if hint is None and self.unread:
            hint = f"perhaps it is in a file that cannot be read: {_listed(self.unread)}"
        return f"there is no tree '{tree_id[:60]}', which '{user[:60]}' uses", hint

    def faults_of(self, files: Collection[str]) -> list[Problem]:
        """The faults of these files, and of those that count in any case."""
        counted = self.needed.union(files)
        return [fault for fault in self.faults if fault.where is None or fault.where.file in counted]

    def top_trees(self) -> list[str]:
        """The IDs of the trees that no other tree uses."""
        used = {subtree for trees in self.trees.values() for tree in trees for subtree in subtrees_in(tree)}
        return [tree_id for tree_id in self.trees if tree_id not in used]

    def _which(self) -> str:
        if not self.trees:
            return "add <BehaviorTree>"
        if self.is_project:
            names = sorted(set(self.mains) & self.trees.keys()) or self.top_trees() or list(self.trees)
            return f"name one of its trees: {_listed(names)}"
        return f"say main_tree_to_execute= one of {_listed(self.candidates or list(self.trees))}"

    def _unread(self) -> list[Problem]:
        """The files that cannot be read, for a tree that could be in one of them."""
        return [fault for fault in self.faults if fault.where is not None and fault.where.file in self.unread]


def subtrees_in(tree: Element) -> Iterator[str]:
    """The IDs of the trees that a tree uses."""
    to_do = [tree]
    while to_do:
        element = to_do.pop()
        if element.tag == NodeKind.SUBTREE.value:
            yield element.get("ID") or ""
        to_do.extend(element.children)


def root_problem(tree: Element) -> Problem | None:
    """Why a ``BehaviorTree`` element has not exactly one root; None if it has."""
    if len(tree.children) == 1:
        return None
    what = f"<BehaviorTree> has {len(tree.children)} nodes in it"
    return Problem(what, tree.where, "it must have exactly one: its root")


def check_no_cycle(tree_id: str, inside: tuple[str, ...], where: Location) -> None:
    """Check that a SubTree is not one of the trees that it is in.

    Raises:
        InputError: if it is.
    """
    if tree_id in inside:
        names = " > ".join((*inside[inside.index(tree_id) :], tree_id))
        raise InputError(Problem(f"a tree contains itself: {names}", where))


def _listed(names: Collection[str]) -> str:
    text = ", ".join(names)
    return text if len(text) <= 200 else f"{text[:200]}..."
