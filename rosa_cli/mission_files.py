"""The files of a mission, as the options of several commands name them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rosa_core import InputError
from rosa_core.errors import Problem


@dataclass(frozen=True, slots=True)
class MissionOptions:
    """The options ``--tree``, ``--nodes`` and ``--ros-package``.

    Attributes:
        tree: the ID of the tree; None for the one that the files name.
        nodes: files with models of nodes.
        ros_packages: the folders of ROS packages, by name.
    """

    tree: str | None
    nodes: tuple[Path, ...]
    ros_packages: dict[str, Path]

    @classmethod
    def of(cls, tree: str | None, nodes: list[Path] | None, ros_packages: list[str] | None) -> MissionOptions:
        """The options as they were given.

        Raises:
            InputError: if a package has no folder.
        """
        return cls(tree, tuple(nodes or ()), dict(map(_package, ros_packages or ())))


def _package(text: str) -> tuple[str, Path]:
    name, equals, folder = text.partition("=")
    if not (name and equals and folder):
        hint = "--ros-package robot_trees=/path/to/its/folder"
        raise InputError(Problem(f"--ros-package {text!r} does not say where the package is", hint=hint))
    if not Path(folder).is_dir():
        raise InputError(Problem(f"--ros-package {name}: there is no folder {folder!r}"))
    return name, Path(folder)
