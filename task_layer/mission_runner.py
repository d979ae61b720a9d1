"""Runs a mission on a knowledge base: ticks it when there is reason to, and makes its requests one change."""

from __future__ import annotations

import heapq
import math
import threading
from collections.abc import Callable, Collection
from contextlib import AbstractContextManager, nullcontext
from types import TracebackType
from typing import Generic, Protocol, Self, TypeVar

from rosa_core import Clock, KnowledgeBase, WallClock
from rosa_core.kb import Event, MonitoringData
from task_layer.action_requests import ActionRequests
from task_layer.waking import WAKING, is_reason_to_tick

StatusT = TypeVar("StatusT")
StatusT_co = TypeVar("StatusT_co", covariant=True)


class MissionStrategy(Protocol[StatusT_co]):
    """How a mission decides what to do next: a behaviour tree, or a plan."""

    @property
    def status(self) -> StatusT_co:
        """How far the mission has got."""
        ...

    @property
    def is_over(self) -> bool:
        """Whether it has come to its end, so that there is nothing left to tick."""
        ...

    @property
    def most_in_a_row(self) -> float:
        """How often it may be looked at, at most, without time passing between."""
        ...

    def tick(self) -> None:
        """Look at the world, and do what is to be done."""
        ...

    def follow_up(self) -> None:
        """Look again in the same tick: what was requested has been refused, or has come to something already."""
        ...

    def gets_on(self) -> bool:
        """Whether looking again at once can come to something new; asked after a tick that wants another at once."""
        ...

    def settle(self) -> None:
        """Something has changed: the next look may come to something new."""
        ...

    def halt(self) -> None:
        """Interrupt whatever is running."""
        ...

    def close(self) -> None:
        """Let go of what it holds."""
        ...


class MissionRunner(Generic[StatusT]):
    """Ticks a mission when a status, an activity or a required action changes, and at least every ``period``.

    All requests of one tick are one change of the knowledge base, written when the mission has decided. What was
    requested starts then, still in the same tick; if that comes to something at once, such as a refusal, the mission
    is looked at again. What follows from its own requests does not wake it, unless it makes an action feasible or
    unfeasible: a mission must not chase its own tail.

    The same runner serves a robot and a simulation: time, and waiting for it, is the clock's. It is a context manager,
    which closes it.

    Args:
        strategy: what decides.
        kb: the knowledge base, if the mission uses one.
        period: seconds between ticks when nothing happens.
        clock: by default the knowledge base's, without one the wall clock.
        around_tick: makes a context in which each tick runs, for measuring what ticks cost.
        measures: measures whose every measurement is reason for a tick.

    Raises:
        ValueError: if the period is not positive.
    """

    def __init__(
        self,
        strategy: MissionStrategy[StatusT],
        kb: KnowledgeBase | None,
        requests: ActionRequests | None,
        *,
        period: float,
        clock: Clock | None,
        around_tick: Callable[[], AbstractContextManager[None]],
        measures: Collection[str] = (),
    ) -> None:
        if not period > 0:
            raise ValueError(f"the period must be positive, not {period}")
        self.period = period
        self.clock: Clock = clock or (WallClock() if kb is None else kb.clock)
        self._strategy = strategy
        self._requests = requests
        self._around_tick = around_tick
        self._measures = measures
        self._wake = threading.Event()
        self._wake_times: list[float] = []
        self._ticking: int | None = None
        self._tick_number = 0
        self._asked_again = False
        self._interrupted = False
        events = (*WAKING, MonitoringData) if measures else WAKING
        self._unsubscribe = _nothing if kb is None else kb.subscribe(self._on_event, events)

    def wake(self) -> None:
        """Tick soon: something happened that is not in the knowledge base. Any thread may call this."""
        self._wake.set()

    def wake_at(self, time: float) -> None:
        """Tick at a time of the clock, in s, if not before. For parts of the mission, from within a tick."""
        heapq.heappush(self._wake_times, time)

    def wake_again(self) -> None:
        """Ask for a tick, for parts of the mission: from within one, for another at once, but not without end."""
        if self._ticking == threading.get_ident():
            self._asked_again = True
        else:
            self.wake()

    def tick_number(self) -> int:
        """How many ticks there have been, with the present one."""
        return self._tick_number

    def tick(self) -> StatusT:
        """Tick once; the requests made meanwhile are written at the end, and what they are for starts.

        Returns:
            how far the mission has got.
        """
        with self._around_tick():
            self._ticking = threading.get_ident()
            self._tick_number += 1
            try:
                self._decide()
            finally:
                self._ticking = None
        return self._strategy.status

    def run(self, *, timeout: float = math.inf, until: Callable[[], bool] | None = None) -> StatusT:
        """Tick until the mission is over, ``until()`` is true, or ``timeout`` seconds are over.

        Whatever is then still running is interrupted.

        Args:
            timeout: seconds of the clock's time.
            until: asked after every tick.

        Returns:
            how far it got; not its end, if it was stopped before that.
        """
        deadline = self.clock.now() + timeout
        in_a_row = 0
        self._interrupted = False
        try:
            while True:
                if self._wake.is_set():
                    self._strategy.settle()
                    self._wake.clear()
                self._asked_again = False
                status = self.tick()
                left = deadline - self.clock.now()
                if self._is_to_end(left, until):
                    return status
                in_a_row = in_a_row + 1 if self._is_to_tick_again(in_a_row) else 0
                if in_a_row == 0:
                    self.clock.wait(self._wake, min(self.period, left, self._until_wake_time()))
        finally:
            self.halt()

    def halt(self) -> None:
        """Interrupt whatever is running; the next tick begins anew."""
        with self._together():
            self._strategy.halt()

    def interrupt(self) -> None:
        """Let :meth:`run` stop after the present tick. Any thread may call this."""
        self._interrupted = True
        self._wake.set()

    def close(self) -> None:
        """Listen to the knowledge base no longer, and let go of what the mission holds."""
        self._unsubscribe()
        self._strategy.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def _decide(self) -> None:
        with self._together():
            self._strategy.tick()
        follow_ups = 0
        while self._requests is not None and self._requests.answered and follow_ups < self._strategy.most_in_a_row:
            with self._together():
                self._strategy.follow_up()
            follow_ups += 1

    def _is_to_tick_again(self, in_a_row: int) -> bool:
        """Whether to tick again at once; a mission that tries in vain again and again must let time pass."""
        return self._asked_again and in_a_row < self._strategy.most_in_a_row and self._strategy.gets_on()

    def _is_to_end(self, left: float, until: Callable[[], bool] | None) -> bool:
        return self._strategy.is_over or self._interrupted or left <= 0 or (until is not None and until())

    def _until_wake_time(self) -> float:
        """How long, in s, until a part of the mission wants a tick."""
        now, times = self.clock.now(), self._wake_times
        while times and times[0] <= now:
            heapq.heappop(times)
        return times[0] - now if times else math.inf

    def _together(self) -> AbstractContextManager[None]:
        return nullcontext() if self._requests is None else self._requests.together()

    def _on_event(self, event: Event) -> None:
        own = self._requests is not None and self._requests.committing
        if is_reason_to_tick(event, own=own, measures=self._measures):
            self._wake.set()


def _nothing() -> None:
    """What there is to unsubscribe without a knowledge base."""
