"""Parts of a mission in which code of others runs, and what is called when that raises."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Protocol, TypeAlias

_log = logging.getLogger("task_layer")


class MissionPart(Protocol):
    """A behaviour of a tree, a step of a plan, or a sensed fact."""

    @property
    def name(self) -> str:
        """What the mission calls it."""
        ...


OnRaise: TypeAlias = Callable[[MissionPart, Exception], None]
"""Takes the part that raised, and what it raised."""


def log_raised(part: MissionPart, error: Exception) -> None:
    """Log that a part of the mission raised.

    Args:
        part: the behaviour, step or sensor.
        error: logged with its traceback.
    """
    _log.error("'%s' raised", part.name, exc_info=error)
