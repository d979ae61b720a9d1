"""The paper's search as printed (algorithms 1 and 2): breadth-first, backwards, branch and bound on the cost of the
tree.

It is here as the baseline. It shares common subtrees only after the search, so that what it minimises is not what the
plan costs, and it exhausts the tree, so that it finds nothing in time where libraries are large.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from rosa_streams.planning.problem import Problem


@dataclass(eq=False, slots=True)
class _Slot:
    """An input of a node (or a target under the root); ports with the same tag are one slot that wants several."""

    node: _Node
    need: int
    count: int = 1
    options: list[_Node] = field(default_factory=list)
    best: float = math.inf

    def chosen(self) -> list[_Node]:
        """The best options, as many as are wanted."""
        return sorted((option for option in self.options if option.best < math.inf), key=lambda each: each.best)[
            : self.count
        ]


@dataclass(eq=False, slots=True)
class _Node:
    """A candidate at a slot; the root has no option."""

    option: int | None
    slot: _Slot | None
    cost: float
    forward: float
    slots: list[_Slot] = field(default_factory=list)
    best: float = math.inf


@dataclass(frozen=True, slots=True)
class Outcome:
    """What the search found.

    Attributes:
        chosen: the options of the best tree, common subtrees merged; None if no tree was complete.
        exhausted: whether the whole space was searched.
        nodes: how many were made.
    """

    chosen: frozenset[int] | None
    exhausted: bool
    nodes: int


def paper_search(
    problem: Problem,
    *,
    timeout: float = 10.0,
    most_nodes: int = 2_000_000,
    now: Callable[[], float] = time.perf_counter,
) -> Outcome:
    """EXPLORE and EXPAND.

    Args:
        problem: what is planned.
        timeout: in seconds of ``now``.
        most_nodes: the search also ends when the tree has so many nodes, which bounds its memory.
        now: where the time comes from.
    """
    deadline = now() + timeout
    root = _Node(None, None, 0.0, 0.0)
    root.slots = [_Slot(root, goal) for goal in problem.goals]
    queue = deque([root])
    nodes = 1
    while queue and nodes < most_nodes and now() < deadline:
        nodes += _expand(queue.popleft(), problem, queue)
    chosen = _merged(root) if all(slot.best < math.inf for slot in root.slots) else None
    return Outcome(chosen, not queue, nodes)


def _expand(node: _Node, problem: Problem, queue: deque[_Node]) -> int:
    made = 0
    for slot in node.slots:
        for number in problem.providers[slot.need]:
            option = problem.options[number]
            forward = node.forward + option.cost
            if forward >= _best_of_chain(slot, forward):
                continue
            candidate = _Node(number, slot, option.cost, forward)
            candidate.slots = [_Slot(candidate, need, count) for need, count in option.needs]
            slot.options.append(candidate)
            made += 1
            if candidate.slots:
                queue.append(candidate)
            else:
                candidate.best = option.cost
                _propagate(slot)
    return made


def _best_of_chain(slot: _Slot, forward: float) -> float:
    """The lowest bound along the way to the root: beyond it, the candidate improves no known solution."""
    best = math.inf
    at: _Slot | None = slot
    while at is not None:
        best = min(best, at.node.forward + at.best)
        if forward >= best:
            break
        at = at.node.slot
    return best


def _propagate(slot: _Slot) -> None:
    at: _Slot | None = slot
    while at is not None:
        chosen = at.chosen()
        best = sum(option.best for option in chosen) if len(chosen) == at.count else math.inf
        if best >= at.best:
            return
        at.best = best
        node = at.node
        total = node.cost + sum(each.best for each in node.slots)
        if total >= node.best:
            return
        node.best = total
        at = node.slot


def _merged(root: _Node) -> frozenset[int]:
    """The options of the best tree, breadth-first; a subtree whose root is indexed already is that one."""
    indexed: set[int] = set()
    queue = deque([root])
    while queue:
        for slot in queue.popleft().slots:
            for option in slot.chosen():
                if option.option is not None and option.option not in indexed:
                    indexed.add(option.option)
                    queue.append(option)
    return frozenset(indexed)
