"""The loop over a queue of BehaviorTree.CPP v4, as a py_trees decorator."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from py_trees.behaviour import Behaviour

from task_layer.bt.engine.node import Flow
from task_layer.bt.engine.outcome import FAILURE, IDLE, OUTCOMES_BY_NAME, RUNNING, SUCCESS, Outcome
from task_layer.bt.nodes.decorators import Decorator
from task_layer.bt.ports.conversion import converted, parse
from task_layer.bt.ports.parameter import Parameter, value_of


class Loop(Decorator):
    """Ticks its child once for each item of a queue: RUNNING after an item, ``if_empty`` when there is none left.

    FAILURE as soon as the child fails. The items of a ``collections.deque`` are removed from it, so that another node
    can add some meanwhile; a list or a text such as ``"1;2;3"`` is copied whenever the loop begins.

    Args:
        name: the node's name in the tree.
        child: the child.
        queue: the items.
        set_value: called with each item before the child is ticked.
        item: the type of the items.
        if_empty: the name of the outcome when the queue is empty: SUCCESS, FAILURE, SKIPPED or RUNNING.
    """

    def __init__(
        self,
        name: str,
        child: Behaviour,
        queue: Parameter[Any],
        set_value: Callable[[Any], None],
        item: type = object,
        if_empty: Parameter[str] = "SUCCESS",
    ) -> None:
        super().__init__(name, child)
        self.queue = queue
        self.item = item
        self.if_empty = if_empty
        self._set_value = set_value
        self._items: deque[Any] | None = None

    def flow(self) -> Flow:
        """Go on with the child, or take the next item."""
        child = self.decorated
        if self.status is IDLE:
            self._items = None
        if child.status is not RUNNING:
            items = self._queue()
            if not items:
                return self._outcome_if_empty()
            self._set_value(converted(items.popleft(), self.item))
        self.status = RUNNING
        outcome = yield child
        if outcome is SUCCESS or outcome is FAILURE:
            self.halt_child(child)
        return FAILURE if outcome is FAILURE else RUNNING

    def reset(self) -> None:
        """Take the queue anew."""
        self._items = None

    def _queue(self) -> deque[Any]:
        value = value_of(self.queue)
        if isinstance(value, deque):
            return value
        if self._items is None:
            if isinstance(value, str):
                value = parse(value, list[self.item])  # type: ignore[name-defined]
            if not isinstance(value, list | tuple):
                raise TypeError(f"the queue must be a list, a deque or a text, not a {type(value).__name__}")
            self._items = deque(value)
        return self._items

    def _outcome_if_empty(self) -> Outcome:
        name: str = value_of(self.if_empty)
        if name not in OUTCOMES_BY_NAME:
            raise ValueError(f"if_empty: {name!r} is not one of {', '.join(OUTCOMES_BY_NAME)}")
        return OUTCOMES_BY_NAME[name]
