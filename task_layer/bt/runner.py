"""Ticks a tree when there is reason to: when the knowledge base changes, and at a period."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from types import TracebackType
from typing import Any

import py_trees
from py_trees.common import Status

from rosa_core import Clock, KnowledgeBase, WallClock
from rosa_core import Status as KbStatus
from rosa_core.kb import ActionUpdate, ComponentActivity, Event, ReconfigurationPlanEnded, StatusesChanged
from rosa_core.model import ElementKind
from task_layer.action_requests import ActionRequests


class TreeRunner:
    """Runs a behaviour tree on a knowledge base.

    The tree is ticked when a status, an activity or a required action changes, and at least every ``period`` seconds,
    so that skills get on. (A measurement that changes no status changes nothing that a tree asks.) All requests of
    one tick are one change of the knowledge base. What follows from the tree's own requests does not wake it, unless
    it makes an action feasible or unfeasible: a tree must not chase its own tail.

    The same runner serves a robot and a simulation: time, and waiting for it, is the clock's.

    Args:
        tree: a root behaviour or a py_trees ``BehaviourTree`` (its visitors and handlers work as ever).
        kb: the knowledge base, if the tree uses one. Every behaviour's ``setup`` gets it as ``kb``, and
            :meth:`wake` as ``wake``.
        period: seconds between ticks when nothing happens.
        clock: by default the knowledge base's, without one the wall clock.
        around_tick: makes a context in which each tick runs, for measuring what ticks cost.
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
        setup: dict[str, Any] | None = None,
    ) -> None:
        if not period > 0:
            raise ValueError(f"the period must be positive, not {period}")
        self.tree = tree if isinstance(tree, py_trees.trees.BehaviourTree) else py_trees.trees.BehaviourTree(tree)
        self.period = period
        self.clock: Clock = clock or (WallClock() if kb is None else kb.clock)
        self._requests = None if kb is None else ActionRequests(kb)
        self._around_tick = around_tick
        self._wake = threading.Event()
        self._interrupted = False
        given: dict[str, Any] = {"wake": self.wake, **(setup or {})}
        if kb is not None:
            given |= {"kb": kb, "action_requests": self._requests}
        self.tree.setup(**given)
        self._unsubscribe = _nothing if kb is None else kb.subscribe(self._on_event, _WAKING)

    def wake(self) -> None:
        """Tick soon: something happened that is not in the knowledge base. Any thread may call this."""
        self._wake.set()

    def tick(self) -> Status:
        """Tick once; the requests made meanwhile are written when the tick is over."""
        with self._around_tick(), self._together():
            self.tree.tick()
        status: Status = self.tree.root.status
        return status

    def run(self, *, timeout: float = math.inf, until: Callable[[], bool] | None = None) -> Status:
        """Tick until the tree succeeds or fails, ``until()`` is true, or ``timeout`` seconds are over.

        Whatever is then still running is interrupted.

        Returns:
            the root's last status; RUNNING if it was stopped before it was done.
        """
        deadline = self.clock.now() + timeout
        status = Status.RUNNING
        self._interrupted = False
        try:
            while status == Status.RUNNING and not self._interrupted:
                self._wake.clear()
                status = self.tick()
                left = deadline - self.clock.now()
                if status != Status.RUNNING or left <= 0 or (until is not None and until()):
                    break
                self.clock.wait(self._wake, min(self.period, left))
        finally:
            with self._together():
                self.tree.root.stop(Status.INVALID)
        return status

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

    def _together(self) -> AbstractContextManager[None]:
        return nullcontext() if self._requests is None else self._requests.together()

    def _on_event(self, event: Event) -> None:
        if self._requests is None or not self._requests.committing or _changes_feasibility(event):
            self._wake.set()


_WAKING = (StatusesChanged, ActionUpdate, ComponentActivity, ReconfigurationPlanEnded)


def _nothing() -> None:
    """What there is to unsubscribe without a knowledge base."""


def _changes_feasibility(event: Event) -> bool:
    return isinstance(event, StatusesChanged) and any(
        change.kind is ElementKind.ACTION and (change.old is KbStatus.UNFEASIBLE) != (change.new is KbStatus.UNFEASIBLE)
        for change in event.changes
    )
