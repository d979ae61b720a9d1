"""Maps made up for measuring and testing: grids of corridors, some with obstacles, some dark, some slow."""

from __future__ import annotations

import math
import random

import networkx as nx

from agv_example.corridors import FULL_LIGHT, Corridor, CorridorMap, Place
from rosa_core import InvalidValueError

LARGEST = 100_000


def grid_map(
    columns: int,
    rows: int,
    seed: int = 0,
    *,
    length: float = 10.0,
    missing: float = 0.1,
    obstructed: float = 0.2,
    accuracy: float = 1.6,
    dark: float = 0.3,
    slow: float = 0.1,
) -> CorridorMap:
    """A grid of places ``p0_0`` to ``p{columns-1}_{rows-1}``; every place can be reached. The same seed, the same map.

    Args:
        columns, rows: how many places there are.
        seed: where chance starts.
        length: m between neighbours; each corridor is up to a half longer.
        missing: the part of the corridors that is left out, as far as the map stays in one piece.
        obstructed: the part that has one to three obstacles and asks for ``accuracy``.
        accuracy: see :class:`~agv_example.corridors.Corridor`.
        dark: the part that has little light.
        slow: the part with a limit of 0.35 m/s.

    Raises:
        InvalidValueError: if the numbers make no grid.
    """
    if columns < 1 or rows < 1 or columns * rows > LARGEST:
        raise InvalidValueError(f"a grid of {columns} x {rows} places cannot be made; up to {LARGEST} places can")
    if not all(0.0 <= part <= 1.0 for part in (missing, obstructed, dark, slow)) or not 0.0 < length < math.inf:
        raise InvalidValueError("the parts of a grid's corridors are from 0 to 1, and the length is above 0")
    chance = random.Random(seed)  # noqa: S311 - a map, not a secret
    graph = nx.grid_2d_graph(columns, rows)
    kept = {frozenset(edge) for edge in nx.minimum_spanning_edges(_weighted(graph, chance), data=False)}
    places = tuple(Place(f"p{x}_{y}", x * length, y * length) for x, y in graph)
    corridors = []
    for one, other in graph.edges:
        left_out, obstacles = chance.random() < missing, chance.random() < obstructed
        corridor = Corridor(
            name=f"c{one[0]}_{one[1]}-{other[0]}_{other[1]}",
            start=f"p{one[0]}_{one[1]}",
            end=f"p{other[0]}_{other[1]}",
            length=round(length * chance.uniform(1.0, 1.5), 3),
            obstacles=chance.randint(1, 3) if obstacles else 0,
            accuracy=accuracy if obstacles else 0.0,
            light=0.2 if chance.random() < dark else FULL_LIGHT,
            speed_limit=0.35 if chance.random() < slow else None,
        )
        if not left_out or frozenset((one, other)) in kept:
            corridors.append(corridor)
    return CorridorMap(places, tuple(corridors), f"grid of {columns} x {rows}")


def _weighted(graph: nx.Graph[tuple[int, int]], chance: random.Random) -> nx.Graph[tuple[int, int]]:
    for one, other in graph.edges:
        graph.edges[one, other]["weight"] = chance.random()
    return graph
