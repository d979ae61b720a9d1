"""Runs a behaviour tree on a knowledge base."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.trees import BehaviourTree

from rosa_core import Clock, KnowledgeBase
from task_layer.action_requests import ActionRequests
from task_layer.bt.engine.tick_context import log_failure
from task_layer.mission_runner import MissionRunner


class TreeRunner(MissionRunner[Status]):
    """Runs a behaviour tree on a knowledge base.

    When it is ticked, and what the knowledge base sees of a tick, is the same for trees and plans: see
    :class:`~task_layer.mission_runner.MissionRunner`. A node that yields (such as
    :class:`~task_layer.bt.SequenceWithMemory`) is ticked again at once, but not for ever without time passing: at most
    as often in a row as the tree has nodes.

    Args:
        tree: a root behaviour or a py_trees ``BehaviourTree`` (its visitors and handlers work as ever).
        kb: the knowledge base, if the tree uses one. Every behaviour's ``setup`` gets it as ``kb``; and ``clock``,
            :meth:`wake`, :meth:`wake_at`, :meth:`tick_number` and ``on_raise`` under their names.
        period: seconds between ticks when nothing happens.
        clock: by default the knowledge base's, without one the wall clock.
        around_tick: makes a context in which each tick runs, for measuring what ticks cost.
        on_raise: hears of a behaviour that raised, and of the exception; by default it is logged. The behaviour has
            failed then, and the tree goes on.
        setup: further keyword arguments for every behaviour's ``setup``.

    Raises:
        ValueError: if the period is not positive.

    Example:
        >>> from rosa_core import SimulationClock
        >>> from task_layer.bt import Condition, TreeRunner
        >>> with TreeRunner(Condition("always", lambda: True), clock=SimulationClock()) as runner:
        ...     print(runner.run(timeout=10.0))
        Status.SUCCESS
    """

    def __init__(
        self,
        tree: Behaviour | BehaviourTree,
        kb: KnowledgeBase | None = None,
        *,
        period: float = 0.1,
        clock: Clock | None = None,
        around_tick: Callable[[], AbstractContextManager[None]] = nullcontext,
        on_raise: Callable[[Behaviour, Exception], None] = log_failure,
        setup: dict[str, Any] | None = None,
    ) -> None:
        self.tree = tree if isinstance(tree, BehaviourTree) else BehaviourTree(tree)
        requests = None if kb is None else ActionRequests(kb)
        strategy = _TreeTicking(self.tree, on_raise)
        super().__init__(strategy, kb, requests, period=period, clock=clock, around_tick=around_tick)
        given: dict[str, Any] = {
            "clock": self.clock,
            "wake": self.wake_again,
            "wake_at": self.wake_at,
            "tick_number": self.tick_number,
            "on_raise": on_raise,
            **(setup or {}),
        }
        if kb is not None:
            given |= {"kb": kb, "action_requests": requests}
        try:
            self.tree.setup(**given)
        except BaseException:
            self._unsubscribe()
            raise


class _TreeTicking:
    """The strategy of a behaviour tree: where it has got, its nodes know."""

    def __init__(self, tree: BehaviourTree, on_raise: Callable[[Behaviour, Exception], None]) -> None:
        self._tree = tree
        self._on_raise = on_raise
        self.most_in_a_row = sum(1 for _ in tree.root.iterate())

    @property
    def status(self) -> Status:
        status: Status = self._tree.root.status
        return status

    @property
    def is_over(self) -> bool:
        return self.status is not Status.RUNNING

    def tick(self) -> None:
        try:
            self._tick_tree()
        except Exception as error:
            self._fail(error)

    def follow_up(self) -> None:
        if not self.is_over:
            self.tick()

    def halt(self) -> None:
        self._tree.root.stop(Status.INVALID)

    def close(self) -> None:
        self._tree.shutdown()

    def _tick_tree(self) -> None:
        """What ``BehaviourTree.tick`` does; without visitors there is nobody to walk through the tree for."""
        tree = self._tree
        if tree.visitors:
            tree.tick()
            return
        for handler in tree.pre_tick_handlers:
            handler(tree)
        tree.root.tick_once()
        for handler in tree.post_tick_handlers:
            handler(tree)
        tree.count += 1

    def _fail(self, error: Exception) -> None:
        """Something raised that is under no node of ours, which would have seen to it: the whole tree has failed."""
        root = self._tree.root
        self._on_raise(root, error)
        root.stop(Status.INVALID if root.children else Status.FAILURE)
        root.status = Status.FAILURE
        root.feedback_message = f"raised {type(error).__name__}: {error}"
