"""Statuses and their changes in BehaviorTree.CPP's protocol and log."""

from __future__ import annotations

import struct
from enum import IntEnum

from py_trees.common import Status

from rosa_core import Clock

TRANSITION = struct.Struct("<IHHB")
"""Time since the start in µs (the low 4 bytes, the high 2), number of the node, status."""


class StatusCode(IntEnum):
    """BehaviorTree.CPP's ``NodeStatus``."""

    IDLE = 0
    RUNNING = 1
    SUCCESS = 2
    FAILURE = 3
    SKIPPED = 4


CODES: dict[Status, int] = {
    Status.INVALID: 0,
    Status.RUNNING: 1,
    Status.SUCCESS: 2,
    Status.FAILURE: 3,
}
"""The code of each status of py_trees, as plain numbers, which are faster than enums at every change."""


def transition_record(after: int, uid: int, status: int) -> bytes:
    """A transition, ``after`` µs from the start, as a :data:`TRANSITION`."""
    return TRANSITION.pack(after & 0xFFFFFFFF, (after >> 32) & 0xFFFF, uid, status)


def microseconds(clock: Clock) -> int:
    """The clock's time in µs, as the protocol and the log count it."""
    return round(clock.now() * 1e6)
