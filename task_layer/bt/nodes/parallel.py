"""The parallel nodes of BehaviorTree.CPP v4, as py_trees composites."""

from __future__ import annotations

from collections.abc import Sequence as Children

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from task_layer.bt.engine.node import Flow, Node
from task_layer.bt.engine.outcome import FAILURE, RUNNING, SKIPPED, SUCCESS, Outcome
from task_layer.bt.ports.parameter import Parameter, value_of


class _Concurrent(Node, composites.Parallel):
    """Ticks all its children that have not ended."""

    def __init__(self, name: str, children: Children[Behaviour] | None = None) -> None:
        policy = ParallelPolicy.SuccessOnAll(synchronise=False)
        composites.Parallel.__init__(self, name, policy=policy, children=children)
        self._ended: set[int] = set()
        self._successes = 0
        self._failures = 0

    def reset(self) -> None:
        """Count from zero."""
        self._ended.clear()
        self._successes = self._failures = 0

    def _count(self, index: int, outcome: Outcome) -> None:
        if outcome is SUCCESS:
            self._ended.add(index)
            self._successes += 1
        elif outcome is FAILURE:
            self._ended.add(index)
            self._failures += 1

    def _end(self, status: Status) -> Status:
        self.reset()
        self.halt_children()
        return status

    def _threshold(self, parameter: str, count: int) -> int:
        """The number of children that a parameter stands for: -1 is all of them, -2 all but one, and so on."""
        threshold = count if count >= 0 else max(len(self.children) + count + 1, 0)
        if threshold > len(self.children):
            raise ValueError(f"{parameter} is {count}, but '{self.name}' has {len(self.children)} children")
        return threshold


class Parallel(_Concurrent):
    """Ticks all children in each tick until successes_needed have succeeded or failed, and then halts the others.

    Args:
        name: the node's name in the tree.
        children: the children.
        success_count: how many must succeed for SUCCESS; -1 for all, -2 for all but one, and so on.
        failure_count: how many must fail for FAILURE, which also follows when too few can still succeed; negative
            numbers as above.

    Raises:
        ValueError: when it is ticked, if a number is larger than that of its children.
    """

    def __init__(
        self,
        name: str,
        children: Children[Behaviour] | None = None,
        success_count: Parameter[int] = -1,
        failure_count: Parameter[int] = 1,
    ) -> None:
        super().__init__(name, children)
        self.success_count = success_count
        self.failure_count = failure_count

    def flow(self) -> Flow:
        """Tick every child that has not ended; stop between two children once the outcome is decided."""
        success_count = value_of(self.success_count)
        successes_needed = self._threshold("success_count", success_count)
        failures_needed = self._threshold("failure_count", value_of(self.failure_count))
        self.status = RUNNING
        skipped = 0
        for index, child in enumerate(self.children):
            if index not in self._ended:
                outcome = yield child
                self._count(index, outcome)
                skipped += outcome is SKIPPED
            passed = self._successes + (skipped if success_count < 0 else 0)
            if passed >= successes_needed:
                return self._end(SUCCESS)
            if len(self.children) - self._failures < successes_needed or self._failures == failures_needed:
                return self._end(FAILURE)
        return SKIPPED if skipped == len(self.children) else RUNNING


class ParallelAll(_Concurrent):
    """Ticks all children in each tick until all have ended.

    Args:
        name: the node's name in the tree.
        children: the children.
        max_failures: how many must fail for FAILURE; -1 for all, -2 for all but one, and so on.

    Raises:
        ValueError: when it is ticked, if the number is larger than that of its children.
    """

    def __init__(
        self, name: str, children: Children[Behaviour] | None = None, max_failures: Parameter[int] = 1
    ) -> None:
        super().__init__(name, children)
        self.max_failures = max_failures

    def flow(self) -> Flow:
        """Tick every child that has not ended."""
        failures_needed = self._threshold("max_failures", value_of(self.max_failures))
        self.status = RUNNING
        skipped = 0
        for index, child in enumerate(self.children):
            if index not in self._ended:
                outcome = yield child
                self._count(index, outcome)
                skipped += outcome is SKIPPED
        if skipped == len(self.children):
            return SKIPPED
        if skipped + len(self._ended) < len(self.children):
            return RUNNING
        return self._end(FAILURE if self._failures >= failures_needed else SUCCESS)
