"""Behaviour trees on the knowledge base, as py_trees behaviours."""

from task_layer.bt.control_nodes import SequenceWithMemory, fallback, reactive_sequence
from task_layer.bt.decorators import RetryUntilSuccessful
from task_layer.bt.function_leaves import Condition, InstantAction
from task_layer.bt.is_action_feasible import IsActionFeasible
from task_layer.bt.rosa_action import RosaAction
from task_layer.bt.runner import TreeRunner
from task_layer.bt.skill_action import SkillAction

__all__ = [
    "Condition",
    "InstantAction",
    "IsActionFeasible",
    "RetryUntilSuccessful",
    "RosaAction",
    "SequenceWithMemory",
    "SkillAction",
    "TreeRunner",
    "fallback",
    "reactive_sequence",
]
