"""Follows the best route, configures the robot for each corridor, and plans anew when what it was planned on changes.

Everything that it knows of the robot's architecture comes from the knowledge base: which configurations of
``navigate`` are feasible, and what they are estimated to be like. What it decides goes back there: the configuration
for the corridor ahead is selected in the knowledge base, whose reconfiguration plan the executor carries out. The map
is the task's own knowledge, as the problem file is in PDDL. When a component fails, the configuration planner puts
something feasible in its place at once; then this finds the best way on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise

from agv_example.corridors import CorridorMap
from agv_example.drive_configurations import DriveConfiguration, DriveOptions, drive_options
from agv_example.planning import CoAdaptivePlanner, Leg, Objective, Position, Route
from agv_example.world import AgvRobot
from rosa_core import KnowledgeBase, Status
from rosa_core.kb import Event, StatusesChanged
from rosa_core.model import ElementKind

Way = frozenset[tuple[str, str]]
"""Corridors, each with the end to which it is driven."""


@dataclass(frozen=True, slots=True)
class RouteDecision:
    """The robot's way from now on, and what it was before (the legs that were still to come)."""

    start: Position
    goal: str
    route: Route | None
    before: tuple[Leg, ...] = ()


class Navigator:
    """Knows the best route from where the robot is to one goal.

    Args:
        kb: the knowledge base; an adaptation loop carries out what is selected there.
        robot: the robot.
        objective: what routes are to be best in.
        decided: called with every new route.
    """

    def __init__(
        self, kb: KnowledgeBase, robot: AgvRobot, objective: Objective, decided: Callable[[RouteDecision], None]
    ) -> None:
        self._kb, self._robot, self._objective, self._decided = kb, robot, objective, decided
        self._planner: CoAdaptivePlanner | None = None
        self._goal: str | None = None
        self._route: Route | None = None
        self._legs: list[Leg] = []
        self._given: Leg | None = None
        self._ways: dict[tuple[tuple[str, ...], int, int], list[Way]] = {}
        self._feasible_changed = True
        kb.subscribe(self._on_event, (StatusesChanged,))

    def has_way(self, goal: str) -> bool:
        """Whether there is a route to the goal; plans if anything has changed since it last did."""
        if self._is_outdated() or goal != self._goal:
            self._plan(goal)
        return self._route is not None

    def leads_to(self, place: str) -> bool:
        """Whether the present route has this place still ahead."""
        return any(leg.end == place for leg in self._legs)

    def ways(self, goals: tuple[str, ...], due: int) -> list[Way]:
        """The best ways to several goals in turn: for each the corridors, with the end to which they are driven.

        Those to the goals before ``due``, an index, are past and empty; so are ways that there are not. The way to
        the one that is due is what the robot has yet to drive of its route; turning round in a corridor is not on it.

        Args:
            goals: names of places.
            due: the index of the goal that is to be reached next.

        Returns:
            as many as there are goals; kept until the route, or what is left of it, changes.
        """
        nowhere = [_NOWHERE] * len(goals)
        if due >= len(goals):
            return nowhere
        self.has_way(goals[due])
        planner, route = self._planner, self._route
        if planner is None or route is None:
            return nowhere
        asked = (goals, due, len(self._legs))
        if asked not in self._ways:
            self._ways[asked] = [*nowhere[:due], _way(self._legs), *self._ways_on(planner, route, goals[due:])]
        return self._ways[asked]

    def _ways_on(self, planner: CoAdaptivePlanner, first: Route, goals: tuple[str, ...]) -> list[Way]:
        """The ways from each of these goals to the next, in the configuration in which it was reached."""
        ways: list[Way] = []
        route: Route | None = first
        for start, goal in pairwise(goals):
            running = route.legs[-1].configuration.components if route is not None and route.legs else frozenset()
            route = planner.route(start, goal, self._objective, running)
            ways.append(_way(() if route is None else route.legs))
        return ways

    def follow(self) -> bool:
        """See to it that the robot drives the leg that is due; False once there is none left."""
        robot = self._robot
        if self._given is not None and robot.at.corridor is None and robot.at.place == self._given.end:
            self._legs.pop(0)
            self._given = None
        if not self._legs:
            return False
        leg = self._legs[0]
        if self._given is not leg or robot.driving_to != (leg.corridor, leg.end):
            self._given = leg
            self._configure(leg)
            robot.drive(leg.corridor, leg.end)
        return True

    def halt(self) -> None:
        """Let the robot stand; :meth:`follow` goes on from there."""
        self._robot.halt()

    def _configure(self, leg: Leg) -> None:
        """Select the leg's configuration; one that the light here forbids, once the robot looks into the corridor."""
        wanted = leg.configuration
        feasible = all(self._kb.status(_DESIGN, design) is not Status.UNFEASIBLE for design in wanted.designs)
        if not feasible:
            self._robot.face(leg.corridor)
        self._kb.select_configuration(wanted.designs, wanted.settings)

    def _is_outdated(self) -> bool:
        planner = self._planner
        if planner is None or planner.corridors is not self._robot.corridors:
            return True
        if not self._feasible_changed:
            return False
        self._feasible_changed = False
        return self._options(planner.corridors) != planner.options

    def _plan(self, goal: str) -> None:
        robot = self._robot
        self._feasible_changed = False
        corridors = robot.corridors
        self._ways.clear()
        self._planner = CoAdaptivePlanner(corridors, self._options(corridors), robot.start_up)
        components = [component.name for component in self._kb.model.components]
        running = frozenset(name for name in components if self._kb.is_component_active(name))
        before = tuple(self._legs) if goal == self._goal else ()
        route = self._planner.route(robot.at, goal, self._objective, running)
        if route is not None and route.costs.energy > robot.energy_left:
            # As good as it can be is of no use if the battery does not last.
            frugal = self._planner.route(robot.at, goal, Objective.cheapest("energy"), running)
            route = frugal if frugal is not None and frugal.costs.energy <= robot.energy_left else None
        reported = goal == self._goal and (route is None) == (self._route is None)
        self._goal, self._route = goal, route
        legs = [] if route is None else list(route.legs)
        if reported and list(map(_what, legs)) == list(map(_what, before)):
            return
        self._legs, self._given = legs, None
        self._decided(RouteDecision(robot.at, goal, route, before))

    def _options(self, corridors: CorridorMap) -> DriveOptions:
        return drive_options(self._kb, {corridor.light for corridor in corridors.corridors})

    def _on_event(self, event: Event) -> None:
        if isinstance(event, StatusesChanged):
            self._feasible_changed |= any(
                change.kind in _DECIDING and not _OUT.isdisjoint((change.old, change.new)) for change in event.changes
            )


_NOWHERE: Way = frozenset()


def _way(legs: Iterable[Leg]) -> Way:
    return frozenset((leg.corridor, leg.end) for leg in legs if not leg.back)


def _what(leg: Leg) -> tuple[str, str, DriveConfiguration]:
    """What a leg is but for its costs, which go down while it is driven."""
    return leg.corridor, leg.end, leg.configuration


_DESIGN = ElementKind.FUNCTION_DESIGN
_DECIDING = (ElementKind.ACTION, _DESIGN, ElementKind.COMPONENT_CONFIGURATION)
_OUT = frozenset({Status.UNFEASIBLE})
