"""The nodes of BehaviorTree.CPP v4 that ask whether an entry of the blackboard was written."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.failing import Leaf
from task_layer.bt.engine.node import Flow
from task_layer.bt.engine.outcome import FAILURE, RUNNING, SKIPPED, SUCCESS, Outcome
from task_layer.bt.nodes.decorators import Decorator
from task_layer.bt.ports.blackboard import Blackboard


class _Updates:
    """Whether an entry was written since it was last asked; also a write of the same value counts."""

    def __init__(self, blackboard: Blackboard, key: str) -> None:
        self._blackboard = blackboard
        self.key = key
        self._seen = 0

    def any(self) -> bool:
        entry = self._blackboard.entry(self.key)
        if entry is None:
            return False
        seen, self._seen = self._seen, entry.writes
        return seen != entry.writes


class WasEntryUpdated(Leaf):
    """SUCCESS if an entry was written since this node was last ticked, otherwise FAILURE.

    Args:
        name: the node's name in the tree.
        blackboard: the blackboard of the entry.
        entry: the name of the entry.
    """

    def __init__(self, name: str, blackboard: Blackboard, entry: str) -> None:
        super().__init__(name)
        self._updates = _Updates(blackboard, entry)

    def update(self) -> Status:
        """Compare with what was seen last."""
        if self._updates.any():
            return SUCCESS
        self.feedback_message = f"the entry '{self._updates.key}' was not updated"
        return FAILURE


class _IfUpdated(Decorator):
    """Ticks its child if an entry was written since this node was last ticked, and until the child has ended."""

    _otherwise: Outcome

    def __init__(self, name: str, child: Behaviour, blackboard: Blackboard, entry: str) -> None:
        super().__init__(name, child)
        self._updates = _Updates(blackboard, entry)

    def flow(self) -> Flow:
        child = self.decorated
        if child.status is not RUNNING and not self._updates.any():
            return self._otherwise
        outcome = yield child
        if outcome is SUCCESS or outcome is FAILURE:
            self.halt_child(child)
        return outcome


class SkipUnlessUpdated(_IfUpdated):
    """Ticks its child if an entry was written since this node was last ticked; otherwise it is skipped.

    Args:
        name: the node's name in the tree.
        child: the child.
        blackboard: the blackboard of the entry.
        entry: the name of the entry.
    """

    _otherwise = SKIPPED


class WaitValueUpdate(_IfUpdated):
    """Ticks its child if an entry was written since this node was last ticked; otherwise it is RUNNING.

    Args:
        name: the node's name in the tree.
        child: the child.
        blackboard: the blackboard of the entry.
        entry: the name of the entry.
    """

    _otherwise = RUNNING
