"""The knowledge models of robots, loaded once for many runs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from rosa_core import KnowledgeModel


def load_models(paths: Sequence[Path]) -> KnowledgeModel:
    """Load a knowledge model; the same files, unchanged, are read only once.

    Args:
        paths: the model's files; later ones extend earlier ones.

    Raises:
        KnowledgeModelError: if they are no knowledge model.
    """
    return _load(tuple((path, _version(path)) for path in paths))


@lru_cache(maxsize=16)
def _load(versions: tuple[tuple[Path, tuple[int, int]], ...]) -> KnowledgeModel:
    return KnowledgeModel.load(*(path for path, _ in versions))


def _version(path: Path) -> tuple[int, int]:
    try:
        stat = path.stat()
    except OSError:
        return 0, 0  # loading says what is wrong
    return stat.st_mtime_ns, stat.st_size
