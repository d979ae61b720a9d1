"""What the task layer leaves in a run record: plans, why it has given up, and what it was waiting for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosa_core import InputError
from rosa_core.errors import Problem
from rosa_simulation.run_record import AwaitedAction, RecordedPlan
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
    """Why the task layer gave the mission up; empty if it did not, or does not plan.

    Args:
        runner: of the task layer, whichever it is.
        ended: the status with which it ended.
    """
    from task_layer.pddl import ExecutionStatus, PlanExecutor

    return runner.feedback if isinstance(runner, PlanExecutor) and ended is ExecutionStatus.FAILURE else ""


def awaited_actions(runner: object) -> tuple[AwaitedAction, ...]:
    """The actions that a tree was waiting for when its mission ended, as run records have them."""
    from task_layer.bt import TreeRunner

    if not isinstance(runner, TreeRunner):
        return ()
    return tuple(AwaitedAction(found.action, found.reason, found.remedies) for found in runner.waiting_for)
