"""The control nodes of BehaviorTree.CPP v4, as py_trees composites.

The names are BehaviorTree.CPP's. Sequence and Fallback behave as py_trees' composites do with ``memory=True``,
ReactiveSequence and ReactiveFallback as with ``memory=False``; py_trees has none that behave as the others do.
"""

from __future__ import annotations

from collections.abc import Sequence as Children

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from task_layer.bt.engine.node import Flow, Node
from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Outcome
from task_layer.bt.ports.parameter import Parameter, value_of


class _Sequential(Node):
    """Ticks its children in order, and resumes at the one that is running.

    A child with the outcome ``_continue_on`` is followed by the next; one with the opposite outcome ends the node.
    """

    _continue_on: Status
    _yields_between = False
    _keeps_index = False
    _index = 0
    _skipped = 0

    def flow(self) -> Flow:
        children, continue_on = self.children, self._continue_on
        if self.status is IDLE:
            self._skipped = 0
        self.status = RUNNING
        while self._index < len(children):
            child = children[self._index]
            was_idle = child.status is IDLE
            outcome = yield child
            if outcome is continue_on:
                self._index += 1
                if self._yields_between and was_idle and self._index < len(children):
                    self.tick_context.wake()
                    return RUNNING
            elif outcome is SKIPPED:
                self._index += 1
                self._skipped += 1
            elif outcome is RUNNING:
                return outcome
            else:
                self._end_early()
                return outcome
        all_skipped = self._skipped == len(children) > 0
        self.halt_children()
        self._index = self._skipped = 0
        return SKIPPED if all_skipped else continue_on

    def reset(self) -> None:
        """Start from the first child, unless the node keeps its index."""
        if not self._keeps_index:
            self._index = self._skipped = 0

    def _end_early(self) -> None:
        """A child has ended the node: it failed in a sequence, or succeeded in a fallback."""
        self.halt_children()
        self._index = 0


class Sequence(_Sequential, composites.Sequence):
    """Ticks its children in order until one fails; resumes at the child that is running.

    SUCCESS when all children have succeeded, FAILURE when one has failed.

    Args:
        name: the node's name in the tree.
        children: the children, in order.

    >>> from py_trees.behaviours import Failure, Success
    >>> root = Sequence("root", [Success("first"), Failure("second"), Success("third")])
    >>> [node.name for node in root.tick()]
    ['first', 'second', 'root']
    >>> root.status.name
    'FAILURE'
    """

    _continue_on = SUCCESS

    def __init__(self, name: str, children: Children[Behaviour] | None = None) -> None:
        composites.Sequence.__init__(self, name, memory=True, children=children)


class AsyncSequence(Sequence):
    """A :class:`Sequence` that returns RUNNING after each child that succeeds on its first tick, and then resumes.

    Args:
        name: the node's name in the tree.
        children: the children, in order.
    """

    _yields_between = True


class SequenceWithMemory(Sequence):
    """A :class:`Sequence` that does not repeat the children that have succeeded.

    After a child failed, or the sequence was halted, the next tick resumes at that child; the sequence starts again
    from the first child only when all have succeeded. Like :class:`AsyncSequence` it returns RUNNING after a child
    that succeeded on its first tick, and asks for the next tick at once.

    Args:
        name: the node's name in the tree.
        children: the children, in order.
    """

    _yields_between = True
    _keeps_index = True

    def _end_early(self) -> None:
        for child in self.children[self._index :]:
            self.halt_child(child)


class Fallback(_Sequential, composites.Selector):
    """Ticks its children in order until one succeeds; resumes at the child that is running.

    SUCCESS when one child has succeeded, FAILURE when all have failed.

    Args:
        name: the node's name in the tree.
        children: the children, in order.

    >>> from py_trees.behaviours import Failure, Success
    >>> root = Fallback("root", [Failure("first"), Success("second"), Success("third")])
    >>> [node.name for node in root.tick()]
    ['first', 'second', 'root']
    >>> root.status.name
    'SUCCESS'
    """

    _continue_on = FAILURE

    def __init__(self, name: str, children: Children[Behaviour] | None = None) -> None:
        composites.Selector.__init__(self, name, memory=True, children=children)


class AsyncFallback(Fallback):
    """A :class:`Fallback` that returns RUNNING after each child that fails on its first tick, and then resumes.

    Args:
        name: the node's name in the tree.
        children: the children, in order.
    """

    _yields_between = True


class _Reactive(Node):
    """Ticks its children from the first one at every tick, and halts all others when one is running."""

    _continue_on: Status

    def flow(self) -> Flow:
        continue_on, all_skipped = self._continue_on, bool(self.children)
        self.status = RUNNING
        for child in self.children:
            outcome = yield child
            if outcome is continue_on:
                all_skipped = False
            elif outcome is RUNNING:
                for other in self.children:
                    if other is not child:
                        self.halt_child(other)
                return outcome
            elif outcome is not SKIPPED:
                self.halt_children()
                return outcome
        self.halt_children()
        return SKIPPED if all_skipped else continue_on


