"""Reads a map file, whichever of the formats it is in."""

from __future__ import annotations

from os import PathLike

from agv_example.corridors import CorridorMap
from agv_example.map_formats.checked import Checked
from agv_example.map_formats.own_format import read_own_map
from agv_example.map_formats.rainbow_format import is_rainbow_map, read_rainbow_map
from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_core.formats.yaml_source import YamlSource


def load_map(path: str | PathLike[str]) -> CorridorMap:
    """Read a map in YAML or JSON, ours or that of the CMU BRASS exemplar.

    Raises:
        InputError: with file, line and hint for everything that is wrong.
    """
    source = YamlSource(path)
    return read_map(Checked(source, source.data))


def read_map(data: Checked) -> CorridorMap:
    """The map that a value in a file describes.

    Raises:
        InputError: with file, line and hint for everything that is wrong.
    """
    if not isinstance(data.value, dict) or not data.value:
        data.complain("not a map", "it has 'places:' and 'corridors:', or 'grid:', or is a BRASS map with 'map:'")
    data.raise_problems()
    try:
        found = read_rainbow_map(data) if is_rainbow_map(data) else read_own_map(data)
    except InputError as error:
        raise InputError([Problem(p.what, p.where or data.where, p.hint) for p in error.problems]) from None
    data.raise_problems()
    if found is None:
        raise AssertionError("a map that cannot be read has been complained of")
    return found
