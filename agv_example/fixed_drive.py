"""Driving without a managing system: the best route in one configuration for all of it, decided once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from agv_example.drive_configurations import SPEED, DriveOptions, drive_options
from agv_example.missions.mission_config import MissionConfig
from agv_example.navigator import RouteDecision
from agv_example.planning import CoAdaptivePlanner, Leg, Route
from agv_example.world import AgvRobot
from rosa_core import KnowledgeBase, KnowledgeModel
from task_layer.skill import Skill, SkillStatus


class FixedDrive(Skill):
    """Drive the next of some routes that were decided on beforehand.

    Args:
        robot: the robot, which the skill configures by itself.
        routes: a route (None: there is none) for each goal in turn.
        decided: called with each route when it is begun.
    """

    def __init__(
        self,
        robot: AgvRobot,
        routes: Iterable[tuple[str, Route | None]],
        decided: Callable[[RouteDecision], None],
    ) -> None:
        self._robot = robot
        self._routes = iter(routes)
        self._decided = decided
        self._legs: list[Leg] | None = None

    def start(self) -> None:
        """Switch on what the route is to be driven with."""
        robot, (goal, route) = self._robot, next(self._routes)
        self._legs = None if route is None else list(route.legs)
        self._decided(RouteDecision(robot.at, goal, route))
        if self._legs:
            configuration = self._legs[0].configuration
            for component in sorted(configuration.components):
                robot.activate(component)
            robot.set_parameters("move_base", {SPEED: configuration.speed})

    def update(self) -> SkillStatus:
        """Done once the robot is there; it waits for what does not work."""
        robot, legs = self._robot, self._legs
        if legs is None:
            return SkillStatus.RUNNING
        if legs and robot.is_at(legs[0].end):
            legs.pop(0)
        if not legs:
            return SkillStatus.SUCCESS
        if robot.driving_to != (legs[0].corridor, legs[0].end):
            robot.drive(legs[0].corridor, legs[0].end)
        return SkillStatus.RUNNING


def fixed_routes(robot: AgvRobot, config: MissionConfig, model: KnowledgeModel) -> Iterator[tuple[str, Route | None]]:
    """For each goal in turn the best route in a single configuration, with the map as it is now.

    Args:
        robot: for its map and the costs of starting components; it does not move.
        config: the goals and the objective.
        model: for the configurations that there are.

    Returns:
        each goal with the route from the one before it; None if no single configuration gets there.
    """
    options = drive_options(KnowledgeBase(model, clock=robot.clock), config.lights)
    planners = [CoAdaptivePlanner(robot.corridors, alone, robot.start_up) for alone in _single(options)]
    for start, goal in zip((config.start, *config.goals), config.goals, strict=False):
        found = [planner.route(start, goal, config.objective) for planner in planners]
        routes = [route for route in found if route is not None]
        yield goal, min(routes, key=lambda route: config.objective.values(route.costs), default=None)


def _single(options: DriveOptions) -> Iterator[DriveOptions]:
    """Each configuration as if it were the only one."""
    for number, configuration in enumerate(options.configurations):
        lit = {case: frozenset({0} if number in several else ()) for case, several in options.lit.items()}
        yield DriveOptions((configuration,), options.limits, lit)
