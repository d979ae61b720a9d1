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

from agv_example.corridors import FULL_LIGHT, Corridor, CorridorMap, Place, distance
from agv_example.grids import grid_map
from agv_example.map_formats.checked import Checked

_MAP = ("name", "places", "corridors", "grid")
_CORRIDOR = ("between", "length", "obstacles", "accuracy", "light", "speed_limit", "one_way", "closed")
_PARTS = ("missing", "obstructed", "dark", "slow")


def read_own_map(data: Checked) -> CorridorMap | None:
    """The map; None if something is wrong, which ``data`` then has complained of."""
    data.only(_MAP)
    if "grid" in data:
        return _grid(data["grid"])
    places = {name: _place(name, entry) for name, entry in data["places"].items()}
    corridors = [_corridor(name, entry, places) for name, entry in data["corridors"].items()]
    name = data["name"].text("map")
    return None if data.problems else CorridorMap(tuple(places.values()), tuple(filter(None, corridors)), name)


def _grid(data: Checked) -> CorridorMap | None:
    data.only(("columns", "rows", "seed", "length", "accuracy", *_PARTS))
    columns, rows = (data[side].whole(0, least=1, most=1000) for side in ("columns", "rows"))
    seed = data["seed"].whole(0, most=2**31)
    numbers = {part: data[part].number(least=0.0, most=1.0) for part in _PARTS if part in data}
    numbers |= {
        name: data[name].number(least=least) for name, least in (("length", 1e-3), ("accuracy", 0.0)) if name in data
    }
    return None if data.problems else grid_map(columns, rows, seed, **numbers)


def _place(name: str, entry: Checked) -> Place:
    if not isinstance(entry.value, list) or len(entry.value) != 2:
        entry.complain(f"place '{name}' needs two coordinates", f"write '{name}: [x, y]', in m")
        return Place(name, 0.0, 0.0)
    return Place(name, entry[0].number(), entry[1].number())


def _corridor(name: str, entry: Checked, places: Mapping[str, Place]) -> Corridor | None:
    entry.only(_CORRIDOR)
    ends = entry["between"].texts() if "between" in entry else ()
    if len(ends) != 2 or any(end not in places for end in ends):
        unknown = [end for end in ends if end not in places]
        what = f"there is no place {', '.join(map(repr, unknown))}" if unknown else "it has not two ends"
        entry.complain(f"corridor '{name}': {what}", "write 'between: [A, B]'")
        return None
    one, other = (places[end] for end in ends)
    crow = distance(one, other)
    limit = entry["speed_limit"]
    return Corridor(
        name,
        one.name,
        other.name,
        length=entry["length"].number(crow, least=1e-3) if crow > 0 or "length" in entry else _missing_length(entry),
        obstacles=entry["obstacles"].whole(0),
        accuracy=entry["accuracy"].number(0.0, least=0.0),
        light=entry["light"].number(FULL_LIGHT, least=0.0, most=FULL_LIGHT),
        speed_limit=None if limit.value is None else limit.number(least=1e-3),
        one_way=entry["one_way"].flag(False),
        closed=entry["closed"].flag(False),
    )


def _missing_length(entry: Checked) -> float:
    entry.complain("its ends are at the same spot", "give its length in m")
    return 1.0
