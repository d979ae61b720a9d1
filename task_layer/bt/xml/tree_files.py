"""The XML files of a tree: the trees in them, the main one, and the declarations of ports."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from task_layer.bt.ports.conversion import ConversionError, parse
from task_layer.bt.ports.port import REQUIRED, Direction, Port
from task_layer.bt.types.node_source import KINDS_BY_TAG, NodeKind
from task_layer.bt.xml.limits import MAX_FILES, MAX_PROBLEMS
from task_layer.bt.xml.source import Element, read_xml

_TYPES = {
    "int": int,
    "int64_t": int,
    "unsigned": int,
    "unsigned int": int,
    "double": float,
    "float": float,
    "bool": bool,
    "std::string": str,
    "string": str,
}


@dataclass(frozen=True, slots=True)
class NodeModel:
    """The entry of a TreeNodesModel for a node or a subtree."""

    tag: str
    kind: NodeKind
    ports: tuple[Port, ...]
    where: Location


@dataclass(slots=True)
class TreeFiles:
    """The content of a tree's file and of the files that it includes.

    Attributes:
        where: the file that includes the others.
        trees: the ``BehaviorTree`` elements, by ID.
        models: the entries of all TreeNodesModels, by ID.
        main: the ID of the tree to be run, if the file names one.
        first: the IDs in the file itself.
        problems: the problems found so far.
    """

    where: Location
    trees: dict[str, Element] = field(default_factory=dict)
    models: dict[str, NodeModel] = field(default_factory=dict)
    main: str | None = None
    first: list[str] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)

    def report(self, problem: Problem) -> None:
        """Add a problem.

        Raises:
            InputError: if there are too many to go on.
        """
        self.problems.append(problem)
        if len(self.problems) >= MAX_PROBLEMS:
            raise InputError([*self.problems, Problem("that is enough; there may be more", self.where)])

    def main_tree(self, wanted: str | None) -> str:
        """The ID of the tree to be run: the one wanted, the one that the file names, or the only one.

        Raises:
            InputError: if there is no such tree, or none is named and there are several.
        """
        chosen = wanted if wanted is not None else self.main
        if chosen is None and len(self.first) == 1:
            chosen = self.first[0]
        if chosen is None:
            hint = f"say main_tree_to_execute= one of {', '.join(self.first)}" if self.first else "add <BehaviorTree>"
            raise InputError(Problem("it does not say which tree to run", self.where, hint))
        if chosen not in self.trees:
            hint = nearest(chosen[:60], self.trees) or f"there is: {', '.join(sorted(self.trees))[:200] or 'none'}"
            raise InputError(Problem(f"there is no tree '{chosen[:60]}'", self.where, hint))
        return chosen


def read_tree_files(path: Path) -> TreeFiles:
    """Read a file and all files that it includes.

    Raises:
        InputError: if a file is no BehaviorTree.CPP XML. Smaller problems are in the result.
    """
    files = TreeFiles(Location(str(path)))
    _TreeFileReader(files, path.parent).read(path, ())
    return files


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


class _TreeFileReader:
    """Reads files into a :class:`TreeFiles`."""

    def __init__(self, files: TreeFiles, folder: Path) -> None:
        self._files = files
        self._folder = folder
        self._seen: set[Path] = set()

    def read(self, path: Path, including: tuple[Path, ...]) -> None:
        """Read one file, after the files that it includes."""
        root = read_xml(path)
        self._seen.add(path.resolve())
        self._check_root(root)
        for element in root.children:
            if element.tag == "include":
                self._include(element, path, (*including, path.resolve()))
        for element in root.children:
            self._top_level(element, is_first=not including)
        if not including:
            self._files.main = root.get("main_tree_to_execute")

    def _check_root(self, root: Element) -> None:
        if root.tag != "root":
            hint = 'it must be <root BTCPP_format="4">'
            raise InputError(Problem(f"the outermost element is <{root.tag[:60]}>", root.where, hint))
        version = root.get("BTCPP_format")
        if version not in (None, "4"):
            hint = "convert it to version 4, for instance by opening and saving it in Groot2"
            raise InputError(Problem(f"BTCPP_format is {version[:20]!r}; only version 4 is read", root.where, hint))

    def _include(self, element: Element, path: Path, including: tuple[Path, ...]) -> None:
        named = element.get("path")
        if element.get("ros_pkg") is not None:
            self._problem("<include> with ros_pkg is not supported", element, "give a path beside this file")
            return
        if not named:
            self._problem("<include> without a path", element, 'write <include path="other.xml"/>')
            return
        included = path.parent / named
        try:
            resolved = included.resolve()
        except (OSError, ValueError, RuntimeError) as error:
            self._problem(f"<include path={named[:200]!r}>: {error}", element)
            return
        if resolved in including:
            self._problem(f"'{named[:200]}' includes itself, directly or through others", element)
        elif not resolved.is_relative_to(self._folder.resolve()):
            self._problem(
                f"'{named[:200]}' is outside the mission's folder", element, "put it beside or below the mission"
            )
        elif len(self._seen) >= MAX_FILES:
            raise InputError(Problem(f"it includes more than {MAX_FILES} files", element.where))
        elif resolved not in self._seen:
            self._read_included(included, named, element, including)

    def _read_included(self, path: Path, named: str, element: Element, including: tuple[Path, ...]) -> None:
        try:
            self.read(path, including)
        except InputError as error:
            if len(self._files.problems) >= MAX_PROBLEMS:
                raise
            missing = [problem for problem in error.problems if problem.what.startswith("cannot read it")]
            if missing:
                self._problem(f"'{named[:200]}': {missing[0].what}", element)
            else:
                self._files.problems.extend(error.problems)

    def _top_level(self, element: Element, is_first: bool) -> None:
        if element.tag == "BehaviorTree":
            self._tree(element, is_first)
        elif element.tag == "TreeNodesModel":
            for model in element.children:
                self._model(model)
        elif element.tag not in ("include", "Metadata"):
            known = ("BehaviorTree", "TreeNodesModel", "include")
            self._problem(f"<{element.tag[:60]}> cannot stand here", element, nearest(element.tag[:60], known))

    def _tree(self, element: Element, is_first: bool) -> None:
        tree_id = element.get("ID")
        if tree_id is None:
            tree_id = f"BehaviorTree_{len(self._files.trees)}"
        if not tree_id:
            self._problem("<BehaviorTree> with an empty ID", element, "give it a name")
            return
        first = self._files.trees.get(tree_id)
        if first is not None:
            self._problem(f"there is a second tree '{tree_id}'; the first is at {first.where}", element, "rename one")
            return
        self._files.trees[tree_id] = element
        if is_first:
            self._files.first.append(tree_id)

    def _model(self, element: Element) -> None:
        kind, tag = KINDS_BY_TAG.get(element.tag), element.get("ID")
        if kind is None:
            self._problem(f"<{element.tag[:60]}> cannot stand here", element, f"one of {', '.join(KINDS_BY_TAG)}")
        elif not tag:
            self._problem(f"<{element.tag}> without an ID", element)
        else:
            directions = {direction.value for direction in Direction}
            ports = [self._port(port) for port in element.children if port.tag in directions]
            model = NodeModel(tag, kind, tuple(port for port in ports if port is not None), element.where)
            self._files.models.setdefault(tag, model)

    def _port(self, element: Element) -> Port | None:
        name = element.get("name")
        if not name:
            self._problem(f"<{element.tag}> without a name", element)
            return None
        kind = _TYPES.get(element.get("type") or "", object)
        default: object = element.get("default")
        if default is None:
            default = REQUIRED
        elif kind is not object and not str(default).startswith("{"):
            try:
                parse(str(default), kind)
            except ConversionError as error:
                self._problem(f"the default of port '{name}': {error}", element)
                return None
        return Port(name, Direction(element.tag), kind, default, " ".join(element.text.split()))

    def _problem(self, what: str, element: Element, hint: str | None = None) -> None:
        self._files.report(Problem(what, element.where, hint))
