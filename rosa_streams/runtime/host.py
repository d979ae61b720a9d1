"""The computational environment in process: units are loaded, connected, run and unloaded.

With a :class:`~rosa_core.clock.SimulationClock` everything runs in the thread that lets time pass, each sample to its
end before the next: deterministic. With any other clock units run in worker threads
(:mod:`rosa_streams.runtime.threads`).

A reconfiguration waits until no sample is on its way (quiescence, Kramer and Magee 1990), changes all connections at
once and goes on: no sample is lost or doubled by it. Samples that wait for a unit that is lost are lost with it, and
counted.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Any, Protocol

from rosa_core.clock import Clock, SimulationClock
from rosa_streams.environment import Change, Sample, Transformation, Unit
from rosa_streams.errors import StreamError
from rosa_streams.runtime.computation import Sources
from rosa_streams.runtime.inline import InlineExecutor
from rosa_streams.runtime.instance import Callback, Instance, LostUnit, Readers, connect, readers_of


class Executor(Protocol):
    """How samples get processed."""

    def add(self, instance: Instance) -> None:
        """An instance is loaded and connected."""
        ...

    def remove(self, instance: Instance) -> None:
        """An instance is gone."""
        ...

    def publish(self, readers: Callable[[], Readers], sample: Sample) -> None:
        """A sample from outside is for those that read its channel when it is queued."""
        ...

    @property
    def lock(self) -> AbstractContextManager[Any]:
        """Held while connections change."""
        ...

    def quiet(self) -> AbstractContextManager[None]:
        """Inside the block no sample is on its way; it begins when those that are have arrived."""
        ...

    def close(self) -> None:
        """Stop."""
        ...


class Host:
    """The computational environment (figure 1 of the paper) in this process.

    Args:
        clock: simulated time runs everything in the caller's thread; other clocks run threads.
        sources: the implementations.
        on_lost: called with each unit that is lost.
        queue_size: how many samples may wait for a unit; then what feeds it is held back.
        hang_timeout: with threads, seconds after which a unit that does not answer is lost.
        workers: with threads, how many.
        cpu_time: measures processor seconds of the calling thread.
    """

    def __init__(
        self,
        clock: Clock,
        sources: Sources,
        *,
        on_lost: Callable[[LostUnit], None] | None = None,
        queue_size: int = 1000,
        hang_timeout: float = 2.0,
        workers: int = 2,
        cpu_time: Callable[[], float] = time.thread_time,
    ) -> None:
        self.clock = clock
        self.lost: list[LostUnit] = []
        self._sources = sources
        self._on_lost = on_lost or (lambda _: None)
        self._cpu_time = cpu_time
        self._instances: dict[str, Instance] = {}
        self._subscribers: dict[str, dict[int, Callback]] = {}
        self._readers: Mapping[str, Readers] = {}
        self._tokens = itertools.count()
        self._executor: Executor
        if isinstance(clock, SimulationClock):
            self._executor = InlineExecutor(clock, self._fail, queue_size, cpu_time)
        else:
            from rosa_streams.runtime.threads import ThreadExecutor

            self._executor = ThreadExecutor(
                clock, self._fail, queue_size, cpu_time, workers=workers, hang_timeout=hang_timeout
            )

    # -- changing --

    def apply(self, change: Change, library: Mapping[str, Transformation]) -> dict[str, float]:
        """Make a change set real: load what is created, connect what is reconfigured, unload what goes, all at once.

        Args:
            change: its units are what counts.
            library: transformations by tid.

        Returns:
            for each unit that was loaded, the processor seconds that it took. A unit that cannot be loaded is lost.
        """
        labor: dict[str, float] = {}
        loaded: list[Instance] = []
        failed: list[LostUnit] = []
        for unit in change.created():
            before = self._cpu_time()
            try:
                computation = self._sources.make(unit, library[unit.tid])
            # Whatever an implementation raises while it starts is its failure, not ours.
            except Exception as error:
                failed.append(
                    LostUnit(unit.cid, f"it cannot be loaded: {_described(error)}", self.clock.now(), tid=unit.tid)
                )
                continue
            labor[unit.cid] = self._cpu_time() - before
            loaded.append(Instance(unit, library[unit.tid], computation, self.clock.now()))
        with self._executor.quiet():
            for unit in change.unloaded():
                self._drop(unit.cid)
            for unit in change.reconfigured():
                if unit.cid in self._instances:
                    self._instances[unit.cid].unit = unit
            for instance in loaded:
                self._instances[instance.unit.cid] = instance
            self._connect()
            for instance in loaded:
                self._executor.add(instance)
        for lost in failed:
            self._report(lost)
        return labor

    def lose(self, cid: str, reason: str = "it was unloaded from outside") -> None:
        """A unit goes without a plan, as if it had crashed.

        Raises:
            StreamError: if there is no such unit.
        """
        instance = self._instances.get(cid)
        if instance is None:
            raise StreamError(f"no unit '{cid}' is loaded")
        self._fail(instance, reason)

    def close(self) -> None:
        """Unload everything and stop."""
        self._executor.close()
        for cid in list(self._instances):
            self._drop(cid)

    # -- streams --

    def subscribe(self, channel: str, callback: Callback) -> Callable[[], None]:
        """Call back with every sample on a channel, whoever writes it. Returns what ends the subscription.

        A callback that raises is not called again; ``lost`` says why.
        """
        token = next(self._tokens)

        def guarded(sample: Sample) -> None:
            if token not in self._subscribers.get(channel, {}):
                return
            try:
                callback(sample)
            except Exception as error:
                self._subscribers.get(channel, {}).pop(token, None)
                reason = f"it raised {_described(error)}"
                self.lost.append(LostUnit(f"a subscriber of {channel}", reason, self.clock.now()))

        with self._executor.quiet():
            self._subscribers.setdefault(channel, {})[token] = guarded
            self._connect()

        def unsubscribe() -> None:
            with self._executor.quiet():
                if self._subscribers.get(channel, {}).pop(token, None) is not None:
                    self._connect()

        return unsubscribe

    def publish(self, channel: str, value: Any, time: float | None = None) -> None:
        """Give a sample from outside to all that subscribe to a channel.

        With threads it waits while a queue is full.
        """
        sample = Sample(channel, value, self.clock.now() if time is None else time)
        self._executor.publish(lambda: self._readers.get(channel, ()), sample)
        for callback in list(self._subscribers.get(channel, {}).values()):
            callback(sample)

    # -- looking --

    def units(self) -> frozenset[Unit]:
        """The units that are loaded."""
        return frozenset(instance.unit for instance in list(self._instances.values()))

    def instances(self) -> Mapping[str, Instance]:
        """The loaded units with their counts and processor time, by cid."""
        return dict(self._instances)

    # -- losing --

    def _fail(self, instance: Instance, reason: str, *, stuck: bool = False) -> None:
        with self._executor.lock:
            if self._instances.get(instance.unit.cid) is not instance:
                return
            waiting = len(instance.queue)
            self._drop(instance.unit.cid, close=not stuck)
            self._connect()
        self._report(LostUnit(instance.unit.cid, reason, self.clock.now(), waiting, instance.unit.tid))

    def _drop(self, cid: str, *, close: bool = True) -> None:
        instance = self._instances.pop(cid, None)
        if instance is None:
            return
        instance.alive = False
        self._executor.remove(instance)
        end = getattr(instance.computation, "close", None)
        if close and end is not None:
            try:
                end()
            except Exception as error:
                self.lost.append(LostUnit(cid, f"closing it failed: {_described(error)}", self.clock.now()))

    def _connect(self) -> None:
        self._readers = readers_of(self._instances)
        connect(self._instances, self._readers, self._subscribers)

    def _report(self, lost: LostUnit) -> None:
        self.lost.append(lost)
        self._on_lost(lost)


def _described(error: BaseException) -> str:
    text = " ".join(str(error).split())[:200]
    return f"{type(error).__name__}: {text}" if text else type(error).__name__
