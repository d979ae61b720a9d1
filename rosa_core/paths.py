"""Questions about paths that somebody has given, and files that are there whole or not at all.

``pathlib`` raises for a name that is too long for the file system, and for a directory that may not be entered; here
what cannot be there is not there.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path


def is_file(path: str | PathLike[str]) -> bool:
    """Whether there is a file, as far as can be seen.

    >>> is_file("a" * 300)
    False
    """
    try:
        return Path(path).is_file()
    except OSError:
        return False


def is_directory(path: str | PathLike[str]) -> bool:
    """Whether there is a directory, as far as can be seen."""
    try:
        return Path(path).is_dir()
    except OSError:
        return False


def exists(path: str | PathLike[str]) -> bool:
    """Whether there is anything, as far as can be seen."""
    try:
        return Path(path).exists()
    except OSError:
        return False


@contextmanager
def replaced_together(*paths: Path) -> Iterator[tuple[Path, ...]]:
    """New files in place of others, once all of them have been written; if that fails, what was there stays.

    Args:
        paths: of the files, which need not be there; their directories must be.

    Yields:
        where to write them instead, in the same order.

    Raises:
        OSError: if one cannot be put in its place.
    """
    temporary = tuple(path.with_name(f".{path.name}.{os.getpid()}") for path in paths)
    try:
        yield temporary
        for written, path in zip(temporary, paths, strict=True):
            written.replace(path)
    finally:
        for leftover in temporary:
            leftover.unlink(missing_ok=True)
