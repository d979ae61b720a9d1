"""Delivers what the knowledge base announces to its subscribers: in which order, and in which thread.

Both dispatchers deliver to each subscriber in the order of the writes, and report a subscriber that raises instead of
letting it disturb the others. :class:`SynchronousDispatcher` delivers in the thread that wrote, one event to everybody
before the next, so that the same inputs give the same run. :class:`ThreadedDispatcher` gives every subscriber a thread
and a queue of its own, so that none waits for another and no writer waits for any.
"""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, Protocol

from rosa_core.errors import InvalidValueError
from rosa_core.kb.events import Event

logger = logging.getLogger(__name__)

Subscriber = Callable[[Event], None]
ErrorHandler = Callable[[BaseException, Subscriber, Event], None]
DispatchName = Literal["synchronous", "threads"]


def log_subscriber_error(error: BaseException, subscriber: Subscriber, event: Event) -> None:
    """The default for what to do when a subscriber raises: log it and go on.

    Args:
        error: what was raised.
        subscriber: who raised it; it goes on receiving events.
        event: on which.
    """
    logger.error("subscriber %r raised on %s", subscriber, type(event).__name__, exc_info=error)


class EventsDroppedError(Exception):
    """A subscriber was so slow that its queue was full: its oldest events made room for newer ones.

    Args:
        dropped: how many in all.
        capacity: how many events its queue holds.
        caught_up: whether nothing waits in its queue any more.
    """

    def __init__(self, dropped: int, capacity: int, *, caught_up: bool) -> None:
        self.dropped = dropped
        self.caught_up = caught_up
        now = "it has caught up" if caught_up else "more will be until it has caught up"
        super().__init__(f"more than {capacity} events waited: {dropped} were dropped, the oldest; {now}")


class Dispatcher(Protocol):
    """How events reach subscribers."""

    def subscribe(self, subscriber: Subscriber, event_types: Iterable[type[Event]] | None = None) -> Callable[[], None]:
        """Receive events from now on.

        Args:
            subscriber: called with one event at a time, in the order of the writes.
            event_types: only events of exactly these types; None: of all.

        Returns:
            a function that ends the subscription.
        """
        ...

    def announce(self, events: Iterable[Event]) -> None:
        """Take events; called while writes are still locked out, so that their order is that of the writes."""
        ...

    def deliver(self) -> None:
        """Called after every write, when other threads may write again: the time to deliver in the writer's thread."""
        ...

    def is_delivering(self) -> bool:
        """Whether the calling thread is in a subscriber now."""
        ...

    def drain(self, timeout: float) -> bool:
        """Wait until everything announced is delivered, and what subscribers write too.

        Within a subscriber the event that it is receiving is not waited for.

        Args:
            timeout: how long at the most, s.

        Returns:
            False if the time was too short.
        """
        ...

    def close(self, timeout: float) -> None:
        """Deliver no more; wait up to ``timeout`` seconds for subscribers that are busy."""
        ...


def make_dispatcher(dispatch: DispatchName | Dispatcher, on_error: ErrorHandler) -> Dispatcher:
    """The dispatcher of that name, or the one given.

    Args:
        dispatch: ``synchronous``, ``threads``, or a dispatcher.
        on_error: what the dispatcher of that name calls when a subscriber raises.

    Raises:
        InvalidValueError: if there is none of that name.
    """
    if dispatch == "synchronous":
        return SynchronousDispatcher(on_error)
    if dispatch == "threads":
        return ThreadedDispatcher(on_error)
    if isinstance(dispatch, str):
        raise InvalidValueError(f"dispatch is 'synchronous', 'threads' or a Dispatcher, not '{dispatch}'")
    return dispatch


@dataclass(eq=False, slots=True)
class _Subscription:
    """A subscriber, the types of event that it wants (None: all), and whether the subscription is still active."""

    subscriber: Subscriber
    types: tuple[type[Event], ...] | None
    active: bool = True


