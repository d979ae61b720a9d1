"""``rosa tree``: shows a behaviour tree, or converts one of BehaviorTree.CPP v3."""

from __future__ import annotations

import sys
from pathlib import Path

from py_trees import console, display

from rosa_cli.options import TreeOptions
from rosa_core import InputError
from rosa_core.errors import Location, Problem
from task_layer.bt.display.description import one_line
from task_layer.bt.display.svg import tree_svg
from task_layer.bt.xml.outline import read_outline
from task_layer.bt.xml.version_3 import upgrade


def show_tree(files: list[Path], options: TreeOptions, *, dot: bool, svg: Path | None) -> None:
    """Print the tree or its graph for Graphviz, or draw it as an SVG file."""
    if dot and svg is not None:
        raise InputError(Problem("--dot and --svg are two pictures", None, "give one of them"))
    root, problems = read_outline(files, options.tree, nodes=options.nodes or (), ros_packages=options.packages())
    for problem in problems:
        print(f"rosa: {problem}", file=sys.stderr)
    if svg is not None:
        _write(svg, tree_svg(root))
        print(f"rosa: drawn in {svg}", file=sys.stderr)
        return
    for node in root.iterate():
        node.name = one_line(node)
    if dot:
        print(display.dot_tree(root).to_string())
    else:
        show = display.unicode_tree if console.has_unicode() else display.ascii_tree
        print(show(root), end="")


def upgrade_tree(files: list[Path], new: Path) -> None:
    """Convert a file of version 3 to version 4.

    Raises:
        InputError: if it cannot be converted.
    """
    if len(files) != 1:
        raise InputError(Problem(f"--upgrade converts one file, not {len(files)}"))
    for problem in upgrade(files[0], new):
        print(f"warning: {problem}", file=sys.stderr)
    print(f"rosa: converted to {new}", file=sys.stderr)


def _write(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except (OSError, ValueError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise InputError(Problem(f"cannot write it: {reason}", Location(str(path)))) from None
