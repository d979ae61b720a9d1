"""What the tests of several threads share."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from rosa_core import (
    KnowledgeBase,
    SimulationClock,
)
from rosa_core.kb import (
    Event,
    MonitoringData,
)
from tests.hang_limit import HANG_LIMIT
from tests.rosa_core.journal.writes import robot

DISPATCHES = ("synchronous", "threads")


def make(dispatch: Any = "threads", **options: Any) -> KnowledgeBase:
    return KnowledgeBase(robot(), SimulationClock(), dispatch=dispatch, **options)


def together(work: Iterable[Callable[[], object]]) -> None:
    """Do it all at once, each in its thread, and raise what any of them raises."""
    jobs = list(work)
    ready = threading.Barrier(len(jobs))

    def begin(job: Callable[[], object]) -> None:
        ready.wait(HANG_LIMIT)
        job()

    with ThreadPoolExecutor(len(jobs)) as pool:
        for future in [pool.submit(begin, job) for job in jobs]:
            future.result(HANG_LIMIT)


def values(events: Iterable[Event]) -> list[float]:
    return [m.value for event in events if isinstance(event, MonitoringData) for m in event.measurements]


class RecordingSystem:
    """A managed system in which everything works, and which knows what runs."""

    def __init__(self) -> None:
        self.running: set[str] = set()

    def activate(self, component: str) -> None:
        self.running.add(component)

    def deactivate(self, component: str) -> None:
        self.running.discard(component)

    def set_parameters(self, component: str, parameters: object) -> None:
        pass
