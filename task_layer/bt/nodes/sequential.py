"""The sequences and fallbacks of BehaviorTree.CPP v4, as py_trees composites.

Sequence and Fallback behave as py_trees' composites do with ``memory=True``, ReactiveSequence and ReactiveFallback as
with ``memory=False``; py_trees has none that behave as the others do.
"""

from __future__ import annotations

from collections.abc import Sequence as Children

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.node import Flow, Node
from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS
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
    _child_begun = -1

    def flow(self) -> Flow:
        children, continue_on = self.children, self._continue_on
        if self.status is IDLE:
            self._skipped = 0
        self.status = RUNNING
        while self._index < len(children):
            child = children[self._index]
            was_idle = child.status is IDLE
            if was_idle and self._yields_between:
                self._child_begun = self.tick_context.tick_number()
            outcome = yield child
            if outcome is continue_on:
                self._index += 1
                if self._yields_between and self._index < len(children) and (was_idle or self._began_in_this_tick()):
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

    def _began_in_this_tick(self) -> bool:
        """Whether the child was also first ticked in this tick, before its request was answered."""
        return self._child_begun == self.tick_context.tick_number()

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


class TryCatch(Node, composites.Composite):
    """Ticks all children but the last as a :class:`Sequence`; if one fails, the last one cleans up.

    SUCCESS when they all succeed. When one has failed, the last child is ticked until it has ended, and the outcome is
    FAILURE whatever it comes to.

    Args:
        name: the node's name in the tree.
        children: two or more: what is tried, in order, and what cleans up.
        catch_on_halt: whether the last child is ticked once also when the node is halted while it tries.

    Raises:
        ValueError: when it is ticked, if there are fewer children.
    """

    def __init__(
        self, name: str, children: Children[Behaviour] | None = None, catch_on_halt: Parameter[bool] = False
    ) -> None:
        super().__init__(name, children)
        self.catch_on_halt = catch_on_halt
        self._index = self._skipped = 0
        self._catches = False

    def flow(self) -> Flow:
        """Go on with what is tried, or clean up."""
        if len(self.children) < 2:
            raise ValueError(f"'{self.name}' must have two children or more, not {len(self.children)}")
        if self.status is IDLE:
            self._skipped, self._catches = 0, False
        self.status = RUNNING
        *tried, cleaner = self.children
        while not self._catches and self._index < len(tried):
            outcome = yield tried[self._index]
            if outcome is RUNNING:
                return outcome
            if outcome is FAILURE:
                self.halt_children()
                self._catches = True
            else:
                self._index += 1
                self._skipped += outcome is SKIPPED
        if self._catches:
            outcome = yield cleaner
            if outcome is RUNNING:
                return outcome
            self._start_afresh()
            return FAILURE
        all_skipped = self._skipped == len(tried)
        self._start_afresh()
        return SKIPPED if all_skipped else SUCCESS

    def reset(self) -> None:
        """Start from the first child; clean up if the node is halted while it tries, and that is wanted."""
        is_trying = self.status is RUNNING and not self._catches and len(self.children) > 1
        self._index = self._skipped = 0
        self._catches = False
        if is_trying and value_of(self.catch_on_halt):
            self.tick_now(self.children[-1])
            self.halt_child(self.children[-1])

    def _start_afresh(self) -> None:
        self.halt_children()
        self._index = self._skipped = 0
        self._catches = False
