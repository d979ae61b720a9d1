"""Shortest paths in the product of places and configurations, exactly: A* on whole numbers.

A state is a place and a configuration. Driving leads to another place in the same configuration, reconfiguring to
another configuration at the same place. What driving to the goal would cost if reconfiguring were free bounds from
below what is still to come; it is found by Dijkstra's algorithm from the goal, on places alone. The bound is
consistent, so that every state is looked at once (Hart, Nilsson and Raphael, 1968).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush

from agv_example.planning.network import Network, Row


@dataclass(frozen=True, slots=True)
class Start:
    """A state to start from, what it costs to get there, and the number of the way that leads there."""

    place: int
    configuration: int
    cost: int
    exit: int = 0


@dataclass(frozen=True, slots=True)
class Path:
    """A start, and the arcs from there with the configuration of each."""

    start: Start
    steps: tuple[tuple[int, int], ...]


def lower_bounds(network: Network, least: Row, goal: int, places: Iterable[int]) -> tuple[dict[int, int], int]:
    """For each place what it costs at least to get to the goal from there.

    Args:
        network: the arcs.
        least: what each costs at least; see :func:`~agv_example.planning.network.least_costs`.
        goal: the place to get to.
        places: those whose bounds are asked for; the search ends when all of them are known.

    Returns:
        the bounds, and one for all places that it does not have: these are at least that far.
    """
    wanted = set(places)
    bounds: dict[int, int] = {}
    heap = [(0, goal)]
    reached = {goal: 0}
    while heap:
        cost, place = heappop(heap)
        if place in bounds:
            continue
        bounds[place] = cost
        wanted.discard(place)
        if not wanted:
            return bounds, cost
        for arc, before in network.incoming[place]:
            if before in bounds or least[arc] < 0:
                continue
            total = cost + least[arc]
            known = reached.get(before)
            if known is None or total < known:
                reached[before] = total
                heappush(heap, (total, before))
    return bounds, -1


def cheapest_path(
    network: Network, rows: Sequence[Row], least: Row, changes: Sequence[Row], starts: Sequence[Start], goal: int
) -> Path | None:
    """The cheapest path from any of the starts to the goal, in whatever configuration; None if there is none.

    Args:
        network: the arcs.
        rows: the cost of each arc in each configuration; below 0 where there is none.
        least: what each arc costs at least.
        changes: the cost of getting from one configuration (row) to another (column); a detour is never cheaper.
        starts: where to start.
        goal: the place to get to.
    """
    return _Search(network, rows, changes, goal, lower_bounds(network, least, goal, {s.place for s in starts})).run(
        starts
    )


_CHANGED = -1
_STARTED = (-1, 0)


class _Search:
    """A state is numbered ``place * width + configuration``, with as many configurations as there are (width)."""

    def __init__(
        self,
        network: Network,
        rows: Sequence[Row],
        changes: Sequence[Row],
        goal: int,
        bounds: tuple[dict[int, int], int],
    ) -> None:
        self._network, self._rows, self._changes, self._goal = network, rows, changes, goal
        self._bounds, self._beyond = bounds
        self._width = len(changes)
        self._best: dict[int, int] = {}
        self._came: dict[int, tuple[int, int]] = {}
        self._done: set[int] = set()
        # Of equal estimates the one that is further on comes first.
        self._heap: list[tuple[int, int, int]] = []

    def run(self, starts: Sequence[Start]) -> Path | None:
        heap, done = self._heap, self._done
        origin: dict[int, Start] = {}
        for start in starts:
            state = start.place * self._width + start.configuration
            if self._reach(state, start.cost, _STARTED):
                origin[state] = start
        while heap:
            _, minus_cost, state = heappop(heap)
            if state in done:
                continue
            done.add(state)
            if state // self._width == self._goal:
                return self._path(state, origin)
            self._drive(state, -minus_cost)
            if self._came[state][1] != _CHANGED:
                self._change(state, -minus_cost)
        return None

    def _drive(self, state: int, cost: int) -> None:
        width, rows = self._width, self._rows
        place, configuration = divmod(state, width)
        for arc, other in self._network.outgoing[place]:
            step = rows[arc][configuration]
            if step >= 0:
                self._reach(other * width + configuration, cost + step, (state, arc))

    def _change(self, state: int, cost: int) -> None:
        place, configuration = divmod(state, self._width)
        first, came = place * self._width, (state, _CHANGED)
        for changed, step in enumerate(self._changes[configuration]):
            self._reach(first + changed, cost + step, came)

    def _reach(self, state: int, cost: int, came: tuple[int, int]) -> bool:
        known = self._best.get(state)
        if known is not None and known <= cost:
            return False
        bound = self._bounds.get(state // self._width, self._beyond)
        if bound < 0:
            return False
        self._best[state] = cost
        self._came[state] = came
        heappush(self._heap, (cost + bound, -cost, state))
        return True

    def _path(self, state: int, origin: Mapping[int, Start]) -> Path:
        steps: list[tuple[int, int]] = []
        while self._came[state] != _STARTED:
            before, arc = self._came[state]
            if arc != _CHANGED:
                steps.append((arc, state % self._width))
            state = before
        return Path(origin[state], tuple(reversed(steps)))
