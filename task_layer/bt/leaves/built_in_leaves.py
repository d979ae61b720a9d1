"""The leaves of BehaviorTree.CPP v4 that need neither a blackboard nor a knowledge base."""

from __future__ import annotations

from py_trees.common import Status

from task_layer.bt.engine.failing import Leaf
from task_layer.bt.engine.outcome import FAILURE, RUNNING, SUCCESS
from task_layer.bt.ports.parameter import Parameter, value_of


class AlwaysSuccess(Leaf):
    """SUCCESS at every tick.

    Args:
        name: the behaviour's name in the tree.
    """

    def update(self) -> Status:
        """Succeed."""
        return SUCCESS


class AlwaysFailure(Leaf):
    """FAILURE at every tick.

    Args:
        name: the behaviour's name in the tree.
    """

    def update(self) -> Status:
        """Fail."""
        return FAILURE


class Sleep(Leaf):
    """RUNNING until a time has passed, then SUCCESS.

    Args:
        name: the behaviour's name in the tree.
        msec: how long, in ms of the tree's clock.
    """

    def __init__(self, name: str, msec: Parameter[int]) -> None:
        super().__init__(name)
        self.msec = msec
        self._until = 0.0

    def initialise(self) -> None:
        """Compute the time of the end; py_trees calls this.

        Raises:
            ValueError: if it is negative.
        """
        msec = value_of(self.msec)
        if msec < 0:
            raise ValueError(f"{msec} ms: a time cannot be negative")
        self._until = self.tick_context.clock.now() + msec / 1000.0
        self.tick_context.wake_at(self._until)

    def update(self) -> Status:
        """Compare with the clock."""
        return RUNNING if self.tick_context.clock.now() < self._until else SUCCESS
