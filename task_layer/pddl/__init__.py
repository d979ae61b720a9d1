"""Missions as PDDL plans on the knowledge base, replanned when feasibility changes."""

from task_layer.pddl.domain import FEASIBILITY_PREDICATE, load_task, parse_task
from task_layer.pddl.errors import PlannerFailedError
from task_layer.pddl.execution import ExecutionLimits, ExecutionStatus, PlanRecord, StepOutcome, StepRecord
from task_layer.pddl.feasibility import FeasibilityBridge
from task_layer.pddl.ground import GroundTask, Operator
from task_layer.pddl.plan import Plan, PlanStep
from task_layer.pddl.plan_executor import PlanExecutor
from task_layer.pddl.planner import Planned, Planner
from task_layer.pddl.reachability import NoPlan
from task_layer.pddl.sensing import Sensor

__all__ = [
    "FEASIBILITY_PREDICATE",
    "ExecutionLimits",
    "ExecutionStatus",
    "FeasibilityBridge",
    "GroundTask",
    "NoPlan",
    "Operator",
    "Plan",
    "PlanExecutor",
    "PlanRecord",
    "PlanStep",
    "Planned",
    "Planner",
    "PlannerFailedError",
    "Sensor",
    "StepOutcome",
    "StepRecord",
    "load_task",
    "parse_task",
]
