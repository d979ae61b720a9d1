"""ROSA with a mission in PDDL: the planner chooses the actions, the knowledge base says which are feasible."""

from __future__ import annotations

from collections.abc import Callable, Collection

from rosa_core.formats.text_source import read_text
from rosa_simulation.mission import TICK_PERIOD, Mission
from rosa_simulation.scenario import MissionFiles
from task_layer.pddl import ExecutionLimits, GroundTask, PlanExecutor, Planner, parse_task


def load_mission_task(
    files: MissionFiles, sensed: Collection[str], make_problem: Callable[[], str] | None = None
) -> GroundTask:
    """Read a mission in PDDL.

    Args:
        files: of which the domain and the problem are read.
        sensed: the predicates that the robot senses, if the domain has them.
        make_problem: makes the problem where there is no file of it.

    Raises:
        InputError: if a file cannot be read or is no mission.
    """
    if files.domain is None or (files.problem is None and make_problem is None):
        raise ValueError("this scenario has no mission in PDDL")
    if files.problem is not None:
        problem, problem_file = read_text(files.problem), str(files.problem)
    else:
        problem, problem_file = make_problem() if make_problem else "", "the problem that is made for this mission"
    domain = read_text(files.domain)
    return parse_task(domain, problem, sensed=sensed, domain_file=str(files.domain), problem_file=problem_file)


def rosa_pddl_manager(mission: Mission) -> PlanExecutor:
    """The mission as a plan, carried out with the skills that the behaviour tree uses."""
    kb = mission.knowledge_base()
    parts = mission.task_parts(kb)
    task = load_mission_task(mission.simulation.files, tuple(parts.sensors), mission.make_problem)
    skills = {**parts.skills, **parts.own_skills} if parts.plan_skills is None else parts.plan_skills
    return PlanExecutor(
        Planner(task),
        kb,
        skills,
        period=TICK_PERIOD,
        sensors={name: sensor for name, sensor in parts.sensors.items() if name in task.predicates},
        limits=mission.limits or ExecutionLimits(),
        around_tick=mission.stopwatch.running,
        on_plan=mission.recorder.on_plan,
        on_raise=mission.recorder.on_raise,
    )
