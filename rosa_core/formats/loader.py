"""Reads a knowledge model from one or several files."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from os import PathLike
from pathlib import Path

from rosa_core.errors import InputError, KnowledgeModelError, Location, Problem
from rosa_core.formats.builder import ModelBuilder
from rosa_core.formats.yaml_format import read_yaml
from rosa_core.model.knowledge_model import KnowledgeModel


def _read_typeql(path: str, builder: ModelBuilder) -> None:
    # The parser generator takes time to import, which only TypeQL files should cost.
    from rosa_typeql.models.reader import read_typeql

    read_typeql(path, builder)


_READERS: dict[str, Callable[[str, ModelBuilder], None]] = {
    ".yaml": read_yaml,
    ".yml": read_yaml,
    ".tql": _read_typeql,
}


def load_model(paths: Iterable[str | PathLike[str]]) -> KnowledgeModel:
    """The model that the files state together; later files extend earlier ones.

    Raises:
        KnowledgeModelError: with file, line and hint for everything that is wrong.
    """
    files = [str(path) for path in paths]
    if not files:
        raise KnowledgeModelError(Problem("no file is given", hint="name at least one model file"))
    builder = ModelBuilder()
    for file in files:
        reader = _READERS.get(Path(file).suffix.lower())
        if reader is None:
            raise KnowledgeModelError(
                Problem("unknown kind of file", Location(file), f"a model ends in {', '.join(_READERS)}")
            )
        try:
            reader(file, builder)
        except KnowledgeModelError:
            raise
        except InputError as error:
            raise KnowledgeModelError(error.problems) from None
    model = builder.build()
    if not any(model.names.values()):
        where = Location(files[0])
        raise KnowledgeModelError(Problem("the model is empty", where, "declare at least one action"))
    return model
