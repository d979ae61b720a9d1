"""ROSA with a mission in PDDL: the planner chooses the actions, the knowledge base says which are feasible."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import as_file, files
from pathlib import Path

from suave.managers.manager import TICK_PERIOD, ManagedMission
from suave.managers.rosa import knowledge_base_of
from suave.robot import SuaveRobot
from task_layer.pddl import GroundTask, PlanExecutor, Planner, PlanRecord, load_task
from task_layer.pddl.execution.sensing import Sensor


@dataclass(frozen=True, slots=True)
class MissionFiles:
    """A mission's PDDL files; None: those that come with SUAVE."""

    domain: Path | None = None
    problem: Path | None = None


def load_mission(given: MissionFiles, *, extended: bool) -> GroundTask:
    """Read the plain or the extended mission, or the one that is given."""
    missions = files("suave.missions")
    problem_file = "suave_extended_problem.pddl" if extended else "suave_problem.pddl"
    with (
        as_file(missions.joinpath("suave_domain.pddl")) as domain,
        as_file(missions.joinpath(problem_file)) as problem,
    ):
        return load_task(given.domain or domain, given.problem or problem, sensed=_SENSED)


def rosa_pddl_manager(
    mission: ManagedMission, given: MissionFiles, on_plan: Callable[[PlanRecord], None]
) -> PlanExecutor:
    """The mission as a plan, carried out with the skills that the behaviour tree uses."""
    task = load_mission(given, extended=mission.extended)
    sensors = {name: sensor for name, sensor in _sensors(mission.robot).items() if name in task.predicates}
    return PlanExecutor(
        Planner(task),
        knowledge_base_of(mission),
        mission.skills,
        period=TICK_PERIOD,
        sensors=sensors,
        around_tick=mission.stopwatch.running,
        on_plan=on_plan,
        on_raise=mission.on_raise,
    )


_SENSED = ("robot_started", "pipeline_found", "pipeline_inspected")


def _sensors(robot: SuaveRobot) -> dict[str, Sensor]:
    """What the robot sees for itself; there is one robot and one pipeline, whatever they are called."""
    return {
        "robot_started": lambda *_: robot.guided_at is not None,
        "pipeline_found": lambda *_: robot.pipeline_found,
        "pipeline_inspected": lambda *_: robot.pipeline_inspected,
    }
