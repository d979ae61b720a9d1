"""What all parts of an execution share."""

from __future__ import annotations

from dataclasses import dataclass

from rosa_core import Clock, KnowledgeBase
from task_layer.pddl.execution.belief import Belief
from task_layer.pddl.execution.feasibility import FeasibilityBridge
from task_layer.pddl.execution.limits import ExecutionLimits, Failures
from task_layer.pddl.execution.records import ExecutionLog
from task_layer.pddl.grounding.ground_task import GroundTask


@dataclass(frozen=True, slots=True)
class ExecutionContext:
    """What all parts of an execution share.

    Attributes:
        task: what is planned.
        kb: the knowledge base.
        clock: where the time comes from.
        limits: when to give up.
        bridge: knows what is feasible.
        belief: knows what holds.
        failures: knows what is not to be tried.
        log: has the plans and what became of the steps.
    """

    task: GroundTask
    kb: KnowledgeBase
    clock: Clock
    limits: ExecutionLimits
    bridge: FeasibilityBridge
    belief: Belief
    failures: Failures
    log: ExecutionLog
