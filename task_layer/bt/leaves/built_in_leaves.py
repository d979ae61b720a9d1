"""The leaves of BehaviorTree.CPP v4 that need neither a blackboard nor a knowledge base."""

from __future__ import annotations

from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.outcome import FAILURE, RUNNING, SUCCESS
from task_layer.bt.engine.tick_context import NO_RUNNER, TickContext
from task_layer.bt.ports.parameter import Parameter, value_of


class AlwaysSuccess(Behaviour):
    """SUCCESS at every tick.

    Args:
        name: the behaviour's name in the tree.
    """

    def update(self) -> Status:
        """Succeed."""
        return SUCCESS


class AlwaysFailure(Behaviour):
    """FAILURE at every tick.

    Args:
        name: the behaviour's name in the tree.
    """

    def update(self) -> Status:
        """Fail."""
        return FAILURE


class Sleep(Behaviour):
    """RUNNING until a time has passed, then SUCCESS.

    Args:
        name: the behaviour's name in the tree.
        msec: how long, in ms of the tree's clock.
    """

    def __init__(self, name: str, msec: Parameter[int]) -> None:
        super().__init__(name)
        self.msec = msec
        self._tick_context = NO_RUNNER
        self._until = 0.0

    def setup(self, **kwargs: Any) -> None:
        """Keep the clock, and the way to ask for a tick."""
        self._tick_context = TickContext.of(kwargs)

    def initialise(self) -> None:
        """Compute the time of the end; py_trees calls this."""
        self._until = self._tick_context.clock.now() + value_of(self.msec) / 1000.0
        self._tick_context.wake_at(self._until)

    def update(self) -> Status:
        """Compare with the clock."""
        return RUNNING if self._tick_context.clock.now() < self._until else SUCCESS
