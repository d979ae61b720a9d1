"""Runs a behaviour tree on a knowledge base."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.trees import BehaviourTree
from py_trees.visitors import VisitorBase

from rosa_core import Clock, KnowledgeBase
from task_layer.action_requests import ActionRequests
from task_layer.bt.engine.failing import fail
from task_layer.bt.engine.node import Node
from task_layer.bt.engine.tick_context import log_failure
from task_layer.bt.waiting import UnfeasibleAction, unfeasible_actions
from task_layer.mission_runner import MissionRunner


class TreeRunner(MissionRunner[Status]):
    """Runs a behaviour tree on a knowledge base.

    When it is ticked, and what the knowledge base sees of a tick, is the same for trees and plans: see
    :class:`~task_layer.mission_runner.MissionRunner`. A node that yields (such as
    :class:`~task_layer.bt.SequenceWithMemory`) is ticked again at once, but not for ever without time passing: only
    while its ticks come to something that they have not come to since the last change, and at most as often in a row
    as the tree has nodes. So a tree that tries the same again and again in vain is ticked once a period, whatever its
    decorators.

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
        strategy = _TreeTicking(self.tree, on_raise, self._unfeasible_actions)
        self._kb = kb
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
        self._ticking_tree = strategy

    @property
    def waiting_for(self) -> tuple[UnfeasibleAction, ...]:
        """The actions that the tree would perform if they were feasible, when it was last halted.

        They are what a mission that could not go on was waiting for; there are none if it was performing an action.
        """
        return self._ticking_tree.waiting_for

    def _unfeasible_actions(self) -> tuple[UnfeasibleAction, ...]:
        if self._kb is None:
            return ()
        return unfeasible_actions(self.tree.root, self._kb, self.clock.now() - 2.0 * self.period)


class _TreeTicking:
    """The strategy of a behaviour tree: where it has got, its nodes know."""

    def __init__(
        self,
        tree: BehaviourTree,
        on_raise: Callable[[Behaviour, Exception], None],
        unfeasible_actions: Callable[[], tuple[UnfeasibleAction, ...]],
    ) -> None:
        self._tree = tree
        self._on_raise = on_raise
        self._unfeasible_actions = unfeasible_actions
        self.waiting_for: tuple[UnfeasibleAction, ...] = ()
        self.most_in_a_row = sum(1 for _ in tree.root.iterate())
        self._trace: _Trace | None = None
        self._seen: set[tuple[_Visit, ...]] = set()

    @property
    def status(self) -> Status:
        status: Status = self._tree.root.status
        return status

    @property
    def is_over(self) -> bool:
        return self.status is not Status.RUNNING

    def tick(self) -> None:
        trace = self._trace
        if trace is None:
            self._tick_or_fail()
            return
        trace.begin()
        self._tick_or_fail()
        if trace.an_action_ended():
            self._seen.clear()

    def follow_up(self) -> None:
        if not self.is_over:
            self._tick_or_fail()

    def gets_on(self) -> bool:
        if self._trace is None:
            # Most trees never ask for a tick at once, and are not traced.
            self._trace = _Trace()
            return True
        visits = tuple(self._trace.visits)
        if visits in self._seen:
            return False
        self._seen.add(visits)
        return True

    def settle(self) -> None:
        self._trace = None
        self._seen.clear()

    def halt(self) -> None:
        self.waiting_for = () if self.status is Status.SUCCESS else self._unfeasible_actions()
        self._tree.root.stop(Status.INVALID)

    def close(self) -> None:
        self._tree.shutdown()

    def _tick_or_fail(self) -> None:
        try:
            if self._trace is None:
                self._tick_tree()
            else:
                self._tick_with(self._trace)
        except Exception as error:
            # Something raised that is under no node of ours, which would have seen to it: the whole tree has failed.
            fail(self._tree.root, error, self._on_raise)

    def _tick_with(self, trace: _Trace) -> None:
        self._tree.add_visitor(trace)
        try:
            self._tree.tick()
        finally:
            self._tree.visitors.remove(trace)

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


_Visit = tuple[int, Status, int]
_IS_LEAF = -1


class _Trace(VisitorBase):
    """What a tick comes to: each node that was visited, its status, and its steps if their number is limited."""

    def __init__(self) -> None:
        super().__init__(full=False)
        self.visits: list[_Visit] = []
        self._running: set[int] = set()

    def begin(self) -> None:
        """Begin a tick."""
        self._running = {node for node, status, _ in self.visits if status is Status.RUNNING}
        self.visits = []

    def run(self, behaviour: Behaviour) -> None:
        """Take note of a node; py_trees calls this."""
        steps = behaviour.steps_done if isinstance(behaviour, Node) else 0
        self.visits.append((id(behaviour), behaviour.status, steps if behaviour.children else _IS_LEAF))

    def an_action_ended(self) -> bool:
        """Whether a leaf that was running before this tick has succeeded or failed in it."""
        return any(
            node in self._running and status is not Status.RUNNING and steps == _IS_LEAF
            for node, status, steps in self.visits
        )