class SynchronousDispatcher:
    """Delivers in the thread that wrote, each event to all subscribers before the next (run to completion).

    A subscriber may write: the events of that write wait until the present one is delivered to everybody. When several
    threads write, the one that is already delivering delivers for the others as well.
    """

    def __init__(self, on_error: ErrorHandler = log_subscriber_error) -> None:
        self._on_error = on_error
        self._queue: deque[Event] = deque()
        self._delivering = threading.Lock()
        self._deliverer: int | None = None
        self._lock = threading.Lock()
        self._receiving: Mapping[type[Event], tuple[_Subscription, ...]] = MappingProxyType({})
        self._subscriptions: list[_Subscription] = []

    def subscribe(self, subscriber: Subscriber, event_types: Iterable[type[Event]] | None = None) -> Callable[[], None]:
        """Receive events.

        Args:
            subscriber: called in the thread that wrote, before the write returns.
            event_types: exactly these types; by default all.

        Returns:
            a function that ends the subscription; after it not even an event being delivered reaches the subscriber.
        """
        subscription = _Subscription(subscriber, None if event_types is None else tuple(event_types))
        with self._lock:
            self._subscriptions.append(subscription)
            self._receiving = MappingProxyType({})

        def unsubscribe() -> None:
            subscription.active = False
            with self._lock:
                self._subscriptions = [known for known in self._subscriptions if known.active]
                self._receiving = MappingProxyType({})

        return unsubscribe

    def announce(self, events: Iterable[Event]) -> None:
        """Queue events; call while writes are still locked out, so that their order is that of the writes."""
        self._queue.extend(events)

    def deliver(self) -> None:
        """Deliver what is queued, unless that is already going on, here or in another thread."""
        while self._queue and self._delivering.acquire(blocking=False):
            self._deliver_all()

    def is_delivering(self) -> bool:
        """Whether the calling thread is in a subscriber now."""
        return self._deliverer == threading.get_ident()

    def drain(self, timeout: float) -> bool:
        """Deliver what is queued, and wait for another thread that is delivering.

        Called within a subscriber it returns at once: what is queued is delivered when the subscriber has returned.

        Args:
            timeout: how long to wait for the other thread, s.

        Returns:
            False if that took longer.
        """
        if self.is_delivering():
            return True
        if not self._delivering.acquire(timeout=max(timeout, 0.0)):
            return False
        self._deliver_all()
        self.deliver()
        return True

    def close(self, timeout: float) -> None:
        """Nothing to stop: no thread is kept."""

    def _deliver_all(self) -> None:
        """Deliver until nothing is queued; the caller holds ``_delivering``, which is released."""
        self._deliverer = threading.get_ident()
        try:
            while self._queue:
                self._deliver(self._queue.popleft())
        finally:
            self._deliverer = None
            self._delivering.release()

    def _deliver(self, event: Event) -> None:
        for subscription in self._receivers(type(event)):
            # It may have been ended by a subscriber that received the event before.
            if subscription.active:
                try:
                    subscription.subscriber(event)
                except Exception as error:
                    self._on_error(error, subscription.subscriber, event)

    def _receivers(self, event_type: type[Event]) -> tuple[_Subscription, ...]:
        receivers = self._receiving.get(event_type)
        if receivers is None:
            with self._lock:
                receivers = tuple(s for s in self._subscriptions if s.types is None or event_type in s.types)
                self._receiving = MappingProxyType({**self._receiving, event_type: receivers})
        return receivers


class ThreadedDispatcher:
    """Delivers to every subscriber in a thread of its own: nobody waits for a slow one.

    Every subscriber receives the events in the order of the writes, but two subscribers may be at different events. A
    subscriber that falls behind by more than ``capacity`` events loses the oldest of them: the newest are what one
    that looks at the knowledge base anyway is to be woken by. That is reported when it begins, and when the subscriber
    has caught up.

    Args:
        on_error: called, in the subscriber's thread, when it raises, and with :class:`EventsDroppedError` when events
            were dropped.
        capacity: how many events wait for one subscriber at most.

    Raises:
        InvalidValueError: if the capacity is not at least 1.
    """

    def __init__(self, on_error: ErrorHandler = log_subscriber_error, *, capacity: int = 10_000) -> None:
        if capacity < 1:
            raise InvalidValueError(f"the capacity of a queue must be at least 1, not {capacity}")
        self._on_error = on_error
        self._capacity = capacity
        self._workers: tuple[_Worker, ...] = ()
        self._ending: list[_Worker] = []
        self._lock = threading.Lock()
        self._closed = False
        self._backlog = _Backlog()

    def subscribe(self, subscriber: Subscriber, event_types: Iterable[type[Event]] | None = None) -> Callable[[], None]:
        """Receive events, in a thread for this subscriber alone.

        Args:
            subscriber: called with one event at a time, in order.
            event_types: exactly these types; by default all.

        Returns:
            a function that ends the subscription. After it no further event is received, except one that is being
            delivered already in the other thread.
        """
        types = None if event_types is None else frozenset(event_types)
        worker = _Worker(subscriber, types, self._capacity, self._on_error, self._backlog)
        with self._lock:
            if not self._closed:
                self._workers = (*self._workers, worker)
                worker.start()

        def unsubscribe() -> None:
            with self._lock:
                self._workers = tuple(known for known in self._workers if known is not worker)
                self._ending = [known for known in (*self._ending, worker) if known.is_alive()]
            worker.stop()

        return unsubscribe

    def announce(self, events: Iterable[Event]) -> None:
        """Put events into the queues; call while writes are still locked out, so that their order is the writes'."""
        events = tuple(events)
        for worker in self._workers:
            worker.put(events)

    def deliver(self) -> None:
        """Nothing to do: the subscribers' threads are at it."""

    def is_delivering(self) -> bool:
        """Whether the calling thread is in a subscriber now."""
        return any(worker.is_here() for worker in self._workers)

    def drain(self, timeout: float) -> bool:
        """Wait until every subscriber has received everything.

        Args:
            timeout: how long at the most, s.

        Returns:
            False if that took longer.
        """
        return self._backlog.wait(timeout, at_most=1 if self.is_delivering() else 0)

    def close(self, timeout: float) -> None:
        """Stop the threads; what is still queued is dropped and reported. Subscribers must come back by themselves.

        Args:
            timeout: how long to wait for each (seconds).
        """
        with self._lock:
            self._closed = True
            workers, self._workers = self._workers, ()
            ending, self._ending = self._ending, []
        for worker in workers:
            worker.stop()
        for worker in (*ending, *workers):
            if not worker.join(timeout):
                logger.error("subscriber %r has not returned; its thread is left behind", worker.subscriber)


