"""Behaviour trees on the knowledge base, as py_trees behaviours with the semantics of BehaviorTree.CPP v4."""

from task_layer.bt.conditions import Conditions, set_conditions
from task_layer.bt.control_nodes import (
    AsyncFallback,
    AsyncSequence,
    Fallback,
    IfThenElse,
    Parallel,
    ParallelAll,
    ReactiveFallback,
    ReactiveSequence,
    Sequence,
    SequenceWithMemory,
    Switch,
    WhileDoElse,
)
from task_layer.bt.decorators import (
    Decorator,
    Delay,
    ForceFailure,
    ForceSuccess,
    Inverter,
    KeepRunningUntilFailure,
    Repeat,
    RetryUntilSuccessful,
    RunOnce,
    SubTree,
    Timeout,
)
from task_layer.bt.function_leaves import Condition, InstantAction
from task_layer.bt.is_action_feasible import IsActionFeasible
from task_layer.bt.node import Node
from task_layer.bt.outcome import SKIPPED, Outcome
from task_layer.bt.patterns import if_feasible
from task_layer.bt.rosa_action import RosaAction
from task_layer.bt.runner import TreeRunner
from task_layer.bt.skill_action import SkillAction

__all__ = [
    "SKIPPED",
    "AsyncFallback",
    "AsyncSequence",
    "Condition",
    "Conditions",
    "Decorator",
    "Delay",
    "Fallback",
    "ForceFailure",
    "ForceSuccess",
    "IfThenElse",
    "InstantAction",
    "Inverter",
    "IsActionFeasible",
    "KeepRunningUntilFailure",
    "Node",
    "Outcome",
    "Parallel",
    "ParallelAll",
    "ReactiveFallback",
    "ReactiveSequence",
    "Repeat",
    "RetryUntilSuccessful",
    "RosaAction",
    "RunOnce",
    "Sequence",
    "SequenceWithMemory",
    "SkillAction",
    "SubTree",
    "Switch",
    "Timeout",
    "TreeRunner",
    "WhileDoElse",
    "if_feasible",
    "set_conditions",
]
