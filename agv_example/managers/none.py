"""No managing system: the best route in one configuration for all of it, decided once, and nothing adapts."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from agv_example.drive_configurations import SPEED, DriveOptions, drive_options
from agv_example.managers.manager import ManagedMission
from agv_example.missions.trees import delivery
from agv_example.navigator import RouteDecision
from agv_example.planning import CoAdaptivePlanner, Leg, Position, Route
from rosa_core import KnowledgeBase
from task_layer.bt import SkillAction, TreeRunner
from task_layer.skill import Skill, SkillStatus


class FixedDrive(Skill):
    """Drive along a route that was decided on beforehand."""

    def __init__(self, mission: ManagedMission, goal: str, route: Route | None) -> None:
        self._mission, self._goal, self._route = mission, goal, route
        self._legs: list[Leg] = []

    def start(self) -> None:
        """Switch on what the route is to be driven with."""
        robot = self._mission.robot
        self._legs = list(self._route.legs) if self._route is not None else []
        self._mission.on_route(RouteDecision(robot.at, self._goal, self._route))
        if self._legs:
            configuration = self._legs[0].configuration
            for component in sorted(configuration.components):
                robot.activate(component)
            robot.set_parameters("move_base", {SPEED: configuration.speed})

    def update(self) -> SkillStatus:
        """Done once the robot is there; it waits for what does not work."""
        robot = self._mission.robot
        if self._route is None:
            return SkillStatus.RUNNING
        if self._legs and robot.at == Position(self._legs[0].end):
            self._legs.pop(0)
        if not self._legs:
            robot.arrive(self._goal)
            return SkillStatus.SUCCESS
        leg = self._legs[0]
        if robot.driving_to != (leg.corridor, leg.end):
            robot.drive(leg.corridor, leg.end)
        return SkillStatus.RUNNING


def no_manager(mission: ManagedMission) -> TreeRunner:
    """The mission's tree without feasibility guards."""
    options = drive_options(KnowledgeBase(mission.model, clock=mission.robot.clock), mission.config.lights)
    ends = zip((mission.config.start, *mission.config.goals), mission.config.goals, strict=False)
    drives = iter([FixedDrive(mission, goal, _route_in_one(mission, options, start, goal)) for start, goal in ends])

    def perform(goal: str) -> Behaviour:
        return SkillAction(f"drive to {goal}", next(drives))

    return mission.runner(delivery(mission.config.goals, perform))


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