class _Backlog:
    """How many events are queued or being delivered, over all subscribers."""

    def __init__(self) -> None:
        self._count = 0
        self._changed = threading.Condition()

    def add(self, count: int) -> None:
        with self._changed:
            self._count += count
            if count < 0:
                self._changed.notify_all()

    def wait(self, timeout: float, at_most: int) -> bool:
        with self._changed:
            return self._changed.wait_for(lambda: self._count <= at_most, timeout)


class _Worker:
    """One subscriber's queue and thread."""

    def __init__(
        self,
        subscriber: Subscriber,
        types: frozenset[type[Event]] | None,
        capacity: int,
        on_error: ErrorHandler,
        backlog: _Backlog,
    ) -> None:
        self.subscriber = subscriber
        self._types = types
        self._capacity = capacity
        self._on_error = on_error
        self._backlog = backlog
        self._queue: deque[Event] = deque()
        self._dropped = 0
        self._dropping_reported = False
        self._stopped = False
        self._filled = threading.Condition()
        # A daemon, so that a program that does not close the knowledge base still ends.
        self._thread = threading.Thread(target=self._run, name=f"rosa subscriber {subscriber!r}", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def is_alive(self) -> bool:
        return self._thread.is_alive()

    def is_here(self) -> bool:
        return self._thread is threading.current_thread()

    def put(self, events: tuple[Event, ...]) -> None:
        wanted = events if self._types is None else [event for event in events if type(event) in self._types]
        if not wanted:
            return
        with self._filled:
            if self._stopped:
                return
            self._queue.extend(wanted)
            excess = max(len(self._queue) - self._capacity, 0)
            for _ in range(excess):
                self._queue.popleft()
            self._dropped += excess
            # Counted before the thread can take it, or a drain could find nothing to wait for.
            self._backlog.add(len(wanted) - excess)
            self._filled.notify()

    def stop(self) -> None:
        with self._filled:
            self._stopped = True
            left = len(self._queue)
            self._queue.clear()
            self._filled.notify()
        if left:
            logger.warning("subscriber %r has ended with %d events not delivered", self.subscriber, left)
            self._backlog.add(-left)

    def join(self, timeout: float) -> bool:
        """Wait for the thread (seconds), unless it is the one that asks."""
        if self.is_alive() and not self.is_here():
            self._thread.join(max(timeout, 0.0))
        return self.is_here() or not self.is_alive()

    def _run(self) -> None:
        while True:
            with self._filled:
                self._filled.wait_for(lambda: self._queue or self._stopped)
                if self._stopped:
                    return
                event = self._queue.popleft()
                dropping = self._dropping()
            if dropping is not None:
                self._report(dropping, event)
            try:
                self.subscriber(event)
            except BaseException as error:
                # Whatever it raises: a thread that ends here would leave its subscriber without events, silently.
                self._report(error, event)
            finally:
                self._backlog.add(-1)

    def _dropping(self) -> EventsDroppedError | None:
        """What is to be reported about dropped events: once when it begins, and once when none waits any more."""
        dropped, caught_up = self._dropped, not self._queue
        if not dropped or (self._dropping_reported and not caught_up):
            return None
        self._dropping_reported = not caught_up
        if caught_up:
            self._dropped = 0
        return EventsDroppedError(dropped, self._capacity, caught_up=caught_up)

    def _report(self, error: BaseException, event: Event) -> None:
        try:
            self._on_error(error, self.subscriber, event)
        except Exception:
            logger.exception("reporting an error of subscriber %r failed", self.subscriber)
