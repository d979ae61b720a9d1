"""Reads a map file, whichever of the formats it is in."""

from __future__ import annotations

from os import PathLike

from agv_example.corridors import CorridorMap
from agv_example.map_formats.own_format import MapEntry, own_map
from agv_example.map_formats.rainbow_format import RainbowEntry, rainbow_map
from rosa_core.formats.checked_file import checked_part
from rosa_core.formats.yaml_source import KeyPath, YamlSource

_FORM = "it has 'places:' and 'corridors:', or 'grid:', or is a BRASS map with 'map:'"


def load_map(path: str | PathLike[str]) -> CorridorMap:
    """Read a map in YAML or JSON, ours or that of the CMU BRASS exemplar.

    Args:
        path: of the file.

    Raises:
        InputError: with file, line and hint for everything that is wrong.
    """
    return read_map(YamlSource(path))


def read_map(source: YamlSource, at: KeyPath = ()) -> CorridorMap:
    """The map that stands in a parsed file, as a whole or at a path.

    Args:
        source: the parsed file, in one of the formats of :func:`load_map`.
        at: keys and indices from the top of the file to the map.

    Raises:
        InputError: with file, line and hint for everything that is wrong.
    """
    data = source.part(at)
    if isinstance(data, dict) and isinstance(data.get("map"), list):
        return rainbow_map(checked_part(source, at, RainbowEntry, "a map", _FORM))
    return own_map(checked_part(source, at, MapEntry, "a map", _FORM))
