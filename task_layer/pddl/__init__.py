"""Missions as PDDL plans on the knowledge base, replanned when feasibility changes."""

from task_layer.pddl.execution.feasibility import FeasibilityBridge
from task_layer.pddl.execution.limits import ExecutionLimits
from task_layer.pddl.execution.plan_executor import PlanExecutor
from task_layer.pddl.execution.records import ExecutionStatus, PlanRecord, StepOutcome, StepRecord
from task_layer.pddl.execution.sensing import Sensor
from task_layer.pddl.grounding.ground_task import GroundTask, Operator
from task_layer.pddl.grounding.loading import FEASIBILITY_PREDICATE, load_task, parse_task
from task_layer.pddl.grounding.reachability import NoPlan
from task_layer.pddl.planning.errors import PlannerFailedError
from task_layer.pddl.planning.plan import Plan, PlanStep
from task_layer.pddl.planning.planner import Planner, PlannerAnswer

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
    "Planner",
    "PlannerAnswer",
    "PlannerFailedError",
    "Sensor",
    "StepOutcome",
    "StepRecord",
    "load_task",
    "parse_task",
]
