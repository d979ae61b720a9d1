"""Our own map files, in YAML or JSON.

::

    name: paper
    places:
      A: [0, 0]                  # x, y in m
      B: [20, 0]
    corridors:
      C1: {between: [A, B], obstacles: 2, accuracy: 1.6}
      C2: {between: [B, A], length: 30, light: 0.2, speed_limit: 0.35, one_way: true, closed: false}

or a grid that is made up: ``grid: {columns: 8, rows: 6, seed: 1, dark: 0.3}``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import AfterValidator, Field

from agv_example.corridors import FULL_LIGHT, Corridor, CorridorMap, Place, distance
from agv_example.grids import grid_map
from rosa_core import InputError
from rosa_core.formats.checked_file import CheckedFile, Entry, Flag, Name, Names, Number, Whole, within

Figure = Annotated[Number, Field(ge=-1e9, le=1e9)]
FromZero = Annotated[Number, Field(ge=0, le=1e9)]
AboveZero = Annotated[Number, Field(ge=1e-3, le=1e9)]
Part = Annotated[Number, within(0.0, 1.0)]


def _two(form: str) -> AfterValidator:
    def check(items: tuple[object, ...]) -> tuple[object, ...]:
        if len(items) != 2:
            raise ValueError(f"two of them are expected, as in {form}")
        return items

    return AfterValidator(check)


class CorridorEntry(Entry):
    """A corridor; its length is that as the crow flies if it is not given."""

    between: Annotated[Names, _two("'between: [A, B]'")]
    length: AboveZero | None = None
    obstacles: Annotated[Whole, within(0, 10_000)] = 0
    accuracy: FromZero = 0.0
    light: Annotated[Number, within(0.0, FULL_LIGHT)] = FULL_LIGHT
    speed_limit: AboveZero | None = None
    one_way: Flag = False
    closed: Flag = False


class GridEntry(Entry):
    """A grid that is made up; see :func:`~agv_example.grids.grid_map`."""

    columns: Annotated[Whole, within(1, 1000)]
    rows: Annotated[Whole, within(1, 1000)]
    seed: Annotated[Whole, within(0, 2**31)] = 0
    length: AboveZero | None = None
    accuracy: FromZero | None = None
    missing: Part | None = None
    obstructed: Part | None = None
    dark: Part | None = None
    slow: Part | None = None


class MapEntry(Entry):
    """A map file."""

    name: Name = "map"
    places: dict[Name, Annotated[tuple[Figure, ...], _two("'A: [0, 20]', x and y in m")]] = Field({})
    corridors: dict[Name, CorridorEntry] = Field({})
    grid: GridEntry | None = None


def own_map(file: CheckedFile[MapEntry]) -> CorridorMap:
    """The map.

    Raises:
        InputError: if corridors and places do not go together.
    """
    entry = file.content
    places = {name: Place(name, *at) for name, at in entry.places.items()}
    corridors = [_corridor(name, corridor, places, file) for name, corridor in entry.corridors.items()]
    file.raise_problems()
    with file.refusing():
        if entry.grid is not None:
            return grid_map(**entry.grid.model_dump(exclude_none=True))
        return CorridorMap(tuple(places.values()), tuple(filter(None, corridors)), entry.name)
    raise InputError(file.problems)


def _corridor(
    name: str, entry: CorridorEntry, places: Mapping[str, Place], file: CheckedFile[MapEntry]
) -> Corridor | None:
    unknown = [end for end in entry.between if end not in places]
    if unknown:
        what = f"corridor '{name}': there is no place {', '.join(map(repr, unknown))}"
        file.refuse(what, "write 'between: [A, B]'", "corridors", name)
        return None
    start, end = entry.between
    length = entry.length or distance(places[start], places[end])
    if length == 0.0:
        file.refuse(f"corridor '{name}': its ends are at the same spot", "give its length in m", "corridors", name)
        return None
    return Corridor(name, start, end, length, **entry.model_dump(exclude={"between", "length"}))
