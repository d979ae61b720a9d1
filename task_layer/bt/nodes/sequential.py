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
