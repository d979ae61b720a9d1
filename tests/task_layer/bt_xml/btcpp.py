"""The same XML under BehaviorTree.CPP itself and under the loader, side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from xml.sax.saxutils import quoteattr

import behaviortreepy
from py_trees.common import Status

from task_layer.bt import Blackboard, load_tree
from task_layer.bt.engine.outcome import SKIPPED, Outcome
from task_layer.bt.ports.blackboard import EMPTY
from task_layer.bt.ports.conversion import to_text

Written = dict[str, str | float]


@dataclass
class Trace:
    """The results of some ticks: the root's status after each, and the main blackboard after the last."""

    statuses: list[str] = field(default_factory=list)
    entries: Written = field(default_factory=dict)
    raised: str | None = None


def script(code: str) -> str:
    """A Script node."""
    return f"<Script code={quoteattr(code)}/>"


def mission(*nodes: str, subtree: str = "<AlwaysSuccess/>") -> str:
    """A file with a main tree, a sequence, and a tree S, a sequence as well."""
    return (
        '<root BTCPP_format="4" main_tree_to_execute="M">'
        f'<BehaviorTree ID="M"><Sequence>{"".join(nodes)}</Sequence></BehaviorTree>'
        f'<BehaviorTree ID="S"><Sequence>{subtree}</Sequence></BehaviorTree></root>'
    )


def with_btcpp(xml: str, ticks: int = 1, leaves: Mapping[str, Callable[[], bool]] | None = None) -> Trace:
    """Run it under BehaviorTree.CPP."""
    trace = Trace()
    factory = behaviortreepy.BehaviorTreeFactory()
    for name, holds in (leaves or {}).items():
        factory.register_simple_condition(name, _condition(holds))
    try:
        tree = factory.create_tree_from_text(xml, behaviortreepy.Blackboard.create())
        for _ in range(ticks):
            trace.statuses.append(tree.root_node().execute_tick().name)
    except RuntimeError as error:
        trace.raised = str(error)
        return trace
    blackboard = tree.root_blackboard()
    for key in blackboard.get_keys():
        with suppress(RuntimeError):  # it was declared, and never written
            trace.entries[key] = _comparable(blackboard.get_string(key))
    return trace


def with_loader(
    xml: str, folder: Path, ticks: int = 1, leaves: Mapping[str, Callable[[], bool]] | None = None
) -> Trace:
    """Run it here."""
    trace = Trace()
    path = folder / "mission.xml"
    path.write_text(xml, encoding="utf-8")
    blackboard = Blackboard()
    errors: list[Exception] = []
    root = load_tree(path, leaves or {}, blackboard=blackboard)
    for node in root.iterate():
        node.setup(on_raise=lambda _, error: errors.append(error))
    for _ in range(ticks):
        trace.statuses.append(_tick(root))
        if errors:
            trace.raised = str(errors[0])
            return trace
    for key in blackboard.names():
        entry = blackboard.entry(key)
        assert entry is not None
        if entry.value is not EMPTY:
            trace.entries[key] = _comparable(to_text(entry.value))
    return trace


def _tick(root: object) -> str:
    from task_layer.bt import Node

    assert isinstance(root, Node)
    visited = list(root.tick())
    outcome: Outcome = root.status if visited and visited[-1] is root else SKIPPED
    return "IDLE" if outcome is Status.INVALID else outcome.name


def _condition(holds: Callable[[], bool]) -> Callable[[object], object]:
    def tick(_: object) -> object:
        return behaviortreepy.NodeStatus.SUCCESS if holds() else behaviortreepy.NodeStatus.FAILURE

    return tick


def _comparable(text: str) -> str | float:
    """Numbers with decimals as such: BehaviorTree.CPP writes ``-nan``, and prints more digits than it has."""
    try:
        number = float(text)
    except ValueError:
        return text
    return "nan" if math.isnan(number) else text
