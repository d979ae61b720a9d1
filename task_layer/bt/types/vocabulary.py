"""The tags of BehaviorTree.CPP v4's built-in nodes, and the classes that stand for them here."""

from __future__ import annotations

from dataclasses import dataclass

from py_trees.behaviour import Behaviour

from task_layer.bt.leaves.built_in_leaves import AlwaysFailure, AlwaysSuccess, Sleep
from task_layer.bt.nodes import branching, decorators, manual, parallel, sequential
from task_layer.bt.ports.port import InOutPort, InputPort, OutputPort, Port
from task_layer.bt.scripting.parser import Script
from task_layer.bt.types.node_source import KINDS_BY_TAG, NodeKind

SWITCHES = range(2, 7)
"""The numbers of cases that a Switch can have in XML."""


@dataclass(frozen=True, slots=True)
class BuiltIn:
    """A built-in node.

    Attributes:
        kind: its category.
        node: its class, whose constructor takes ``name``, ``children`` or ``child``, and the ports as keywords.
        ports: the ports that it has.
        children: the smallest and the largest number of children (None: no limit).
    """

    kind: NodeKind
    node: type[Behaviour]
    ports: tuple[Port, ...] = ()
    children: tuple[int, int | None] = (0, 0)


def _control(node: type[Behaviour], *ports: Port, children: tuple[int, int | None] = (1, None)) -> BuiltIn:
    return BuiltIn(NodeKind.CONTROL, node, ports, children)


def _decorator(node: type[Behaviour], *ports: Port) -> BuiltIn:
    return BuiltIn(NodeKind.DECORATOR, node, ports, (1, 1))


BUILT_IN: dict[str, BuiltIn] = {
    "Sequence": _control(sequential.Sequence),
    "AsyncSequence": _control(sequential.AsyncSequence),
    "SequenceWithMemory": _control(sequential.SequenceWithMemory),
    "ReactiveSequence": _control(sequential.ReactiveSequence),
    "Fallback": _control(sequential.Fallback),
    "AsyncFallback": _control(sequential.AsyncFallback),
    "ReactiveFallback": _control(sequential.ReactiveFallback),
    "Parallel": _control(parallel.Parallel, InputPort("success_count", int, -1), InputPort("failure_count", int, 1)),
    "ParallelAll": _control(parallel.ParallelAll, InputPort("max_failures", int, 1)),
    "TryCatch": _control(sequential.TryCatch, InputPort("catch_on_halt", bool, False), children=(2, None)),
    "ManualSelector": _control(manual.ManualSelector, InputPort("repeat_last_selection", bool, False)),
    "IfThenElse": _control(branching.IfThenElse, children=(2, 3)),
    "WhileDoElse": _control(branching.WhileDoElse, children=(2, 3)),
    "Inverter": _decorator(decorators.Inverter),
    "ForceSuccess": _decorator(decorators.ForceSuccess),
    "ForceFailure": _decorator(decorators.ForceFailure),
    "KeepRunningUntilFailure": _decorator(decorators.KeepRunningUntilFailure),
    "RetryUntilSuccessful": _decorator(decorators.RetryUntilSuccessful, InputPort("num_attempts", int)),
    "Repeat": _decorator(decorators.Repeat, InputPort("num_cycles", int)),
    "Timeout": _decorator(decorators.Timeout, InputPort("msec", int)),
    "Delay": _decorator(decorators.Delay, InputPort("delay_msec", int)),
    "RunOnce": _decorator(decorators.RunOnce, InputPort("then_skip", bool, True)),
    "AlwaysSuccess": BuiltIn(NodeKind.ACTION, AlwaysSuccess),
    "AlwaysFailure": BuiltIn(NodeKind.ACTION, AlwaysFailure),
    "Sleep": BuiltIn(NodeKind.ACTION, Sleep, (InputPort("msec", int),)),
}

LOOPS: dict[str, type] = {"LoopInt": int, "LoopDouble": float, "LoopBool": bool, "LoopString": str}
"""The loops over a queue, and the types of its items."""


def _loop_ports(item: type) -> tuple[Port, ...]:
    queue = InOutPort("queue", description="a list, a deque or a text such as 1;2;3")
    if_empty = InputPort("if_empty", str, "SUCCESS", "the outcome when there is nothing left")
    return queue, if_empty, OutputPort("value", item)


BLACKBOARD_NODES: dict[str, tuple[NodeKind, tuple[Port, ...]]] = {
    "Script": (NodeKind.ACTION, (InputPort("code", Script),)),
    "ScriptCondition": (NodeKind.CONDITION, (InputPort("code", Script),)),
    "Precondition": (NodeKind.DECORATOR, (InputPort("if", Script), InputPort("else", str, "FAILURE"))),
    "SetBlackboard": (NodeKind.ACTION, (InputPort("value"), InputPort("output_key"))),
    "UnsetBlackboard": (NodeKind.ACTION, (InputPort("key", str),)),
    **{tag: (NodeKind.DECORATOR, _loop_ports(item)) for tag, item in LOOPS.items()},
    "WasEntryUpdated": (NodeKind.ACTION, (InputPort("entry"),)),
    "SkipUnlessUpdated": (NodeKind.DECORATOR, (InputPort("entry"),)),
    "WaitValueUpdate": (NodeKind.DECORATOR, (InputPort("entry"),)),
}
"""The nodes that run scripts, and that read and write the blackboard themselves."""

CHILD_COUNTS = {"Parallel": ("success_count", "failure_count"), "ParallelAll": ("max_failures",)}
"""Ports that hold a number of children, by the node's tag."""

REPLACED = {
    "SequenceStar": "SequenceWithMemory",
    "SubTreePlus": 'SubTree with _autoremap="true"',
    "FallbackStar": "Fallback",
    "RetryUntilSuccesful": "RetryUntilSuccessful",
    "BlackboardCheckInt": "the attribute _skipIf",
    "BlackboardCheckDouble": "the attribute _skipIf",
    "BlackboardCheckString": "the attribute _skipIf",
    "BlackboardCheckBool": "the attribute _skipIf",
}
"""Nodes of BehaviorTree.CPP v3, and what replaces them in v4."""

_LOOPS = "write <LoopInt>, <LoopDouble>, <LoopBool> or <LoopString>, or register a leaf of that name"
NOT_BUILT_IN: dict[str, str] = dict.fromkeys(("ConsumeQueue", "PopFromQueue", "QueueSize"), _LOOPS)
"""Nodes that come with BehaviorTree.CPP, but that each program must register, and what to write instead."""

TIMES = {"Timeout": "msec", "Delay": "delay_msec", "Sleep": "msec"}
"""Ports that hold a time, by the node's tag."""


def is_built_in(tag: str) -> bool:
    """Whether a tag belongs to BehaviorTree.CPP, and no leaf can be registered under it."""
    return tag in BUILT_IN or tag in BLACKBOARD_NODES or tag in KINDS_BY_TAG


def _switch_ports(cases: int) -> tuple[Port, ...]:
    return (InputPort("variable"), *(InputPort(f"case_{number}") for number in range(1, cases + 1)))


BUILT_IN.update(
    (f"Switch{cases}", _control(branching.Switch, *_switch_ports(cases), children=(cases + 1, cases + 1)))
    for cases in SWITCHES
)
