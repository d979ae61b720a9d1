"""A unit that is loaded: its computation, where its samples go, and what it has cost."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from rosa_streams.environment import Sample, Transformation, Unit
from rosa_streams.runtime.computation import Computation, Emission

Callback = Callable[[Sample], None]

_CHEAP = 20e-6
_SKIPPED = 15


class Instance:
    """A loaded unit."""

    __slots__ = (
        "alive",
        "blocked_producers",
        "computation",
        "cpu",
        "queue",
        "received",
        "routes",
        "scheduled",
        "sent",
        "since",
        "skip",
        "skipped",
        "transformation",
        "unit",
    )

    def __init__(self, unit: Unit, transformation: Transformation, computation: Computation, now: float) -> None:
        self.unit = unit
        self.transformation = transformation
        self.computation = computation
        self.queue: deque[tuple[str | None, Sample]] = deque()
        self.routes: dict[str, Route] = {}
        self.alive = True
        self.scheduled = False
        self.blocked_producers: dict[Instance, None] = {}
        self.cpu = 0.0
        self.received = 0
        self.sent = 0
        self.skip = 0
        self.skipped = 0
        self.since = now

    @property
    def period(self) -> float | None:
        """Of a source, in seconds; None for a unit with inputs."""
        return getattr(self.computation, "period", None)

    def run(self, port: str | None, sample: Sample, cpu_time: Callable[[], float]) -> Emission:
        """Let the computation take a sample, or (without a port) produce.

        Processor time is measured at every call of what takes long, and at one call in sixteen of what is cheap, so
        that measuring does not cost more than what is measured.
        """
        self.received += 1
        if self.skip:
            self.skip -= 1
            self.skipped += 1
            return self._call(port, sample)
        before = cpu_time()
        try:
            return self._call(port, sample)
        finally:
            took = cpu_time() - before
            self.cpu += took * (1 + self.skipped)
            self.skipped = 0
            self.skip = 0 if took > _CHEAP or self.received < 4 else _SKIPPED

    def _call(self, port: str | None, sample: Sample) -> Emission:
        if port is None:
            return self.computation.produce(sample.time)  # type: ignore[attr-defined,no-any-return]
        return self.computation.receive(port, sample)

    def samples(self, emission: Emission, time: float) -> Iterator[tuple[str, Sample]]:
        """The output ports and samples of what the computation gave."""
        for values in _mappings(emission):
            for port, value in values.items():
                if value is not None:
                    yield port, (value if isinstance(value, Sample) else Sample(port, value, time))


def _mappings(emission: Emission) -> Iterable[Mapping[str, Any]]:
    if emission is None:
        return ()
    return (emission,) if isinstance(emission, Mapping) else emission


Readers: TypeAlias = tuple[tuple[Instance, str], ...]
"""Instances, each with the input port that takes the samples."""


@dataclass(slots=True)
class Route:
    """Where the samples of an output port go."""

    instances: Readers = ()
    callbacks: tuple[Callback, ...] = ()


@dataclass(frozen=True, slots=True)
class LostUnit:
    """A unit that is gone though nobody unloaded it: which, why, when, how many samples waited for it, and of what."""

    cid: str
    reason: str
    time: float
    waiting: int = 0
    tid: str = ""


def readers_of(instances: Mapping[str, Instance]) -> dict[str, Readers]:
    """For each channel the instances that subscribe to it."""
    readers: dict[str, list[tuple[Instance, str]]] = {}
    for instance in instances.values():
        for port, channel in instance.unit.inputs:
            if channel is not None:
                readers.setdefault(channel, []).append((instance, port))
    return {channel: tuple(found) for channel, found in readers.items()}


def connect(
    instances: Mapping[str, Instance], readers: Mapping[str, Readers], subscribers: Mapping[str, Mapping[int, Callback]]
) -> None:
    """Set the routes of all instances from the channels of their units and the clients' subscriptions."""
    for instance in instances.values():
        routes = {}
        for port, channels in instance.unit.outputs:
            into = tuple(reader for channel in channels for reader in readers.get(channel, ()))
            callbacks = tuple(each for channel in channels for each in subscribers.get(channel, {}).values())
            routes[port] = Route(into, callbacks)
        instance.routes = routes
