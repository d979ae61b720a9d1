"""Units run in the caller's thread, in simulated time: deterministic, and as fast as the machine allows."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext

from rosa_core.clock import SimulationClock, Timer
from rosa_streams.environment import Sample
from rosa_streams.errors import StreamError
from rosa_streams.runtime.instance import Instance, Readers
from rosa_streams.runtime.silence import SilenceWatch, silence_watch

Fail = Callable[[Instance, str], None]


class InlineExecutor:
    """Samples are processed in the order in which they were emitted, each until nothing follows from it."""

    def __init__(self, clock: SimulationClock, fail: Fail, queue_size: int, cpu_time: Callable[[], float]) -> None:
        self._clock = clock
        self._fail = fail
        self._queue_size = queue_size
        self._cpu_time = cpu_time
        self._order: deque[Instance] = deque()
        self._timers: dict[Instance, list[Timer]] = {}
        self._busy = False
        self.lock: AbstractContextManager[None] = nullcontext()

    def add(self, instance: Instance) -> None:
        """A source produces from one period after now."""
        period = instance.period
        if period is not None:
            self._timers[instance] = [self._clock.call_every(period, lambda: self._produce(instance))]
        watch = silence_watch(instance)
        if watch is not None:
            timer = self._clock.call_every(watch.seconds, lambda: self._check(watch))
            self._timers.setdefault(instance, []).append(timer)

    def remove(self, instance: Instance) -> None:
        """Stop its timer and discard what waits for it."""
        for timer in self._timers.pop(instance, ()):
            timer.cancel()
        instance.queue.clear()

    def publish(self, readers: Callable[[], Readers], sample: Sample) -> None:
        """Queue a sample and process all that follows."""
        for instance, port in readers():
            self._queue(instance, port, sample)
        self._drain()

    @contextmanager
    def quiet(self) -> Iterator[None]:
        """Between two samples nothing is on its way; inside of one, what waits is processed first."""
        while self._order:
            self._next()
        yield

    def close(self) -> None:
        """Stop all timers."""
        for instance in list(self._timers):
            self.remove(instance)

    def _check(self, watch: SilenceWatch) -> None:
        if watch.is_silent():
            self._fail(watch.instance, watch.reason)

    def _produce(self, instance: Instance) -> None:
        if instance.alive:
            self._run(instance, None, Sample("", None, self._clock.now()))
            self._drain()

    def _queue(self, instance: Instance, port: str, sample: Sample) -> None:
        while len(instance.queue) >= self._queue_size and instance.alive:
            # Back-pressure: what feeds it waits here until it has worked off a sample.
            self._run(instance, *instance.queue.popleft())
        if instance.alive:
            instance.queue.append((port, sample))
            self._order.append(instance)

    def _drain(self) -> None:
        if self._busy:
            return
        self._busy = True
        try:
            while self._order:
                self._next()
        finally:
            self._busy = False

    def _next(self) -> None:
        instance = self._order.popleft()
        if instance.queue:
            port, sample = instance.queue.popleft()
            self._run(instance, port, sample)

    def _run(self, instance: Instance, port: str | None, sample: Sample) -> None:
        try:
            emission = instance.run(port, sample, self._cpu_time)
            if emission is None:
                return
            if type(emission) is dict and len(emission) == 1:
                ((output, value),) = emission.items()
                if value is not None:
                    self._send(
                        instance, output, value if isinstance(value, Sample) else Sample(output, value, sample.time)
                    )
                return
            for output, given in instance.samples(emission, sample.time):
                self._send(instance, output, given)
        # A unit that raises is a lost unit; whatever it raises.
        except Exception as error:
            text = " ".join(str(error).split())[:200]
            self._fail(instance, f"it raised {type(error).__name__}: {text}")

    def _send(self, instance: Instance, output: str, given: Sample) -> None:
        if not instance.alive:
            return
        route = instance.routes.get(output)
        if route is None:
            raise StreamError(f"'{output}' is no output port")
        instance.sent += 1
        for reader, into in route.instances:
            if len(reader.queue) < self._queue_size and reader.alive:
                reader.queue.append((into, given))
                self._order.append(reader)
            else:
                self._queue(reader, into, given)
        for callback in route.callbacks:
            callback(given)
