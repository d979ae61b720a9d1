"""Reads the XML files of a mission: one file, several, or all of a folder, and those that they include."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from rosa_core import InputError
from rosa_core.errors import Location, Problem, nearest
from task_layer.bt.xml.limits import MAX_ENTRIES, MAX_FILES, MAX_TOTAL_BYTES
from task_layer.bt.xml.node_models import node_model
from task_layer.bt.xml.problem_list import ProblemList, TooManyProblemsError, first_problems
from task_layer.bt.xml.source import Element, read_xml
from task_layer.bt.xml.tree_files import TreeFiles
from task_layer.bt.xml.version_3 import is_version_3, version_3_problem

AnyPath = str | PathLike[str]
Packages = Mapping[str, AnyPath]
"""The folders of ROS packages, by name."""

NO_PACKAGES: Packages = MappingProxyType({})
_ENDINGS = (".xml", ".btproj")
_TOP_LEVEL = ("BehaviorTree", "TreeNodesModel", "include")


def read_tree_files(
    paths: AnyPath | Sequence[AnyPath], *, nodes: Iterable[AnyPath] = (), ros_packages: Packages = NO_PACKAGES
) -> TreeFiles:
    """Read files and all files that they include.

    Args:
        paths: a file, several files, or a folder, which stands for the files below it that end in ``.xml`` or
            ``.btproj``; those that are no trees at all are passed over.
        nodes: files whose TreeNodesModel counts, and nothing else.
        ros_packages: the folders that ``<include ros_pkg=...>`` means.

    Raises:
        InputError: if a file that was named is no BehaviorTree.CPP XML, or there is too much. Smaller problems, and
            files of a folder that cannot be read, are in the result.
    """
    several = [paths] if isinstance(paths, str | PathLike) else list(paths)
    if not several:
        raise InputError("no file to read trees from was given")
    files = TreeFiles(Location(str(several[0])), is_project=len(several) > 1 or Path(several[0]).is_dir())
    reader = _FileReader(files, ros_packages)
    for manifest in nodes:
        reader.read_models(Path(manifest))
    for path in map(Path, several):
        if path.is_dir():
            reader.read_folder(path)
        else:
            reader.read_named(path)
    return files


class _TooMuchError(InputError):
    """There is more to read than may be read; no other file can help."""


@dataclass(frozen=True, slots=True)
class _Reading:
    """A file that is being read.

    Attributes:
        path: the file.
        including: the files that it is included from, and itself.
        folders: the folders that it may include files from.
        is_needed: whether its faults count even if its trees are not used.
        found: its faults so far.
    """

    path: Path
    including: tuple[Path, ...]
    folders: tuple[Path, ...]
    is_needed: bool
    found: ProblemList = field(default_factory=ProblemList)

    def included(self, path: Path, folders: tuple[Path, ...]) -> _Reading:
        """The reading of a file that this one includes."""
        return _Reading(path, (*self.including, path.resolve()), folders, self.is_needed)


class _FileReader:
    """Reads files into a :class:`TreeFiles`."""

    def __init__(self, files: TreeFiles, ros_packages: Packages) -> None:
        self._files = files
        self._packages = {name: Path(folder) for name, folder in ros_packages.items()}
        self._seen: set[Path] = set()
        self._bytes = 0
        self._without_id = 0

    def read_named(self, path: Path) -> None:
        """Read a file that was asked for, and what it includes: all their faults count."""
        resolved = _resolved(path)
        if resolved not in self._seen:
            root = self._root(path)
            if not self._files.mains or not self._files.is_project:
                self._note_main(root)
            self._content(root, _Reading(path, (resolved,), (path.parent,), is_needed=True))

    def read_folder(self, folder: Path) -> None:
        """Read all files of a folder; those that are something else are passed over."""
        for path in _files_below(folder):
            try:
                resolved = _resolved(path)
                if resolved in self._seen:
                    continue
                root = self._root(path)
            except _TooMuchError:
                raise
            except InputError as error:
                self._files.faults.extend(error.problems)
                self._files.unread.append(str(path))
                continue
            if root.tag == "root":
                self._note_main(root)
                self._content(root, _Reading(path, (resolved,), (folder,), is_needed=False))

    def read_models(self, path: Path) -> None:
        """Read the models in a file."""
        root = self._root(path, any_version=True)
        found = ProblemList()
        elements = [root] if root.tag == "TreeNodesModel" else root.all("TreeNodesModel")
        if not elements:
            found.add("there is no <TreeNodesModel> in it", Location(str(path)))
        try:
            for element in elements:
                self._models(element, found)
        except TooManyProblemsError:
            pass
        if found.found:
            raise InputError(first_problems(found.found, Location(str(path))))

    def _root(self, path: Path, *, any_version: bool = False) -> Element:
        self._seen.add(_resolved(path))
        if len(self._seen) > MAX_FILES:
            raise _TooMuchError(Problem(f"there are more than {MAX_FILES:,} files", self._files.where))
        root, size = read_xml(path)
        self._bytes += size
        if self._bytes > MAX_TOTAL_BYTES:
            raise _TooMuchError(Problem(f"the files have more than {MAX_TOTAL_BYTES:,} bytes", self._files.where))
        if root.tag == "root" and not any_version and is_version_3(root):
            raise InputError(version_3_problem(root))
        return root

    def _note_main(self, root: Element) -> None:
        main = root.get("main_tree_to_execute")
        if main is not None and main not in self._files.mains:
            self._files.mains.append(main)

    def _content(self, root: Element, reading: _Reading) -> None:
        """Take in what is in a file, after what is in the files that it includes."""
        if root.tag != "root":
            hint = 'it must be <root BTCPP_format="4">'
            raise InputError(Problem(f"the outermost element is <{root.tag[:60]}>", root.where, hint))
        if reading.is_needed:
            self._files.needed.add(str(reading.path))
        several = len(root.all("BehaviorTree")) > 1
        try:
            for element in root.all("include"):
                self._include(element, reading)
            for element in root.children:
                self._top_level(element, reading, several=several)
        except TooManyProblemsError:
            pass
        self._files.faults.extend(reading.found.found)
        if reading.is_needed:
            self._files.needed.update(fault.where.file for fault in reading.found.found if fault.where is not None)

    def _include(self, element: Element, reading: _Reading) -> None:
        named, found = element.get("path"), reading.found
        if not named:
            found.add("<include> without a path", element.where, 'write <include path="other.xml"/>')
            return
        folders, beside = reading.folders, reading.path.parent
        package = element.get("ros_pkg")
        if package is not None:
            if package not in self._packages:
                hint = nearest(package[:60], self._packages) or "say where it is: ros_packages=, --ros-package NAME=DIR"
                found.add(f"the folder of the ROS package '{package[:60]}' is not known", element.where, hint)
                return
            beside = self._packages[package]
            folders = (*folders, beside)
        path = beside / named
        try:
            resolved = _resolved(path)
        except InputError as error:
            found.add(f"<include path={named[:200]!r}>: {error.problems[0].what}", element.where)
            return
        if resolved in reading.including:
            found.add(f"'{named[:200]}' includes itself, directly or through others", element.where)
        elif not any(resolved.is_relative_to(folder.resolve()) for folder in folders):
            hint = "put it beside or below the mission"
            found.add(f"'{named[:200]}' is outside the mission's folder", element.where, hint)
        elif resolved not in self._seen:
            self._read_included(reading.included(path, folders), element, found)

    def _read_included(self, reading: _Reading, element: Element, found: ProblemList) -> None:
        try:
            self._content(self._root(reading.path), reading)
        except _TooMuchError:
            raise
        except InputError as error:
            self._files.unread.append(str(reading.path))
            for problem in error.problems:
                if problem.what.startswith("cannot read it"):
                    found.add(f"'{(element.get('path') or '')[:200]}': {problem.what}", element.where)
                else:
                    found.add(problem.what, problem.where, problem.hint)

    def _top_level(self, element: Element, reading: _Reading, *, several: bool) -> None:
        if element.tag == "BehaviorTree":
            self._tree(element, reading, several=several)
        elif element.tag == "TreeNodesModel":
            self._models(element, reading.found)
        elif element.tag not in ("include", "Metadata"):
            hint = nearest(element.tag[:60], _TOP_LEVEL)
            reading.found.add(f"<{element.tag[:60]}> cannot stand here", element.where, hint)

    def _tree(self, element: Element, reading: _Reading, *, several: bool) -> None:
        tree_id = element.get("ID")
        if tree_id == "" or (tree_id is None and several):
            what = "with an empty ID" if tree_id == "" else "without an ID, beside others"
            reading.found.add(f"<BehaviorTree> {what}", element.where, "give it a name")
            return
        if tree_id is None:
            tree_id = f"BehaviorTree_{self._without_id}"
            self._without_id += 1
        self._files.trees.setdefault(tree_id, []).append(element)
        if len(reading.including) == 1:
            self._files.candidates.append(tree_id)

    def _models(self, element: Element, found: ProblemList) -> None:
        for entry in element.children:
            model = node_model(entry, found.add)
            if model is not None:
                self._files.models.setdefault(model.tag, model)


def _resolved(path: Path) -> Path:
    """The path without links.

    Raises:
        InputError: if there can be no such path.
    """
    try:
        return path.resolve()
    except (OSError, ValueError, RuntimeError) as error:
        raise InputError(Problem(f"cannot read it: {error}", Location(str(path)))) from None


def _files_below(folder: Path) -> Iterator[Path]:
    """The files of a folder, those in hidden folders left out, in an order that is always the same."""
    entries = 0
    for parent, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        entries += len(folders) + len(names)
        if entries > MAX_ENTRIES:
            what = f"there are more than {MAX_ENTRIES:,} files and folders in it"
            raise _TooMuchError(Problem(what, Location(str(folder)), "name the folder of the mission"))
        for name in sorted(names):
            path = Path(parent, name)
            if path.suffix in _ENDINGS and not name.startswith(".") and path.is_file():
                yield path
