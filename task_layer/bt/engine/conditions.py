"""Pre- and post-conditions, which any node may have (BehaviorTree.CPP v4)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.outcome import FAILURE, IDLE, RUNNING, SKIPPED, SUCCESS, Outcome

Holds = Callable[[], bool]
Act = Callable[[], object]


@dataclass(frozen=True, slots=True)
class Conditions:
    """What is checked before a node is ticked, and what is done after it has ended.

    Attributes:
        failure_if: the node fails without being ticked; asked while it is idle.
        success_if: the same, but it succeeds.
        skip_if: the same, but it is skipped.
        while_true: it is skipped unless this holds; asked at every tick, and a running node is then halted.
        on_success: done when the node has succeeded.
        on_failure: done when it has failed.
        on_halted: done when it was running and is halted.
        post: done when it has succeeded or failed.
    """

    failure_if: Holds | None = None
    success_if: Holds | None = None
    skip_if: Holds | None = None
    while_true: Holds | None = None
    on_success: Act | None = None
    on_failure: Act | None = None
    on_halted: Act | None = None
    post: Act | None = None

    def before(self, status: Status) -> Outcome | None:
        """The outcome that takes the place of a tick, if the pre-conditions say so; the first that does decides.

        Args:
            status: the node's status before the tick.
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
        """Do what is to be done once the node has ended."""
        if outcome is SUCCESS:
            _do(self.on_success)
            _do(self.post)
        elif outcome is FAILURE:
            _do(self.on_failure)
            _do(self.post)

    def halted(self) -> None:
        """Do what is to be done once the node was halted."""
        _do(self.on_halted)


def _do(act: Act | None) -> None:
    if act is not None:
        act()


def set_conditions(node: Behaviour, conditions: Conditions) -> None:
    """Give a node its conditions. They count under the control nodes and decorators of this package."""
    setattr(node, _ATTRIBUTE, conditions)


def conditions_of(node: Behaviour) -> Conditions | None:
    """The node's conditions, if it has any."""
    conditions: Conditions | None = node.__dict__.get(_ATTRIBUTE)
    return conditions


_ATTRIBUTE = "bt_conditions"
