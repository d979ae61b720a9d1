"""The statuses of a running tree: written by the thread that ticks it, read by the one that replies to Groot2."""

from __future__ import annotations

import struct
import threading
from collections import deque
from collections.abc import Sequence

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import Clock
from task_layer.bt.engine.status_changes import watch_statuses
from task_layer.bt.groot.transition import CODES, microseconds, transition_record

_STATUS = struct.Struct("<HB")
_WENT_IDLE = 10
_MOST_TRANSITIONS = 1000
"""The number of transitions that are kept until they are read, as in BehaviorTree.CPP."""


class StatusBoard:
    """The status of every node, and the transitions while they are recorded. Any thread may read.

    Args:
        nodes: all nodes with their numbers, the root first (see :func:`~task_layer.bt.groot.nodes.list_nodes`).
        clock: the source of the times of transitions.
    """

    def __init__(self, nodes: Sequence[tuple[Behaviour, int]], clock: Clock) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._statuses = bytearray(b"".join(_STATUS.pack(uid, CODES[node.status]) for node, uid in nodes))
        self._places = {id(node): (_STATUS.size * (n + 1) - 1, uid) for n, (node, uid) in enumerate(nodes)}
        self._recorded_since: int | None = None
        self._transitions: deque[bytes] = deque(maxlen=_MOST_TRANSITIONS)
        self.close = watch_statuses(nodes[0][0], self._changed)

    def statuses(self) -> bytes:
        """Number and status of every node, 3 bytes each; that of an idle node is its status before, plus 10."""
        with self._lock:
            return bytes(self._statuses)

    def start_recording(self) -> int:
        """Record transitions from now on.

        Returns:
            the time from which those of transitions count, in µs.
        """
        with self._lock:
            self._recorded_since = microseconds(self._clock)
            self._transitions.clear()
            return self._recorded_since

    def stop_recording(self) -> None:
        """Stop recording; the transitions recorded so far can still be taken."""
        with self._lock:
            self._recorded_since = None

    def take_transitions(self) -> bytes:
        """The transitions recorded since the last call, 9 bytes each: time (6, in µs), number (2), status (1)."""
        with self._lock:
            taken = b"".join(self._transitions)
            self._transitions.clear()
            return taken

    def _changed(self, behaviour: Behaviour, old: Status, new: Status) -> None:
        place, uid = self._places[id(behaviour)]
        code = CODES[new]
        with self._lock:
            self._statuses[place] = code or _WENT_IDLE + CODES[old]
            if self._recorded_since is not None:
                self._transitions.append(transition_record(microseconds(self._clock) - self._recorded_since, uid, code))