class ReactiveSequence(_Reactive, composites.Sequence):
    """A sequence that starts from its first child at every tick, so that conditions are checked while an action runs.

    FAILURE as soon as a child fails, which halts a child that was running; SUCCESS when all succeed in one tick.

    Args:
        name: the node's name in the tree.
        children: the children, in order.
    """

    _continue_on = SUCCESS

    def __init__(self, name: str, children: Children[Behaviour] | None = None) -> None:
        composites.Sequence.__init__(self, name, memory=False, children=children)


class ReactiveFallback(_Reactive, composites.Selector):
    """A fallback that starts from its first child at every tick, so that a better option interrupts a later one.

    SUCCESS as soon as a child succeeds, which halts a child that was running; FAILURE when all fail in one tick.

    Args:
        name: the node's name in the tree.
        children: the children, in order.
    """

    _continue_on = FAILURE

    def __init__(self, name: str, children: Children[Behaviour] | None = None) -> None:
        composites.Selector.__init__(self, name, memory=False, children=children)


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


class IfThenElse(Node, composites.Composite):
    """Ticks the second child if the first succeeds, the third if it fails; the choice holds until the branch ends.

    FAILURE if the first child fails and there is no third.

    Args:
        name: the node's name in the tree.
        children: two or three: the condition, the branch if it succeeds, the branch if it fails.

    Raises:
        ValueError: when it is ticked, if there are fewer or more children.
    """

    _branch = 0

    def flow(self) -> Flow:
        """Tick the condition unless a branch is running, then the branch."""
        _check_branches(self)
        self.status = RUNNING
        if self._branch == 0:
            outcome = yield self.children[0]
            if outcome is SUCCESS:
                self._branch = 1
            elif outcome is FAILURE and len(self.children) == 3:
                self._branch = 2
            else:
                return outcome
        outcome = yield self.children[self._branch]
        if outcome is not RUNNING:
            self.halt_children()
            self._branch = 0
        return outcome

    def reset(self) -> None:
        """Discard the choice."""
        self._branch = 0


class WhileDoElse(Node, composites.Composite):
    """Ticks the second child while the first succeeds, the third while it fails; the first is ticked at every tick.

    Args:
        name: the node's name in the tree.
        children: two or three: the condition, the branch while it succeeds, the branch while it fails.

    Raises:
        ValueError: when it is ticked, if there are fewer or more children.
    """

    def flow(self) -> Flow:
        """Tick the condition, halt the branch that is no longer chosen, and tick the other."""
        _check_branches(self)
        self.status = RUNNING
        condition, *branches = self.children
        outcome = yield condition
        if outcome is RUNNING or outcome is SKIPPED:
            return outcome
        chosen = 0 if outcome is SUCCESS else 1
        if len(branches) == 2:
            self.halt_child(branches[1 - chosen])
        if chosen < len(branches):
            outcome = yield branches[chosen]
        if outcome is not RUNNING:
            self.halt_children()
        return outcome


class Switch(Node, composites.Composite):
    """Ticks the child whose case equals the variable's value, and the last child if no case does.

    Args:
        name: the node's name in the tree.
        children: one for each case, and a last one for any other value.
        variable: the value that is compared; None for no value.
        cases: the values to compare with, in order; texts of numbers are compared as numbers.

    Raises:
        ValueError: when it is ticked, if there is not one child more than there are cases.
    """

    def __init__(
        self,
        name: str,
        children: Children[Behaviour] | None = None,
        *,
        variable: Parameter[object],
        cases: Children[Parameter[object]],
    ) -> None:
        super().__init__(name, children)
        self.variable = variable
        self.cases = tuple(cases)
        self._running: Behaviour | None = None

    def flow(self) -> Flow:
        """Choose a child, halt the one chosen before if it is another, and tick."""
        if len(self.children) != len(self.cases) + 1:
            raise ValueError(
                f"'{self.name}' has {len(self.children)} children for {len(self.cases)} cases and the default"
            )
        chosen = self.children[self._matching()]
        if self._running is not None and self._running is not chosen:
            self.halt_child(self._running)
        outcome = yield chosen
        self._running = chosen if outcome is RUNNING else None
        if outcome is SUCCESS or outcome is FAILURE:
            self.halt_children()
        return outcome

    def reset(self) -> None:
        """Discard the choice."""
        self._running = None

    def _matching(self) -> int:
        value = value_of(self.variable)
        if value is not None:
            for index, case in enumerate(self.cases):
                if _same(value, value_of(case)):
                    return index
        return len(self.cases)


def _check_branches(node: Node) -> None:
    if len(node.children) not in (2, 3):
        raise ValueError(f"'{node.name}' must have two or three children, not {len(node.children)}")


def _same(one: object, other: object) -> bool:
    if str(one) == str(other):
        return True
    try:
        return float(str(one)) == float(str(other))
    except ValueError:
        return False
