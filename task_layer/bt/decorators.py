"""Decorators of BehaviorTree.CPP v4 that py_trees lacks or does otherwise."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator


class RetryUntilSuccessful(Decorator):
    """Tries its child again when it fails, up to ``num_attempts`` times, -1 for ever.

    As in BehaviorTree.CPP, after a failure it yields (RUNNING): the next attempt is made at the next tick. (A child
    that was RUNNING before it failed is retried at the next tick as well; BehaviorTree.CPP does that in the same.)

    Raises:
        ValueError: if ``num_attempts`` is neither positive nor -1.
    """

    def __init__(self, name: str, child: Behaviour, num_attempts: int) -> None:
        if num_attempts != -1 and num_attempts < 1:
            raise ValueError(f"num_attempts must be positive, or -1 for ever, not {num_attempts}")
        super().__init__(name, child)
        self.num_attempts = num_attempts
        self.failures = 0

    def initialise(self) -> None:
        """Count attempts from the start."""
        self.failures = 0

    def update(self) -> Status:
        """Map the child's status; a failure before the last attempt is RUNNING."""
        if self.decorated.status == Status.FAILURE:
            self.failures += 1
            if self.num_attempts != -1 and self.failures >= self.num_attempts:
                self.feedback_message = f"failed {self.failures} times"
                return Status.FAILURE
            self.feedback_message = f"attempt {self.failures} failed, trying again"
            return Status.RUNNING
        self.feedback_message = ""
        return self.decorated.status
