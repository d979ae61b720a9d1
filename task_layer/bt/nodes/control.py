"""The control nodes of BehaviorTree.CPP v4, as py_trees composites.

The names are BehaviorTree.CPP's. Sequence, ReactiveSequence, Fallback and ReactiveFallback do what the stock py_trees
composites do with ``memory=True`` or ``False``; the others have no like there.
"""

from __future__ import annotations

from collections.abc import Sequence as Several

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from task_layer.bt.engine.node import Flow, Node
from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Outcome
from task_layer.bt.ports.parameter import Parameter, value_of


class _Sequential(Node):
    """Ticks its children one after the other, and goes on with the one that runs.

    Each child is passed over when it comes to ``_goes_on``, and decides when it comes to the opposite.
    """

    _goes_on: Status
    _yields = False
    _keeps_index = False
    _index = 0
    _skipped = 0

    def flow(self) -> Flow:
        children, goes_on = self.children, self._goes_on
        if self.status is IDLE:
            self._skipped = 0
        self.status = RUNNING
        while self._index < len(children):
            child = children[self._index]
            was_idle = child.status is IDLE
            outcome = yield child
            if outcome is goes_on:
                self._index += 1
                if self._yields and was_idle and self._index < len(children):
                    self.tick_context.wake()
                    return RUNNING
            elif outcome is SKIPPED:
                self._index += 1
                self._skipped += 1
            elif outcome is RUNNING:
                return outcome
            else:
                self._decided()
                return outcome
        all_skipped = self._skipped == len(children) > 0
        self.halt_children()
        self._index = self._skipped = 0
        return SKIPPED if all_skipped else goes_on

    def reset(self) -> None:
        """Begin with the first child, unless this is a node that remembers."""
        if not self._keeps_index:
            self._index = self._skipped = 0

    def _decided(self) -> None:
        """A child has failed a sequence, or made a fallback succeed."""
        self.halt_children()
        self._index = 0


class Sequence(_Sequential, composites.Sequence):
    """All children in turn; a child that fails ends it, a child that runs is gone on with.

    Args:
        name: the node's name in the tree.
        children: what it ticks.
    """

    _goes_on = SUCCESS

    def __init__(self, name: str, children: Several[Behaviour] | None = None) -> None:
        composites.Sequence.__init__(self, name, memory=True, children=children)


class AsyncSequence(Sequence):
    """A :class:`Sequence` that yields (RUNNING) after a child that succeeded on its first tick."""

    _yields = True


class SequenceWithMemory(Sequence):
    """A sequence that never does again what has succeeded.

    When a child fails, or the sequence is halted, it goes on from that child the next time; only when all have
    succeeded does it start anew. Like :class:`AsyncSequence` it yields after a child that succeeded on its first
    tick, so that a long chain of instant children does not hold up a tick, and asks to be ticked again at once.
    """

    _yields = True
    _keeps_index = True

    def _decided(self) -> None:
        for child in self.children[self._index :]:
            self.halt_child(child)


class Fallback(_Sequential, composites.Selector):
    """The first child that does not fail; a child that runs is gone on with.

    Args:
        name: the node's name in the tree.
        children: what it ticks.
    """

    _goes_on = FAILURE

    def __init__(self, name: str, children: Several[Behaviour] | None = None) -> None:
        composites.Selector.__init__(self, name, memory=True, children=children)


class AsyncFallback(Fallback):
    """A :class:`Fallback` that yields (RUNNING) after a child that failed on its first tick."""

    _yields = True


class _Reactive(Node):
    """Ticks its children from the first at every tick, and halts all others when one runs."""

    _goes_on: Status

    def flow(self) -> Flow:
        goes_on, all_skipped = self._goes_on, bool(self.children)
        self.status = RUNNING
        for child in self.children:
            outcome = yield child
            if outcome is goes_on:
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
        return SKIPPED if all_skipped else goes_on


class ReactiveSequence(_Reactive, composites.Sequence):
    """All children in turn, from the first at every tick: guards are checked again while an action runs.

    Args:
        name: the node's name in the tree.
        children: what it ticks.
    """

    _goes_on = SUCCESS

    def __init__(self, name: str, children: Several[Behaviour] | None = None) -> None:
        composites.Sequence.__init__(self, name, memory=False, children=children)


class ReactiveFallback(_Reactive, composites.Selector):
    """The first child that does not fail, looked for from the first at every tick.

    Args:
        name: the node's name in the tree.
        children: what it ticks.
    """

    _goes_on = FAILURE

    def __init__(self, name: str, children: Several[Behaviour] | None = None) -> None:
        composites.Selector.__init__(self, name, memory=False, children=children)


