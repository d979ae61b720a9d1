"""Time as a port: everything that asks for the time, or waits, does so through a :class:`Clock`.

Times are seconds as float. With :class:`SimulationClock` a run is deterministic and as fast as the machine
allows; with :class:`WallClock` the same code runs on a robot.
"""

from __future__ import annotations

import heapq
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Protocol


class Clock(Protocol):
    """Where the time comes from: the port that everything asks that needs the time."""

    def now(self) -> float:
        """The present time in seconds."""
        ...

    def wait(self, wake: threading.Event, timeout: float) -> None:
        """Let time pass.

        Args:
            wake: when it is set, waiting ends.
            timeout: the most to wait, in seconds.
        """
        ...


class WallClock:
    """Seconds since the epoch at its creation, advanced monotonically: it never jumps when the system clock does."""

    def __init__(self) -> None:
        self._offset = time.time() - time.perf_counter()

    def now(self) -> float:
        """The present time in seconds since the epoch."""
        return self._offset + time.perf_counter()

    def wait(self, wake: threading.Event, timeout: float) -> None:
        """Sleep until ``wake`` is set, at most ``timeout`` seconds.

        Args:
            wake: ends the waiting when another thread sets it; it stays set.
            timeout: seconds.
        """
        wake.wait(timeout)


class Timer:
    """A call that a :class:`SimulationClock` will make; ``cancel()`` takes it back.

    Made by the clock's ``call_at``, ``call_later`` and ``call_every``.

    Args:
        callback: what is called.
        period: seconds from one call to the next; None for a single call.
    """

    __slots__ = ("_callback", "_period", "cancelled")

    def __init__(self, callback: Callable[[], None], period: float | None) -> None:
        self._callback = callback
        self._period = period
        self.cancelled = False

    def cancel(self) -> None:
        """Never call again."""
        self.cancelled = True


class SimulationClock:
    """Simulated time: a schedule of calls, made in order of time and, at the same time, of scheduling.

    Time passes only in :meth:`advance_to` and :meth:`wait`. Periodic calls are at ``start + n * period``,
    computed by multiplication so that they do not drift.

    Args:
        start: the time at the beginning, in seconds.

    Example:
        >>> clock, calls = SimulationClock(), []
        >>> timer = clock.call_every(0.5, lambda: calls.append(clock.now()))
        >>> clock.advance_to(1.2)
        >>> calls, clock.now()
        ([0.5, 1.0], 1.2)
    """

    def __init__(self, start: float = 0.0) -> None:
        self._now = start
        self._sequence = 0
        self._schedule: list[tuple[float, int, Timer, float, int]] = []

    def now(self) -> float:
        """The present simulated time in seconds."""
        return self._now

    def call_at(self, when: float, callback: Callable[[], None]) -> Timer:
        """Make a call once.

        Args:
            when: the time, in seconds; now, if that is past.
            callback: what is called.

        Returns:
            the call, which can be cancelled.
        """
        timer = Timer(callback, None)
        self._push(max(when, self._now), timer, when, 0)
        return timer

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        """Make a call once.

        Args:
            delay: in how many seconds.
            callback: what is called.

        Returns:
            the call, which can be cancelled.
        """
        return self.call_at(self._now + delay, callback)

    def call_every(self, period: float, callback: Callable[[], None], *, start: float | None = None) -> Timer:
        """Make a call again and again.

        Args:
            period: every how many seconds.
            callback: what is called.
            start: when first, in seconds; by default one period from now.

        Returns:
            the calls, which can be cancelled.

        Raises:
            ValueError: if the period is not positive; time would never pass.
        """
        if not period > 0:
            raise ValueError(f"a period must be positive, not {period}")
        first = self._now + period if start is None else start
        timer = Timer(callback, period)
        self._push(max(first, self._now), timer, first, 0)
        return timer

    def advance_to(self, when: float) -> None:
        """Let time pass to ``when``, making every call that is due on the way.

        Args:
            when: seconds.
        """
        while self._schedule and self._schedule[0][0] <= when:
            self._step()
        self._now = max(self._now, when)

    def wait(self, wake: threading.Event, timeout: float) -> None:
        """Let time pass, making every call that is due on the way.

        Args:
            wake: time stops at the call after which it is set.
            timeout: the most to let pass, in seconds.
        """
        deadline = self._now + max(timeout, 0.0)
        while not wake.is_set():
            if not self._schedule or self._schedule[0][0] > deadline:
                # A call may itself have let more time pass.
                self._now = max(self._now, deadline)
                return
            self._step()

    def _push(self, when: float, timer: Timer, first: float, count: int) -> None:
        self._sequence += 1
        heapq.heappush(self._schedule, (when, self._sequence, timer, first, count))

    def _step(self) -> None:
        when, _, timer, first, count = heapq.heappop(self._schedule)
        if timer.cancelled:
            return
        self._now = max(self._now, when)
        if timer._period is not None:
            self._push(first + (count + 1) * timer._period, timer, first, count + 1)
        timer._callback()


class Stopwatch:
    """Adds up the wall-clock time spent inside its ``running()`` blocks: what a manager costs, apart from the world."""

    def __init__(self) -> None:
        self._total = 0.0
        self._started: float | None = None

    @contextmanager
    def running(self) -> Iterator[None]:
        """Count the time of this block; blocks inside blocks count once."""
        if self._started is not None:
            yield
            return
        self._started = time.perf_counter()
        try:
            yield
        finally:
            self._total += time.perf_counter() - self._started
            self._started = None

    def elapsed(self) -> float:
        """Seconds counted up to now, the present block included."""
        if self._started is None:
            return self._total
        return self._total + time.perf_counter() - self._started
