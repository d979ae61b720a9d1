"""No managing system: the best route in one configuration for all of it, decided once, and nothing adapts."""

from __future__ import annotations

from collections.abc import Iterable

from agv_example.drive_configurations import ACTION, SPEED, DriveOptions, drive_options
from agv_example.managers.manager import ManagedMission
from agv_example.missions.tree import goal_queue_leaves, mission_tree
from agv_example.navigator import RouteDecision
from agv_example.planning import CoAdaptivePlanner, Leg, Route
from rosa_core import KnowledgeBase
from task_layer.bt import TreeRunner
from task_layer.skill import Skill, SkillStatus


class FixedDrive(Skill):
    """Drive the next of some routes that were decided on beforehand."""

    def __init__(self, mission: ManagedMission, routes: Iterable[tuple[str, Route | None]]) -> None:
        self._mission = mission
        self._routes = iter(routes)
        self._legs: list[Leg] | None = None

    def start(self) -> None:
        """Switch on what the route is to be driven with."""
        robot, (goal, route) = self._mission.robot, next(self._routes)
        self._legs = None if route is None else list(route.legs)
        self._mission.on_route(RouteDecision(robot.at, goal, route))
        if self._legs:
            configuration = self._legs[0].configuration
            for component in sorted(configuration.components):
                robot.activate(component)
            robot.set_parameters("move_base", {SPEED: configuration.speed})

    def update(self) -> SkillStatus:
        """Done once the robot is there; it waits for what does not work."""
        robot, legs = self._mission.robot, self._legs
        if legs is None:
            return SkillStatus.RUNNING
        if legs and robot.is_at(legs[0].end):
            legs.pop(0)
        if not legs:
            return SkillStatus.SUCCESS
        if robot.driving_to != (legs[0].corridor, legs[0].end):
            robot.drive(legs[0].corridor, legs[0].end)
        return SkillStatus.RUNNING


def no_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree, with nobody to ask what is feasible."""
    options = drive_options(KnowledgeBase(mission.model, clock=mission.robot.clock), mission.config.lights)
    ends = zip((mission.config.start, *mission.config.goals), mission.config.goals, strict=False)
    routes = [(goal, _route_in_one(mission, options, start, goal)) for start, goal in ends]
    registry = goal_queue_leaves(mission.goal_queue)
    registry.count_all_as_feasible()
    registry.add("is_there_a_way", lambda: True)
    registry.add(ACTION, FixedDrive(mission, routes), request=False)
    return mission.runner(mission_tree(registry))


def _route_in_one(mission: ManagedMission, options: DriveOptions, start: str, goal: str) -> Route | None:
    """The best route in a single configuration."""
    objective = mission.config.objective
    found: list[Route] = []
    for number, configuration in enumerate(options.configurations):
        lit = {case: frozenset({0} if number in several else ()) for case, several in options.lit.items()}
        alone = DriveOptions((configuration,), options.limits, lit)
        route = CoAdaptivePlanner(mission.robot.corridors, alone, mission.robot.start_up).route(start, goal, objective)
        if route is not None:
            found.append(route)
    return min(found, key=lambda route: objective.values(route.costs), default=None)
