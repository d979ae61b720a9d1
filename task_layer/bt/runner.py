"""Ticks a tree when there is reason to: when the knowledge base changes, and at a period."""

from __future__ import annotations

import heapq
import math
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from types import TracebackType
from typing import Any

import py_trees
from py_trees.common import Status

from rosa_core import Clock, KnowledgeBase, WallClock
from rosa_core.kb import Event
from task_layer.action_requests import ActionRequests
from task_layer.bt.engine.tick_context import log_failure
from task_layer.waking import WAKING, changes_feasibility


class TreeRunner:
    """Runs a behaviour tree on a knowledge base.

    The tree is ticked when a status, an activity or a required action changes, and at least every ``period`` seconds,
    so that skills get on. (A measurement that changes no status changes nothing that a tree asks.) All requests of
    one tick are one change of the knowledge base. What follows from the tree's own requests does not wake it, unless
    it makes an action feasible or unfeasible: a tree must not chase its own tail. A node that yields (such as
    :class:`~task_layer.bt.SequenceWithMemory`) is ticked again at once, but not for ever without time passing.

    The same runner serves a robot and a simulation: time, and waiting for it, is the clock's.

    Args:
        tree: a root behaviour or a py_trees ``BehaviourTree`` (its visitors and handlers work as ever).
        kb: the knowledge base, if the tree uses one. Every behaviour's ``setup`` gets it as ``kb``; and ``clock``,
            :meth:`wake`, :meth:`wake_at` and ``on_raise`` under their names.
        period: seconds between ticks when nothing happens.
        clock: by default the knowledge base's, without one the wall clock.
        around_tick: makes a context in which each tick runs, for measuring what ticks cost.
        on_raise: hears of a behaviour that raised, and of the exception; by default it is logged. The behaviour has
            failed then, and the tree goes on.
        setup: further keyword arguments for every behaviour's ``setup``.
    """

    def __init__(
        self,
        tree: py_trees.behaviour.Behaviour | py_trees.trees.BehaviourTree,
        kb: KnowledgeBase | None = None,
        *,
        period: float = 0.1,
        clock: Clock | None = None,
        around_tick: Callable[[], AbstractContextManager[None]] = nullcontext,
        on_raise: Callable[[py_trees.behaviour.Behaviour, Exception], None] = log_failure,
        setup: dict[str, Any] | None = None,
    ) -> None:
        if not period > 0:
            raise ValueError(f"the period must be positive, not {period}")
        self.tree = tree if isinstance(tree, py_trees.trees.BehaviourTree) else py_trees.trees.BehaviourTree(tree)
        self.period = period
        self.clock: Clock = clock or (WallClock() if kb is None else kb.clock)
        self._requests = None if kb is None else ActionRequests(kb)
        self._around_tick = around_tick
        self._on_raise = on_raise
        self._wake = threading.Event()
        self._wake_times: list[float] = []
        self._ticking: int | None = None
        self._asked_again = False
        self._interrupted = False
        given: dict[str, Any] = {
            "clock": self.clock,
            "wake": self._wake_from_behaviour,
            "wake_at": self.wake_at,
            "on_raise": on_raise,
            **(setup or {}),
        }
        if kb is not None:
            given |= {"kb": kb, "action_requests": self._requests}
        self.tree.setup(**given)
        self._unsubscribe = _nothing if kb is None else kb.subscribe(self._on_event, WAKING)

    def wake(self) -> None:
        """Tick soon: something happened that is not in the knowledge base. Any thread may call this."""
        self._wake.set()

    def wake_at(self, time: float) -> None:
        """Tick at a time of the clock, in s, if not before. For behaviours, from within a tick."""
        heapq.heappush(self._wake_times, time)

    def tick(self) -> Status:
        """Tick once; the requests made meanwhile are written when the tick is over."""
        with self._around_tick(), self._together():
            self._ticking = threading.get_ident()
            try:
                self._tick_tree()
            except Exception as error:
                self._fail(error)
            finally:
                self._ticking = None
        status: Status = self.tree.root.status
        return status

    def run(self, *, timeout: float = math.inf, until: Callable[[], bool] | None = None) -> Status:
        """Tick until the tree succeeds or fails, ``until()`` is true, or ``timeout`` seconds are over.

        Whatever is then still running is interrupted.

        Returns:
            the root's last status; RUNNING if it was stopped before it was done.
        """
        deadline = self.clock.now() + timeout
        most = sum(1 for _ in self.tree.root.iterate())
        at_once = 0
        status = Status.RUNNING
        self._interrupted = False
        try:
            while status == Status.RUNNING and not self._interrupted:
                self._wake.clear()
                self._asked_again = False
                status = self.tick()
                left = deadline - self.clock.now()
                if status != Status.RUNNING or left <= 0 or (until is not None and until()):
                    break
                # A tree that tries in vain again and again must let time pass.
                at_once = at_once + 1 if self._asked_again and at_once < most else 0
                if at_once == 0:
                    self.clock.wait(self._wake, min(self.period, left, self._until_wake_time()))
        finally:
            self.halt()
        return status

    def halt(self) -> None:
        """Halt whatever is running; the next tick begins anew."""
        with self._together():
            self.tree.root.stop(Status.INVALID)

    def interrupt(self) -> None:
        """Let :meth:`run` stop after the present tick. Any thread may call this."""
        self._interrupted = True
        self._wake.set()

    def close(self) -> None:
        """Listen to the knowledge base no longer, and shut the tree's behaviours down."""
        self._unsubscribe()
        self.tree.shutdown()

    def __enter__(self) -> TreeRunner:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def _tick_tree(self) -> None:
        """What ``BehaviourTree.tick`` does; without visitors there is nobody to walk through the tree for."""
        tree = self.tree
        if tree.visitors:
            tree.tick()
            return
        for handler in tree.pre_tick_handlers:
            handler(tree)
        tree.root.tick_once()
        for handler in tree.post_tick_handlers:
            handler(tree)
        tree.count += 1

    def _wake_from_behaviour(self) -> None:
        """A behaviour wants a tick at once; from within one, at most as often in a row as the tree has nodes."""
        if self._ticking == threading.get_ident():
            self._asked_again = True
        else:
            self.wake()

    def _until_wake_time(self) -> float:
        """How long, in s, until a behaviour wants to be ticked."""
        now, times = self.clock.now(), self._wake_times
        while times and times[0] <= now:
            heapq.heappop(times)
        return times[0] - now if times else math.inf

    def _fail(self, error: Exception) -> None:
        """Something raised that is under no node of ours, which would have seen to it: the whole tree has failed."""
        root = self.tree.root
        self._on_raise(root, error)
        root.stop(Status.INVALID if root.children else Status.FAILURE)
        root.status = Status.FAILURE
        root.feedback_message = f"raised {type(error).__name__}: {error}"

    def _together(self) -> AbstractContextManager[None]:
        return nullcontext() if self._requests is None else self._requests.together()

    def _on_event(self, event: Event) -> None:
        if self._requests is None or not self._requests.committing or changes_feasibility(event):
            self._wake.set()


def _nothing() -> None:
    """What there is to unsubscribe without a knowledge base."""
