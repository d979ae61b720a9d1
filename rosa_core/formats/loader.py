"""Reads a knowledge model from one or several files, each by the reader for its suffix."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import Protocol

from rosa_core.errors import InputError, KnowledgeModelError, Location, Problem
from rosa_core.formats.builder import ModelBuilder
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.plugins import Plugin


class ModelReader(Protocol):
    """The port for file formats: a function that reads one file of a format."""

    def __call__(self, path: str, builder: ModelBuilder) -> None:
        """Add the statements of a file to those of the files before it.

        The reader states every element and relation to the builder, each with its place in the file; the builder finds
        what contradicts an earlier statement or does not hold together.

        Raises:
            InputError: if the file cannot be read; with file, line and hint for everything that is wrong.
        """
        ...


_YAML = Plugin("rosa_core.formats.yaml_format", "read_yaml", "a YAML file")
_TYPEQL = Plugin("rosa_typeql.plugin", "read_typeql", "a TypeQL file (.tql)")
_READERS: dict[str, Plugin | ModelReader] = {".yaml": _YAML, ".yml": _YAML, ".tql": _TYPEQL}


def register_format(suffix: str, reader: ModelReader | Plugin) -> None:
    """Read the files with a suffix by this reader from now on, also instead of the one that they had.

    Args:
        suffix: the end of the file names with its dot, in lower case, such as ``.json``.
        reader: the reader, or where it is to be found when the first such file is read.
    """
    _READERS[suffix] = reader


def _reader(file: str) -> ModelReader:
    reader = _READERS.get(Path(file).suffix.lower())
    if reader is None:
        raise KnowledgeModelError(
            Problem("unknown kind of file", Location(file), f"a model ends in {', '.join(_READERS)}")
        )
    if not isinstance(reader, Plugin):
        return reader
    found: ModelReader = reader.load()
    return found


def load_model(paths: Iterable[str | PathLike[str]]) -> KnowledgeModel:
    """The model that the files state together; later files extend earlier ones.

    Args:
        paths: files whose suffixes have a reader: ``.yaml``, ``.yml`` and ``.tql``, and those registered.

    Raises:
        KnowledgeModelError: with file, line and hint for everything that is wrong.
    """
    files = [str(path) for path in paths]
    if not files:
        raise KnowledgeModelError(Problem("no file is given", hint="name at least one model file"))
    builder = ModelBuilder()
    for file in files:
        try:
            _reader(file)(file, builder)
        except KnowledgeModelError:
            raise
        except InputError as error:
            raise KnowledgeModelError(error.problems) from None
    model = builder.build()
    if not any(model.names.values()):
        where = Location(files[0])
        raise KnowledgeModelError(Problem("the model is empty", where, "declare at least one action"))
    return model
