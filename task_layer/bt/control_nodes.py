"""Control nodes of BehaviorTree.CPP v4 that py_trees lacks or does otherwise, as py_trees composites.

Sequence, ReactiveSequence, Fallback and ReactiveFallback behave as the stock composites do, so their names here only
say which of those is meant.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite


def reactive_sequence(name: str, children: Sequence[Behaviour]) -> py_trees.composites.Sequence:
    """All children in turn, from the first at every tick: guards are checked again and again."""
    return py_trees.composites.Sequence(name, memory=False, children=list(children))


def fallback(name: str, children: Sequence[Behaviour]) -> py_trees.composites.Selector:
    """The first child that does not fail; a running child is gone on with."""
    return py_trees.composites.Selector(name, memory=True, children=list(children))


def _nothing() -> None:
    """The wake of a tree that nobody runs."""


class SequenceWithMemory(Composite):
    """A sequence that never does again what has succeeded.

    When a child fails, or the sequence is halted, it goes on from that child the next time; only when all have
    succeeded does it start anew. As in BehaviorTree.CPP, a child that succeeds on its first tick makes the sequence
    yield (RUNNING) before the next one, so that a long chain of instant children does not hold up a tick. A runner
    that passes ``wake`` to ``setup`` is asked to tick again at once.
    """

    def __init__(self, name: str, children: Sequence[Behaviour] | None = None) -> None:
        super().__init__(name, list(children) if children is not None else None)
        self._index = 0
        self._wake: Callable[[], None] = _nothing

    def setup(self, **kwargs: Any) -> None:
        """Take the runner's ``wake``, if it has one."""
        self._wake = kwargs.get("wake", _nothing)

    def tick(self) -> Iterator[Behaviour]:
        """Go on with the child that is due."""
        if self.status != Status.RUNNING:
            self._reset_children()
            self.initialise()
        while self._index < len(self.children):
            child = self.current_child = self.children[self._index]
            was_idle = child.status != Status.RUNNING
            yield from child.tick()
            if child.status == Status.RUNNING:
                self.status = Status.RUNNING
                yield self
                return
            if child.status != Status.SUCCESS:
                self.stop(Status.FAILURE)
                yield self
                return
            self._index += 1
            if was_idle and self._index < len(self.children):
                self.status = Status.RUNNING
                self._wake()
                yield self
                return
        self._index = 0
        self.stop(Status.SUCCESS)
        yield self

    def _reset_children(self) -> None:
        """What succeeded before stays visible; the children that are still to come start afresh."""
        for child in self.children[self._index :]:
            if child.status != Status.INVALID:
                child.stop(Status.INVALID)
