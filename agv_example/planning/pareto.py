"""All routes of which none is better in every criterion: label setting with lower bounds, exactly.

After NAMOA* (Mandow and Perez de la Cruz, 2010), on the product of places and configurations.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from operator import add

from agv_example.planning.network import Network, Row, least_costs
from agv_example.planning.search import Path, Start, lower_bounds
from rosa_core import RosaError

Vector = tuple[int, ...]


class TooManyRoutesError(RosaError):
    """There are more routes worth considering than the search may look at."""


@dataclass(frozen=True, slots=True)
class Many:
    """The costs of one start, arc or change by each criterion; arcs and changes as in a search by one criterion."""

    arcs: Sequence[Sequence[Row]]
    changes: Sequence[Sequence[Row]]


@dataclass(frozen=True, slots=True)
class _Label:
    state: int
    costs: Vector
    before: _Label | None
    arc: int
    start: int


def pareto_paths(
    network: Network, costs: Many, starts: Sequence[Start], vectors: Sequence[Vector], goal: int, *, most: int
) -> list[Path]:
    """One path for each vector of costs that no other path betters or equals in every criterion.

    Args:
        network: the arcs.
        costs: what they cost, by each criterion.
        starts: where to start; ``vectors`` says what each costs by each criterion.
        goal: the place to get to.
        most: how many labels may be looked at.

    Returns:
        the paths, in order of the first criterion.

    Raises:
        TooManyRoutesError: if there is more to be looked at.
    """
    return _Search(network, costs, starts, vectors, goal, most).run()


class _Search:
    def __init__(
        self,
        network: Network,
        costs: Many,
        starts: Sequence[Start],
        vectors: Sequence[Vector],
        goal: int,
        most: int,
    ) -> None:
        self._network, self._costs, self._starts, self._goal, self._most = network, costs, starts, goal, most
        places = {start.place for start in starts}
        self._bounds = [lower_bounds(network, least_costs(rows), goal, places) for rows in costs.arcs]
        self._width = len(costs.changes[0])
        self._fronts: dict[int, list[Vector]] = {}
        self._heap: list[tuple[Vector, int, _Label]] = []
        self._pushed = 0
        for number, (start, vector) in enumerate(zip(starts, vectors, strict=True)):
            self._push(_Label(start.place * self._width + start.configuration, vector, None, _STARTED, number))

    def run(self) -> list[Path]:
        found: list[tuple[Vector, Path]] = []
        looked_at = 0
        while self._heap:
            estimate, _, label = heappop(self._heap)
            front = self._fronts.setdefault(label.state, [])
            if _covered(label.costs, front) or any(_at_most(vector, estimate) for vector, _ in found):
                continue
            front.append(label.costs)
            looked_at += 1
            if looked_at > self._most:
                what = f"more than {self._most} partial routes are worth looking at"
                raise TooManyRoutesError(f"{what}; ask for fewer criteria, or for an order of them")
            if label.state // self._width == self._goal:
                found.append((label.costs, self._path(label)))
            else:
                self._expand(label)
        return [path for _, path in found]

    def _expand(self, label: _Label) -> None:
        place, configuration = divmod(label.state, self._width)
        for arc, other in self._network.outgoing[place]:
            step = tuple(rows[arc][configuration] for rows in self._costs.arcs)
            if step[0] >= 0:
                self._push(self._after(label, other * self._width + configuration, step, arc))
        if label.arc != _CHANGED:
            for changed in range(self._width):
                if changed != configuration:
                    step = tuple(rows[configuration][changed] for rows in self._costs.changes)
                    self._push(self._after(label, place * self._width + changed, step, _CHANGED))

    def _after(self, label: _Label, state: int, step: Vector, arc: int) -> _Label:
        return _Label(state, tuple(map(add, label.costs, step)), label, arc, label.start)

    def _push(self, label: _Label) -> None:
        if _covered(label.costs, self._fronts.get(label.state, ())):
            return
        ahead = [bounds.get(label.state // self._width, beyond) for bounds, beyond in self._bounds]
        if min(ahead) >= 0:
            self._pushed += 1
            heappush(self._heap, (tuple(map(add, label.costs, ahead)), self._pushed, label))

    def _path(self, label: _Label) -> Path:
        steps: list[tuple[int, int]] = []
        one: _Label | None = label
        while one is not None:
            if one.arc >= 0:
                steps.append((one.arc, one.state % self._width))
            one = one.before
        return Path(self._starts[label.start], tuple(reversed(steps)))


_CHANGED = -1
_STARTED = -2


def _at_most(one: Vector, other: Vector) -> bool:
    return all(a <= b for a, b in zip(one, other, strict=True))


def _covered(vector: Vector, front: Sequence[Vector]) -> bool:
    return any(_at_most(known, vector) for known in front)
