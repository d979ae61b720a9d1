"""Units run in worker threads, in real time.

A worker takes a unit that has samples waiting, lets it take some of them, and goes on with what they made ready: a
sample goes through a chain of units without changing threads. A unit is run by one worker at a time. A unit whose
readers are full is held back until there is room. A unit that does not answer in time is lost; the worker that is
stuck in it is replaced.
"""

from __future__ import annotations

import heapq
import itertools
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Protocol

from rosa_core.clock import Clock
from rosa_streams.environment import Sample
from rosa_streams.runtime.instance import Instance, Readers
from rosa_streams.runtime.silence import SilenceWatch, silence_watch


class Fail(Protocol):
    """Reports a unit as lost."""

    def __call__(self, instance: Instance, reason: str, *, stuck: bool = False) -> None:
        """Lose a unit; a stuck one is still inside of its computation."""
        ...


_AT_ONCE = 64
"""How many samples a unit takes before others get their turn."""


class _Worker:
    """A thread, and what it is busy with."""

    __slots__ = ("busy_since", "instance", "retired", "thread")

    def __init__(self) -> None:
        self.instance: Instance | None = None
        self.busy_since = 0.0
        self.retired = False
        self.thread: threading.Thread | None = None


class ThreadExecutor:
    """Runs units in threads; see the module."""

    def __init__(
        self,
        clock: Clock,
        fail: Fail,
        queue_size: int,
        cpu_time: Callable[[], float],
        *,
        workers: int,
        hang_timeout: float,
    ) -> None:
        self._clock, self._fail_host, self._queue_size, self._cpu_time = clock, fail, queue_size, cpu_time
        self._hang_timeout = hang_timeout
        self._changed = threading.Condition(threading.RLock())
        self._ready: deque[Instance] = deque()
        self._schedule: list[tuple[float, int, Instance]] = []
        self._sequence = itertools.count()
        self._watches: list[tuple[float, SilenceWatch]] = []
        self._quiet = 0
        self._closed = False
        self._wake = threading.Event()
        self._workers = [self._start_worker() for _ in range(max(1, workers))]
        self._timekeeper = threading.Thread(target=self._keep_time, name="streams-time", daemon=True)
        self._timekeeper.start()

    # -- Executor --

    @property
    def lock(self) -> AbstractContextManager[bool]:
        """Held while connections change."""
        return self._changed

    def add(self, instance: Instance) -> None:
        """A source produces from one period after now."""
        period = instance.period
        if period is not None:
            with self._changed:
                heapq.heappush(self._schedule, (self._clock.now() + period, next(self._sequence), instance))
            self._wake.set()
        watch = silence_watch(instance)
        if watch is not None:
            with self._changed:
                self._watches.append((self._clock.now() + watch.seconds, watch))

    def remove(self, instance: Instance) -> None:
        """Discard what waits for it, and let go who waited for room in its queue."""
        with self._changed:
            instance.queue.clear()
            self._release(instance)
            self._changed.notify_all()

    def publish(self, readers: Callable[[], Readers], sample: Sample) -> None:
        """Queue a sample from outside; waits while queues are full or connections change."""
        with self._changed:
            own = any(worker.thread is threading.current_thread() for worker in self._workers)
            while not self._closed:
                # Whoever reads the channel is asked under the lock: connections may have changed while we waited.
                found = readers()
                full = any(instance.alive and len(instance.queue) >= self._queue_size for instance, _ in found)
                if own or not (self._quiet or full):
                    for instance, port in found:
                        self._put(instance, port, sample)
                    return
                self._changed.wait(0.1)

    @contextmanager
    def quiet(self) -> Iterator[None]:
        """Sources pause, what is on its way arrives, and the block runs while nothing moves."""
        with self._changed:
            self._quiet += 1
            try:
                me = threading.current_thread()
                while self._moving(me) and not self._closed:
                    self._changed.wait(0.05)
                yield
            finally:
                self._quiet -= 1
                self._changed.notify_all()
        self._wake.set()

    def close(self) -> None:
        """Stop all threads; one that is stuck in a unit is left behind (it is a daemon)."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        self._wake.set()
        for thread in (self._timekeeper, *(worker.thread for worker in self._workers)):
            if thread is not None and thread is not threading.current_thread():
                thread.join(self._hang_timeout + 0.5)

    # -- workers --

    def _start_worker(self) -> _Worker:
        worker = _Worker()
        worker.thread = threading.Thread(target=self._work, args=(worker,), name="streams-worker", daemon=True)
        worker.thread.start()
        return worker

    def _work(self, worker: _Worker) -> None:
        while True:
            with self._changed:
                while not self._ready and not self._closed and not worker.retired:
                    self._changed.wait()
                if self._closed or worker.retired:
                    return
                instance = self._ready.popleft()
                worker.instance = instance
            failure = self._run_some(instance, worker)
            with self._changed:
                if worker.retired:
                    return
                worker.instance = None
                instance.scheduled = False
                if instance.alive and instance.queue and failure is None:
                    self._make_ready(instance)
                if self._quiet and not self._ready:
                    self._changed.notify_all()
            if failure is not None:
                self._fail_host(instance, failure)

    def _run_some(self, instance: Instance, worker: _Worker) -> str | None:
        """Let a unit take samples that wait for it. Returns why it failed, if it did."""
        for _ in range(_AT_ONCE):
            with self._changed:
                if not instance.queue or not instance.alive or self._held_back(instance):
                    return None
                port, sample = instance.queue.popleft()
                if instance.blocked_producers and len(instance.queue) * 2 <= self._queue_size:
                    self._release(instance)
                worker.busy_since = self._clock.now()
            try:
                emission = instance.run(port, sample, self._cpu_time)
                if emission is None:
                    continue
                given = list(instance.samples(emission, sample.time))
            except Exception as error:
                return f"it raised {type(error).__name__}: {' '.join(str(error).split())[:200]}"
            finally:
                worker.busy_since = 0.0
            for output, made in given:
                problem = self._send(instance, output, made)
                if problem is not None:
                    return problem
        return None

    def _send(self, instance: Instance, output: str, sample: Sample) -> str | None:
        with self._changed:
            if not instance.alive:
                return None  # It was lost or unloaded meanwhile: what it gives comes too late.
            route = instance.routes.get(output)
            if route is None:
                return f"it gave a value for '{output}', which is no output port"
            instance.sent += 1
            for reader, into in route.instances:
                self._put(reader, into, sample)
            callbacks = route.callbacks
        for callback in callbacks:
            callback(sample)
        return None

    def _put(self, instance: Instance, port: str | None, sample: Sample) -> None:
        if instance.alive:
            instance.queue.append((port, sample))
            self._make_ready(instance)

    def _make_ready(self, instance: Instance) -> None:
        if not instance.scheduled:
            instance.scheduled = True
            self._ready.append(instance)
            self._changed.notify()

    def _held_back(self, instance: Instance) -> bool:
        """Whether a reader is full; then the reader makes the unit ready again when there is room."""
        for route in instance.routes.values():
            for reader, _ in route.instances:
                if reader.alive and len(reader.queue) >= self._queue_size and reader is not instance:
                    reader.blocked_producers[instance] = None
                    return True
        return False

    def _release(self, instance: Instance) -> None:
        producers = list(instance.blocked_producers)
        instance.blocked_producers.clear()
        for producer in producers:
            if producer.alive and producer.queue:
                self._make_ready(producer)
        self._changed.notify_all()

    def _moving(self, me: threading.Thread) -> bool:
        """Whether a sample is on its way. A unit that this very thread runs does not count: it waits for us."""
        if self._ready:
            return True
        return any(
            worker.instance is not None and not worker.retired and worker.thread is not me for worker in self._workers
        )

    # -- time --

    def _keep_time(self) -> None:
        """Make sources produce when it is time, and find units that do not answer."""
        while True:
            with self._changed:
                if self._closed:
                    return
                now = self._clock.now()
                stuck, silent = self._stuck(now), self._silent(now)
                if not self._quiet:
                    self._produce_due(now)
                wait = self._hang_timeout / 4
                if self._schedule and not self._quiet:
                    wait = min(wait, max(self._schedule[0][0] - now, 0.0))
                self._wake.clear()
            for instance in stuck:
                self._fail_host(instance, f"it hangs: no answer for {self._hang_timeout:g} s", stuck=True)
            for watch in silent:
                self._fail_host(watch.instance, watch.reason)
            if wait > 0:
                self._clock.wait(self._wake, wait)

    def _produce_due(self, now: float) -> None:
        while self._schedule and self._schedule[0][0] <= now:
            due, _, instance = heapq.heappop(self._schedule)
            period = instance.period
            if not instance.alive or period is None:
                continue
            if not instance.queue and not self._held_back(instance):
                self._put(instance, None, Sample("", None, now))
            # A source that is held back, or not done with the last time, lets this time pass.
            missed = int((now - due) // period)
            heapq.heappush(self._schedule, (due + (missed + 1) * period, next(self._sequence), instance))

    def _silent(self, now: float) -> list[SilenceWatch]:
        silent, watches = [], []
        for due, watch in self._watches:
            if now < due:
                watches.append((due, watch))
            elif watch.instance.alive:
                watches.append((now + watch.seconds, watch))
                if watch.is_silent():
                    silent.append(watch)
        self._watches = watches
        return silent

    def _stuck(self, now: float) -> list[Instance]:
        found = []
        for number, worker in enumerate(self._workers):
            if worker.busy_since and now - worker.busy_since > self._hang_timeout and worker.instance is not None:
                found.append(worker.instance)
                worker.retired = True
                self._workers[number] = self._start_worker()
        if found:
            self._changed.notify_all()
        return found
