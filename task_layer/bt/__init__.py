"""Behaviour trees on the knowledge base, as py_trees behaviours with the semantics of BehaviorTree.CPP v4."""

from typing import TYPE_CHECKING, Any

from task_layer.bt.engine.conditions import Conditions, set_conditions
from task_layer.bt.engine.node import Node
from task_layer.bt.engine.outcome import SKIPPED, Outcome
from task_layer.bt.leaves.built_in_leaves import AlwaysFailure, AlwaysSuccess, Sleep
from task_layer.bt.leaves.function_leaf import InOut, Output
from task_layer.bt.leaves.function_leaves import Condition, InstantAction
from task_layer.bt.leaves.is_action_feasible import IsActionFeasible
from task_layer.bt.leaves.rosa_action import RosaAction
from task_layer.bt.leaves.skill_action import SkillAction
from task_layer.bt.nodes.branching import IfThenElse, Switch, WhileDoElse
from task_layer.bt.nodes.decorators import (
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
from task_layer.bt.nodes.loops import Loop
from task_layer.bt.nodes.manual import ManualSelector
from task_layer.bt.nodes.parallel import Parallel, ParallelAll
from task_layer.bt.nodes.sequential import (
    AsyncFallback,
    AsyncSequence,
    Fallback,
    ReactiveFallback,
    ReactiveSequence,
    Sequence,
    SequenceWithMemory,
    TryCatch,
)
from task_layer.bt.nodes.updates import SkipUnlessUpdated, WaitValueUpdate, WasEntryUpdated
from task_layer.bt.patterns import if_feasible
from task_layer.bt.ports.blackboard import Blackboard
from task_layer.bt.ports.bound_ports import Ports
from task_layer.bt.ports.port import InOutPort, InputPort, OutputPort, Port
from task_layer.bt.runner import TreeRunner
from task_layer.bt.tree_source import TreeSource
from task_layer.bt.types.node_source import NodeKind, NodeSource, set_source
from task_layer.bt.types.registry import Registry
from task_layer.bt.visitors import TipVisitor
from task_layer.bt.waiting import UnfeasibleAction
from task_layer.bt.xml.node_uids import node_uids
from task_layer.bt.xml.saver import save_tree, tree_xml

if TYPE_CHECKING:
    from task_layer.bt.xml.loader import TreeProject, load_tree, load_trees

__all__ = [
    "SKIPPED",
    "AlwaysFailure",
    "AlwaysSuccess",
    "AsyncFallback",
    "AsyncSequence",
    "Blackboard",
    "Condition",
    "Conditions",
    "Decorator",
    "Delay",
    "Fallback",
    "ForceFailure",
    "ForceSuccess",
    "IfThenElse",
    "InOut",
    "InOutPort",
    "InputPort",
    "InstantAction",
    "Inverter",
    "IsActionFeasible",
    "KeepRunningUntilFailure",
    "Loop",
    "ManualSelector",
    "Node",
    "NodeKind",
    "NodeSource",
    "Outcome",
    "Output",
    "OutputPort",
    "Parallel",
    "ParallelAll",
    "Port",
    "Ports",
    "ReactiveFallback",
    "ReactiveSequence",
    "Registry",
    "Repeat",
    "RetryUntilSuccessful",
    "RosaAction",
    "RunOnce",
    "Sequence",
    "SequenceWithMemory",
    "SkillAction",
    "SkipUnlessUpdated",
    "Sleep",
    "SubTree",
    "Switch",
    "Timeout",
    "TipVisitor",
    "TreeProject",
    "TreeRunner",
    "TreeSource",
    "TryCatch",
    "UnfeasibleAction",
    "WaitValueUpdate",
    "WasEntryUpdated",
    "WhileDoElse",
    "if_feasible",
    "load_tree",
    "load_trees",
    "node_uids",
    "save_tree",
    "set_conditions",
    "set_source",
    "tree_xml",
]


def __getattr__(name: str) -> Any:
    # XML parsers take longer to import than everything else here, and only those who load a file need one.
    if name in ("TreeProject", "load_tree", "load_trees"):
        from task_layer.bt.xml import loader

        return getattr(loader, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
