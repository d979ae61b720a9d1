"""Pre- and post-conditions, which any node may have (BehaviorTree.CPP v4)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Outcome

Check = Callable[[], bool]
Action = Callable[[], object]


@dataclass(frozen=True, slots=True)
class Conditions:
    """The pre-conditions that are checked before a node is ticked, and the post-conditions that follow its end.

    Attributes:
        failure_if: if true, the node fails without being ticked; checked while it is idle.
        success_if: if true, it succeeds without being ticked; checked while it is idle.
        skip_if: if true, it is skipped; checked while it is idle.
        while_true: if false, it is skipped; checked at every tick, and a node that is running is halted.
        on_success: called when the node has succeeded.
        on_failure: called when it has failed.
        on_halted: called when it was running and is halted.
        post: called when it has succeeded or failed.

    >>> from py_trees.common import Status
    >>> Conditions(skip_if=lambda: True).before(Status.INVALID) is SKIPPED
    True
    >>> Conditions(skip_if=lambda: True).before(Status.RUNNING) is None
    True
    """

    failure_if: Check | None = None
    success_if: Check | None = None
    skip_if: Check | None = None
    while_true: Check | None = None
    on_success: Action | None = None
    on_failure: Action | None = None
    on_halted: Action | None = None
    post: Action | None = None

    def before(self, status: Status) -> Outcome | None:
        """The outcome that takes the place of a tick, by the first pre-condition that decides one.

        Args:
            status: the node's status before the tick.

        Returns:
            FAILURE, SUCCESS or SKIPPED; None if the node is to be ticked.
        """
        if status is RUNNING:
            return SKIPPED if self.while_true is not None and not self.while_true() else None
        if status is not IDLE:
            return None
        if self.failure_if is not None and self.failure_if():
            return FAILURE
        if self.success_if is not None and self.success_if():
            return SUCCESS
        if self.skip_if is not None and self.skip_if():
            return SKIPPED
        return SKIPPED if self.while_true is not None and not self.while_true() else None

    def after(self, outcome: Outcome) -> None:
        """Call what follows the node's end."""
        if outcome is SUCCESS:
            _call(self.on_success)
            _call(self.post)
        elif outcome is FAILURE:
            _call(self.on_failure)
            _call(self.post)

    def halted(self) -> None:
        """Call what follows a halt."""
        _call(self.on_halted)


def _call(action: Action | None) -> None:
    if action is not None:
        action()


def set_conditions(node: Behaviour, conditions: Conditions) -> None:
    """Give a node its pre- and post-conditions, in place of those it had.

    Args:
        node: any behaviour below a control node or decorator of this package, which evaluates the conditions.
        conditions: the conditions.
    """
    setattr(node, _ATTRIBUTE, conditions)


def conditions_of(node: Behaviour) -> Conditions | None:
    """The node's conditions, if it has any."""
    conditions: Conditions | None = node.__dict__.get(_ATTRIBUTE)
    return conditions


_ATTRIBUTE = "bt_conditions"
