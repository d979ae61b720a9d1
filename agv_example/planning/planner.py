"""The co-adaptive planner: which way, and configured how in each corridor."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from agv_example.corridors import CorridorMap
from agv_example.drive_configurations import DriveOptions
from agv_example.planning.costs import Arc, Costs, CostTable, Criterion, StartUp, cost_table
from agv_example.planning.network import Network, Row, WholeCosts, costs_by, network
from agv_example.planning.objective import Objective
from agv_example.planning.pareto import Many, pareto_paths
from agv_example.planning.route import Leg, Position, Route
from agv_example.planning.search import Path, Start, cheapest_path

NOTHING_RUNS: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class _Exit:
    """A way out of the corridor in which the robot is: which end, and what part of the corridor is to be driven."""

    place: str
    part: float
    back: bool


class CoAdaptivePlanner:
    """Finds the best path together with the best configuration for each corridor of it; there is none better.

    Args:
        corridors: the map as it is known.
        options: what the knowledge base says the robot can be configured as, in which light.
        start_up: what it takes to start a component.
    """

    def __init__(self, corridors: CorridorMap, options: DriveOptions, start_up: StartUp | None = None) -> None:
        self.corridors = corridors
        self.options = options
        self.start_up = start_up or StartUp()
        self._by_objective: dict[Objective, WholeCosts] = {}

    def route(
        self,
        start: Position | str,
        goal: str,
        objective: Objective,
        running: frozenset[str] = NOTHING_RUNS,
    ) -> Route | None:
        """The best route, or None if there is none.

        A robot that is in a corridor may go on, if it can be configured for what the corridor asks, or turn round:
        the way on which it came is known to be free, so that nothing is asked there but light and speed.

        Args:
            start: where the robot is.
            goal: the place to get to.
            objective: what the route is to be best in.
            running: the components that are active now.

        Raises:
            InputError: if there is no such place or corridor.
        """
        at = self._position(start)
        if at.corridor is None and at.place == goal:
            return Route(goal, ())
        whole = self._whole(objective)
        exits, table = self._exits(at)
        starts = self._starts(whole, whole.of(table), exits, running)
        path = cheapest_path(self._network, whole.arcs, whole.least, whole.changes, starts, self._index(goal))
        return None if path is None else self._route(path, at, goal, running, table, exits)

    def pareto(
        self,
        start: Position | str,
        goal: str,
        criteria: Iterable[Criterion | str] = tuple(Criterion),
        running: frozenset[str] = NOTHING_RUNS,
        *,
        most: int = 200_000,
    ) -> list[Route]:
        """A route for each combination of costs that no other route betters in every criterion.

        Args:
            start, goal, running: as for :meth:`route`.
            criteria: what routes are compared by.
            most: how many partial routes may be looked at.

        Returns:
            the routes, the best by the first criterion first.

        Raises:
            InputError: if there is no such place or corridor.
            TooManyRoutesError: if more partial routes are worth looking at.
        """
        at = self._position(start)
        if at.corridor is None and at.place == goal:
            return [Route(goal, ())]
        exits, table = self._exits(at)
        wholes = [self._whole(Objective.cheapest(criterion)) for criterion in criteria]
        each = [self._starts(whole, whole.of(table), exits, running) for whole in wholes]
        vectors = [tuple(start.cost for start in starts) for starts in zip(*each, strict=True)]
        many = Many([whole.arcs for whole in wholes], [whole.changes for whole in wholes])
        paths = pareto_paths(self._network, many, each[0], vectors, self._index(goal), most=most)
        return [self._route(path, at, goal, running, table, exits) for path in paths]

    # -- what does not depend on the question --

    @cached_property
    def _network(self) -> Network:
        return network(self.corridors)

    @cached_property
    def _table(self) -> CostTable:
        return cost_table(self._network.arcs, self.options)

    @cached_property
    def _changes(self) -> CostTable:
        return self._start_up_table([self._parts, self._parts])

    @cached_property
    def _parts(self) -> list[frozenset[str]]:
        return [one.components for one in self.options.configurations]

    def _start_up_table(self, sets: Sequence[Sequence[frozenset[str]]]) -> CostTable:
        rows, columns = sets
        started = np.array([[len(to - running) for to in columns] for running in rows], dtype=np.float64)
        started = started.reshape(len(rows), len(columns))
        one = self.start_up
        return CostTable(started * one.energy, started * one.time, started * 0.0, np.ones_like(started, dtype=np.bool_))

    def _whole(self, objective: Objective) -> WholeCosts:
        if objective not in self._by_objective:
            from_nothing = self._start_up_table([[NOTHING_RUNS], self._parts])
            places = len(self.corridors.places)
            whole = costs_by(objective, self._table, self._changes, from_nothing, places)
            self._by_objective[objective] = whole
        return self._by_objective[objective]

    # -- where to start --

    def _position(self, start: Position | str) -> Position:
        at = Position(start) if isinstance(start, str) else start
        self.corridors.place(at.place)
        return at if at.travelled > 0.0 else Position(at.place)

    def _index(self, place: str) -> int:
        self.corridors.place(place)
        return self.corridors.place_index[place]

    def _exits(self, at: Position) -> tuple[list[_Exit], CostTable]:
        """The ways to a place from where the robot is, and what driving them costs (a row for each)."""
        if at.corridor is None:
            table = cost_table((), self.options)
            return [_Exit(at.place, 0.0, False)], table
        corridor = self.corridors.corridor(at.corridor)
        end = corridor.other_end(at.place)
        travelled = min(max(at.travelled / corridor.length, 0.0), 1.0)
        known_way = replace(corridor, accuracy=0.0, closed=False)
        ways: list[tuple[Arc, _Exit]] = [((known_way, end), _Exit(at.place, travelled, True))]
        if at.place in corridor.origins():
            ways.insert(0, ((corridor, at.place), _Exit(end, 1.0 - travelled, False)))
        whole = cost_table([arc for arc, _ in ways], self.options)
        parts = np.array([one.part for _, one in ways])[:, None]
        table = CostTable(whole.energy * parts, whole.time * parts, whole.risk * parts, whole.allowed)
        return [one for _, one in ways], table

    def _starts(
        self, whole: WholeCosts, rows: Sequence[Row], exits: Sequence[_Exit], running: frozenset[str]
    ) -> list[Start]:
        """Every configuration at each place that can be reached first."""
        (ready,) = whole.of(self._start_up_table([[running], self._parts]))
        starts: list[Start] = []
        for number, one in enumerate(exits):
            row = rows[number] if rows else [0] * len(self._parts)
            place = self._index(one.place)
            starts += [
                Start(place, column, cost + ready[column], number) for column, cost in enumerate(row) if cost >= 0
            ]
        return starts

    # -- the answer --

    def _route(
        self, path: Path, at: Position, goal: str, running: frozenset[str], table: CostTable, exits: Sequence[_Exit]
    ) -> Route:
        legs: list[Leg] = []

        def add(corridor: str, ends: tuple[str, str], number: int, costs: Costs, back: bool = False) -> None:
            nonlocal running
            configuration = self.options.configurations[number]
            change = self.start_up.costs(running, configuration.components)
            legs.append(Leg(corridor, *ends, configuration, costs + change, back))
            running = configuration.components

        first = exits[path.start.exit]
        if at.corridor is not None:
            number = path.start.configuration
            add(at.corridor, (at.place, first.place), number, table.costs(path.start.exit, number), first.back)
        for arc, number in path.steps:
            corridor, origin = self._network.arcs[arc]
            add(corridor.name, (origin, corridor.other_end(origin)), number, self._table.costs(arc, number))
        return Route(goal, tuple(legs))
