"""ROSA with the mission in PDDL: a plan of corridors and stops, on the way that the route planner says is best."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path

from agv_example.drive_configurations import ACTION
from agv_example.managers.manager import TICK_PERIOD, ManagedMission
from agv_example.managers.rosa import knowledge_base_of
from agv_example.missions.mission_config import MissionConfig
from agv_example.missions.problem import PddlProblem, mission_problem
from agv_example.navigator import Navigator
from agv_example.skills import ARRIVE, Arrive, GoalQueue, Navigate
from agv_example.world import AgvRobot
from rosa_core.formats.text_source import read_text
from task_layer.pddl import ExecutionLimits, GroundTask, PlanExecutor, Planner, Sensor, parse_task
from task_layer.skill import Skill

_LIMITS = ExecutionLimits(attempts=10_000, replans=10_000, patience=math.inf)
"""A robot without a way waits for one, as it does with a tree; the mission's time limit ends that."""
_SENSED = ("robot_at", "best_way")


@dataclass(frozen=True, slots=True)
class MissionFiles:
    """A mission's PDDL files; None: the domain that comes with the AGV, a problem made from the map."""

    domain: Path | None = None
    problem: Path | None = None


def load_mission_task(config: MissionConfig, given: MissionFiles) -> tuple[GroundTask, PddlProblem]:
    """The mission as a planning task, and what its objects are called on the map.

    Raises:
        InputError: if a file cannot be read.
    """
    domain = given.domain or Path(str(files("agv_example.missions"))) / "agv_domain.pddl"
    made = mission_problem(config)
    text = made.text if given.problem is None else read_text(given.problem)
    problem_file = "the problem made from the map" if given.problem is None else str(given.problem)
    task = parse_task(read_text(domain), text, sensed=_SENSED, domain_file=str(domain), problem_file=problem_file)
    return task, made


def rosa_plan(mission: ManagedMission, given: MissionFiles) -> PlanExecutor:
    """The mission as a plan, carried out with the skills that the behaviour tree uses."""
    task, problem = load_mission_task(mission.config, given)
    robot, goal_queue, kb = mission.robot, mission.goal_queue, knowledge_base_of(mission)
    navigator = Navigator(kb, robot, mission.config.objective, mission.on_route)

    def navigate(*objects: str) -> Skill:
        """Drive to the last of the objects, on the way to the stop that is among them, if one is."""
        place = problem.place(objects[-1])
        goals = [
            goal_queue.goals[problem.stops.index(name.lower())] for name in objects if name.lower() in problem.stops
        ]
        goal = goals[-1] if goals else place
        return Navigate(navigator, robot, lambda: goal, until=place)

    def arrive(*_objects: str) -> Skill:
        return Arrive(goal_queue)

    sensors = _sensors(robot, navigator, goal_queue, problem)
    return PlanExecutor(
        Planner(task),
        kb,
        {ACTION: navigate, ARRIVE: arrive},
        period=TICK_PERIOD,
        sensors={name: sensor for name, sensor in sensors.items() if name in task.predicates},
        limits=_LIMITS,
        around_tick=mission.recorder.stopwatch.running,
        on_plan=mission.recorder.on_plan,
    )


def _sensors(robot: AgvRobot, navigator: Navigator, goal_queue: GoalQueue, problem: PddlProblem) -> dict[str, Sensor]:
    """What the robot sees for itself, and what the co-adaptive planner says; there is one robot, whatever its name."""

    def robot_at(_robot: str, place: str) -> bool:
        return robot.at.place == problem.place(place)

    @cache
    def meaning(stop: str, corridor: str, to: str) -> tuple[int, tuple[str, str]] | None:
        if stop.lower() not in problem.stops:
            return None
        way = problem.corridors.get(corridor.lower(), corridor), problem.place(to)
        return problem.stops.index(stop.lower()), way

    def best_way(stop: str, corridor: str, to: str) -> bool:
        meant = meaning(stop, corridor, to)
        return meant is not None and meant[1] in navigator.ways(goal_queue.goals, goal_queue.number)[meant[0]]

    return {"robot_at": robot_at, "best_way": best_way}
