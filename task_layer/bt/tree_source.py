"""Where a behaviour tree comes from, in one object that stands for a file wherever a scenario takes one."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class TreeSource:
    """A tree of a mission: its file or folder, and what is needed to find it there.

    Attributes:
        path: the XML file, or the folder of a project.
        tree: the ID of the tree; None for the one that the files name.
        nodes: files with models of nodes.
        ros_packages: the folders that ``<include ros_pkg=...>`` means, by the packages' names.
    """

    path: Path
    tree: str | None = None
    nodes: tuple[Path, ...] = ()
    ros_packages: Mapping[str, Path] = field(default_factory=lambda: MappingProxyType({}))

    def __fspath__(self) -> str:
        return os.fspath(self.path)

    def __str__(self) -> str:
        return str(self.path) if self.tree is None else f"{self.path} ({self.tree})"