class _Concurrent(Node, composites.Parallel):
    """Ticks all its children that have not ended yet."""

    def __init__(self, name: str, children: Several[Behaviour] | None = None) -> None:
        policy = ParallelPolicy.SuccessOnAll(synchronise=False)
        composites.Parallel.__init__(self, name, policy=policy, children=children)
        self._ended: set[int] = set()
        self._successes = 0
        self._failures = 0

    def reset(self) -> None:
        """Count from the start."""
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
        """A number of children; -1 stands for all, -2 for all but one, and so on."""
        threshold = count if count >= 0 else max(len(self.children) + count + 1, 0)
        if threshold > len(self.children):
            raise ValueError(f"{parameter} is {count}, but '{self.name}' has {len(self.children)} children")
        return threshold


class Parallel(_Concurrent):
    """All children at once, until enough have succeeded or failed; the rest is then halted.

    Args:
        name: the node's name in the tree.
        children: what it ticks.
        success_count: succeeds when as many have succeeded; -1 for all, -2 for all but one, and so on.
        failure_count: fails when as many have failed, or too few can still succeed; negative as above.
    """

    def __init__(
        self,
        name: str,
        children: Several[Behaviour] | None = None,
        success_count: Parameter[int] = -1,
        failure_count: Parameter[int] = 1,
    ) -> None:
        super().__init__(name, children)
        self.success_count = success_count
        self.failure_count = failure_count

    def flow(self) -> Flow:
        """Tick every child that has not ended; stop in the middle once it is decided."""
        success_count = value_of(self.success_count)
        enough = self._threshold("success_count", success_count)
        too_many = self._threshold("failure_count", value_of(self.failure_count))
        self.status = RUNNING
        skipped = 0
        for index, child in enumerate(self.children):
            if index not in self._ended:
                outcome = yield child
                self._count(index, outcome)
                skipped += outcome is SKIPPED
            passed = self._successes + (skipped if success_count < 0 else 0)
            if passed >= enough:
                return self._end(SUCCESS)
            if len(self.children) - self._failures < enough or self._failures == too_many:
                return self._end(FAILURE)
        return SKIPPED if skipped == len(self.children) else RUNNING


class ParallelAll(_Concurrent):
    """All children at once, until all have ended.

    Args:
        name: the node's name in the tree.
        children: what it ticks.
        max_failures: fails when as many have failed; -1 for all, -2 for all but one, and so on.
    """

    def __init__(self, name: str, children: Several[Behaviour] | None = None, max_failures: Parameter[int] = 1) -> None:
        super().__init__(name, children)
        self.max_failures = max_failures

    def flow(self) -> Flow:
        """Tick every child that has not ended."""
        too_many = self._threshold("max_failures", value_of(self.max_failures))
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
        return self._end(FAILURE if self._failures >= too_many else SUCCESS)


class IfThenElse(Node, composites.Composite):
    """Decides once which branch to take: the second child if the first succeeds, else the third, if there is one.

    Args:
        name: the node's name in the tree.
        children: two or three: the condition, what then, and what else.
    """

    _branch = 0

    def flow(self) -> Flow:
        """Ask the condition unless a branch runs, then go on with the branch."""
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
        """Decide anew."""
        self._branch = 0


class WhileDoElse(Node, composites.Composite):
    """Asks its first child at every tick: the second child runs while it succeeds, the third while it fails.

    Args:
        name: the node's name in the tree.
        children: two or three: the condition, what to do, and what else.
    """

    def flow(self) -> Flow:
        """Ask the condition, halt the branch that is no longer due, and tick the other."""
        _check_branches(self)
        self.status = RUNNING
        condition, *branches = self.children
        outcome = yield condition
        if outcome is RUNNING or outcome is SKIPPED:
            return outcome
        due = 0 if outcome is SUCCESS else 1
        if len(branches) == 2:
            self.halt_child(branches[1 - due])
        if due < len(branches):
            outcome = yield branches[due]
        if outcome is not RUNNING:
            self.halt_children()
        return outcome


class Switch(Node, composites.Composite):
    """Ticks the child whose case is what the variable holds, and the last child if there is none.

    Args:
        name: the node's name in the tree.
        children: one for each case, and the one for any other value.
        variable: what decides; None if there is no such thing.
        cases: the values; the first that equals the variable's counts. Numbers are compared as numbers.
    """

    def __init__(
        self,
        name: str,
        children: Several[Behaviour] | None = None,
        *,
        variable: Parameter[object],
        cases: Several[Parameter[object]],
    ) -> None:
        super().__init__(name, children)
        self.variable = variable
        self.cases = tuple(cases)
        self._running: Behaviour | None = None

    def flow(self) -> Flow:
        """Choose, halt the child chosen before if it is another, and tick."""
        if len(self.children) != len(self.cases) + 1:
            raise ValueError(
                f"'{self.name}' has {len(self.children)} children for {len(self.cases)} cases and the rest"
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
        """No child was chosen before."""
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
