"""The outcomes of a tick."""

from __future__ import annotations

from enum import Enum
from typing import Final, Literal

from py_trees.common import Status


class _Skipped(Enum):
    """The one outcome that is not a status: its parent learns of it, and the skipped node keeps its status."""

    SKIPPED = "SKIPPED"


IDLE: Final = Status.INVALID
SUCCESS: Final = Status.SUCCESS
FAILURE: Final = Status.FAILURE
RUNNING: Final = Status.RUNNING

SKIPPED: Final = _Skipped.SKIPPED
"""The node was not to be ticked now; its parent passes over it."""

Outcome = Status | Literal[_Skipped.SKIPPED]
"""SUCCESS, FAILURE or RUNNING, or :data:`SKIPPED`."""

OUTCOMES_BY_NAME: dict[str, Outcome] = {"SUCCESS": SUCCESS, "FAILURE": FAILURE, "RUNNING": RUNNING, "SKIPPED": SKIPPED}
"""The outcomes that a port such as ``else`` or ``if_empty`` may name."""
