"""What runs with a mission in PDDL have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.run_record import RecordedPlan
from rosa_simulation.scenario import RunRequest

if TYPE_CHECKING:
    from task_layer.pddl import PlanRecord


def check_planning(request: RunRequest) -> None:
    """Make sure that what is asked for of plans fits together.

    Raises:
        InputError: if it does not.
    """
    if request.task_layer != "pddl":
        for option, file in (("--domain", request.domain), ("--problem", request.problem)):
            if file is not None:
                raise InputError(Problem(f"{option} is for missions in PDDL", hint="add --task-layer pddl"))
    elif request.mission is not None:
        raise InputError(Problem("--mission is for missions as behaviour trees", hint="leave --task-layer pddl out"))
    elif request.manager != "rosa":
        what = f"the manager '{request.manager}' does not know what is feasible, which plans are made of"
        raise InputError(Problem(what, hint="fly plans with --manager rosa"))


def recorded_plan(record: PlanRecord, mission_time: float) -> RecordedPlan:
    """A plan as run records have it.

    Args:
        record: the task layer's record of it.
        mission_time: when it was made, s.
    """
    return RecordedPlan(
        time_s=round(mission_time, 6),
        reason=record.reason,
        steps=record.steps,
        kept=record.kept,
        no_plan=record.no_plan,
        cached=record.cached,
        engine=record.engine,
        cost_s=record.cost_s,
    )


def why_given_up(runner: object, ended: object) -> str:
    """Why the task layer gave the mission up; empty if it did not, or does not plan."""
    from task_layer.pddl import ExecutionStatus, PlanExecutor

    return runner.feedback if isinstance(runner, PlanExecutor) and ended is ExecutionStatus.FAILURE else ""
