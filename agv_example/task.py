"""What the task layer performs the AGV's mission with: drives to goals in turn, in a tree or in a plan of corridors."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from agv_example.drive_configurations import ACTION
from agv_example.fixed_drive import FixedDrive, fixed_routes
from agv_example.missions.mission_config import MissionConfig
from agv_example.missions.problem import PddlProblem, mission_problem
from agv_example.navigator import Navigator, RouteDecision
from agv_example.skills import ARRIVE, Arrive, GoalQueue, Navigate
from agv_example.world import AgvRobot
from rosa_core import KnowledgeBase, KnowledgeModel
from rosa_simulation.mission import TaskParts
from task_layer.bt import NodeKind, Registry
from task_layer.pddl import Sensor
from task_layer.skill import Skill

OnRoute = Callable[[RouteDecision], None]
"""Called with every route that is decided on."""


class AgvTask:
    """The mission's goals and how they are driven to.

    Args:
        robot: the robot.
        config: the mission.
        model: what the robot knows of itself.
        on_route: called with every route that is decided on.
    """

    def __init__(
        self,
        robot: AgvRobot,
        config: MissionConfig,
        model: KnowledgeModel,
        on_route: OnRoute,
    ) -> None:
        self._robot, self._config, self._model = robot, config, model
        self._on_route = on_route
        self.goals = GoalQueue(robot, config.goals)
        self.problem = cache(lambda: mission_problem(config))
        """Makes the mission's PDDL problem."""

    def parts(self, kb: KnowledgeBase | None) -> TaskParts:
        """With a knowledge base the best way in the best configuration; without one, fixed routes."""
        return self._fixed() if kb is None else self._co_adaptive(kb)

    def _fixed(self) -> TaskParts:
        routes = list(fixed_routes(self._robot, self._config, self._model))
        return TaskParts(
            skills={ACTION: FixedDrive(self._robot, routes, self._on_route)},
            own_skills={ARRIVE: Arrive(self.goals)},
            leaves=lambda: self._conditions(lambda: True),
        )

    def _co_adaptive(self, kb: KnowledgeBase) -> TaskParts:
        robot, goals = self._robot, self.goals
        navigator = Navigator(kb, robot, self._config.objective, self._on_route)

        def navigate(*objects: str) -> Skill:
            """Drive to the last of the objects, on the way to the stop that is among them, if one is."""
            problem = self.problem()
            place = problem.place(objects[-1])
            stops = [problem.stops.index(name.lower()) for name in objects if name.lower() in problem.stops]
            goal = goals.goals[stops[-1]] if stops else place
            return Navigate(navigator, robot, lambda: goal, until=place)

        arrive = Arrive(goals)
        return TaskParts(
            skills={ACTION: Navigate(navigator, robot, lambda: goals.due)},
            own_skills={ARRIVE: arrive},
            leaves=lambda: self._conditions(lambda: goals.due is None or navigator.has_way(goals.due)),
            sensors=_sensors(robot, navigator, goals, self.problem),
            plan_skills={ACTION: navigate, ARRIVE: arrive},
        )

    def _conditions(self, is_there_a_way: Callable[[], bool]) -> Registry:
        def are_all_goals_reached() -> bool:
            return self.goals.done

        registry = Registry({"are_all_goals_reached": are_all_goals_reached})
        return registry.add("is_there_a_way", is_there_a_way, kind=NodeKind.CONDITION)


def _sensors(
    robot: AgvRobot, navigator: Navigator, goals: GoalQueue, problem: Callable[[], PddlProblem]
) -> dict[str, Sensor]:
    """What the robot sees for itself, and what the co-adaptive planner says; there is one robot, whatever its name."""

    def robot_at(_robot: str, place: str) -> bool:
        return robot.at.place == problem().place(place)

    @cache
    def meaning(stop: str, corridor: str, to: str) -> tuple[int, tuple[str, str]] | None:
        """The number of the stop, and the corridor with the end to which it is driven."""
        stops = problem().stops
        if stop.lower() not in stops:
            return None
        return stops.index(stop.lower()), (problem().corridors.get(corridor.lower(), corridor), problem().place(to))

    def best_way(stop: str, corridor: str, to: str) -> bool:
        meant = meaning(stop, corridor, to)
        return meant is not None and meant[1] in navigator.ways(goals.goals, goals.number)[meant[0]]

    return {"robot_at": robot_at, "best_way": best_way}
