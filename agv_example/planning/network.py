"""The map and its costs in the form that searching wants: numbered places, lists of arcs, costs in whole numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from agv_example.corridors import CorridorMap
from agv_example.planning.costs import Arc, CostTable
from agv_example.planning.objective import Objective, Weights
from rosa_core import InvalidValueError

if TYPE_CHECKING:
    from numpy.typing import NDArray

QUANTUM = 1e-6
"""The unit of costs in a search, in units of the most heavily weighted criterion. Whole numbers add up exactly."""
_MOST = 2**62

Row = list[int]
"""What an arc costs in each configuration; below 0 where it cannot be driven."""


@dataclass(frozen=True)
class Network:
    """The arcs of a map; ``outgoing`` and ``incoming`` give for each place pairs of arc and place at the other end."""

    arcs: tuple[Arc, ...]
    outgoing: tuple[tuple[tuple[int, int], ...], ...]
    incoming: tuple[tuple[tuple[int, int], ...], ...]


def network(corridors: CorridorMap) -> Network:
    """All ways to drive a corridor; those that are closed are arcs as well, but lead nowhere."""
    index = corridors.place_index
    arcs: list[Arc] = []
    outgoing: list[list[tuple[int, int]]] = [[] for _ in index]
    incoming: list[list[tuple[int, int]]] = [[] for _ in index]
    for corridor in corridors.corridors:
        origins = corridor.origins()
        for origin in (corridor.start, corridor.end):
            if origin in origins:
                one, other = index[origin], index[corridor.other_end(origin)]
                outgoing[one].append((len(arcs), other))
                incoming[other].append((len(arcs), one))
            arcs.append((corridor, origin))
    return Network(tuple(arcs), tuple(map(tuple, outgoing)), tuple(map(tuple, incoming)))


def _weighted(table: CostTable, weights: Weights) -> NDArray[np.int64]:
    """The weighted sum of the costs of each arc in each configuration, allowed or not."""
    largest = max(weight for _, weight in weights)
    total = np.zeros(table.allowed.shape)
    for criterion, weight in weights:
        total += weight / largest * table.of(criterion)
    if total.size and not total.max() / QUANTUM < _MOST:
        raise InvalidValueError("the costs on this map are too large to be added up")
    whole: NDArray[np.int64] = np.rint(total / QUANTUM).astype(np.int64)
    return whole


def _rows(table: CostTable, stages: tuple[Weights, ...], factors: tuple[int, ...]) -> list[Row]:
    total = _weighted(table, stages[0])
    if len(stages) > 1:
        # Beyond 64 bits: Python's own integers.
        parts = zip(stages, factors, strict=True)
        total = sum(_weighted(table, stage).astype(np.object_) * factor for stage, factor in parts)
    rows: list[Row] = np.where(table.allowed, total, -1).tolist()
    return rows


def least_costs(rows: Sequence[Row]) -> Row:
    """What each arc costs in the configuration that is cheapest there; below 0 where it cannot be driven."""
    return [min((cost for cost in row if cost >= 0), default=-1) for row in rows]


@dataclass(frozen=True)
class WholeCosts:
    """Costs by an objective, in whole numbers: of arcs (rows), and of getting from one configuration to another.

    An order of criteria is one number too: each stage counts for more than all that the later ones can amount to.
    """

    factors: tuple[int, ...]
    stages: tuple[Weights, ...]
    arcs: list[Row]
    changes: list[Row]

    @cached_property
    def least(self) -> Row:
        """See :func:`least_costs`."""
        return least_costs(self.arcs)

    def of(self, arcs: CostTable) -> list[Row]:
        """The same for other arcs."""
        return _rows(arcs, self.stages, self.factors)


def costs_by(objective: Objective, arcs: CostTable, changes: CostTable, starts: CostTable, places: int) -> WholeCosts:
    """The costs by an objective.

    Args:
        objective: what they are judged by.
        arcs: what driving costs.
        changes: what getting from a configuration (row) to another (column) costs.
        starts: the most that getting ready in the beginning can cost.
        places: how many there are; but for the way out of a corridor no best route has more legs.

    Raises:
        InvalidValueError: if a cost is too large to be counted.
    """
    factors = [1]
    for stage in reversed(objective.stages[1:]):
        most = (places + 1) * sum(int(_weighted(table, stage).max(initial=0)) for table in (arcs, changes, starts))
        factors.insert(0, factors[0] * (most + 1))
    weights, stages = tuple(factors), objective.stages
    return WholeCosts(weights, stages, _rows(arcs, stages, weights), _rows(changes, stages, weights))
