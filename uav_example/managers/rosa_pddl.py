"""ROSA with the mission in PDDL: the planner chooses the actions, the knowledge base says which are feasible."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import as_file, files
from pathlib import Path

from task_layer.pddl import ExecutionLimits, GroundTask, PlanExecutor, Planner, Sensor, load_task
from uav_example.managers.manager import TICK_PERIOD, ManagedMission
from uav_example.managers.rosa import knowledge_base_of
from uav_example.robot import UavRobot

_LIMITS = ExecutionLimits(replans=10_000)
"""Every sample that is found is reason for a new plan."""


@dataclass(frozen=True, slots=True)
class MissionFiles:
    """A mission's PDDL files; None: those that come with the UAV."""

    domain: Path | None = None
    problem: Path | None = None


def load_mission(given: MissionFiles) -> GroundTask:
    """Read the UAV's mission, or the one that is given.

    Raises:
        InputError: if a file cannot be read.
    """
    missions = files("uav_example.missions")
    with (
        as_file(missions.joinpath("uav_domain.pddl")) as domain,
        as_file(missions.joinpath("uav_problem.pddl")) as problem,
    ):
        return load_task(given.domain or domain, given.problem or problem, sensed=_SENSED)


def rosa_plan(mission: ManagedMission, given: MissionFiles) -> PlanExecutor:
    """The mission as a plan, carried out with the skills that the behaviour tree uses."""
    task = load_mission(given)
    sensors = {name: sensor for name, sensor in _sensors(mission.robot).items() if name in task.predicates}
    return PlanExecutor(
        Planner(task),
        knowledge_base_of(mission),
        mission.skills,
        period=TICK_PERIOD,
        sensors=sensors,
        limits=_LIMITS,
        around_tick=mission.recorder.stopwatch.running,
        on_plan=mission.recorder.on_plan,
        on_raise=mission.recorder.on_raise,
    )


_SENSED = ("area_searched", "sample_waiting", "gripper_folded", "at_base", "landed")


def _sensors(robot: UavRobot) -> dict[str, Sensor]:
    """What the aircraft sees for itself; there is one, whatever it is called."""
    world = robot.world
    return {
        "area_searched": lambda *_: robot.search.done,
        "sample_waiting": lambda *_: world.waiting is not None,
        "gripper_folded": lambda *_: world.gripper.folded,
        "at_base": lambda *_: world.aircraft.position[:2] == (0.0, 0.0),
        "landed": lambda *_: world.aircraft.landed,
    }
