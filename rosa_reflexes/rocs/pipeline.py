"""The priority queue between Plan and Execute (RoCS paper, section 5.1), without its inversion of priorities.

A reactive action clears what was decided on before it and raises the epoch; what was decided on in an earlier epoch is
refused. Nothing that is less urgent can remove a reactive action.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

from rosa_reflexes.rocs.actions import Activity


@dataclass(frozen=True, slots=True)
class Queued:
    """An activity that is to be carried out; ``source`` is the block that asked for it."""

    activity: Activity
    priority: float
    source: str


class Pipeline:
    """What is to be carried out: higher priorities first, in order of arrival among equals. Any thread may use it."""

    def __init__(self) -> None:
        self.refused = 0
        """How many stale actions were refused."""
        self.on_change: Callable[[], None] = lambda: None
        self._queue: list[Queued] = []
        self._epoch = 0
        self._lock = threading.Lock()

    @property
    def epoch(self) -> int:
        """How often a reactive action has cleared it. A plan notes it before it decides."""
        return self._epoch

    def put(self, queued: Queued, epoch: int) -> bool:
        """Add an action of deliberation.

        Args:
            queued: the action.
            epoch: the epoch in which it was decided on.

        Returns:
            whether it was added: it is refused if a reactive action came in between.
        """
        with self._lock:
            if epoch != self._epoch:
                self.refused += 1
                return False
            self._insert(queued)
        self.on_change()
        return True

    def preempt(self, queued: Queued) -> bool:
        """Add a reactive action, and remove what is less urgent.

        Returns:
            whether it was added: it is not if one of the same source is waiting already.
        """
        with self._lock:
            if any(other.source == queued.source for other in self._queue):
                return False
            self._queue = [other for other in self._queue if other.priority >= queued.priority]
            self._epoch += 1
            self._insert(queued)
        self.on_change()
        return True

    def next(self, above: float | None = None) -> Queued | None:
        """Take the most urgent action; with ``above`` only if its priority is greater."""
        with self._lock:
            if not self._queue or (above is not None and self._queue[0].priority <= above):
                return None
            return self._queue.pop(0)

    def __len__(self) -> int:
        return len(self._queue)

    def _insert(self, queued: Queued) -> None:
        at = next((n for n, other in enumerate(self._queue) if other.priority < queued.priority), len(self._queue))
        self._queue.insert(at, queued)
