"""What the nodes of a tree are told about what runs them."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from py_trees.behaviour import Behaviour

from rosa_core import Clock, WallClock

_log = logging.getLogger("task_layer.bt")


def _nothing(*_: object) -> None:
    """What a wake does in a tree that nobody runs."""


def log_failure(behaviour: Behaviour, error: Exception) -> None:
    """Log that a behaviour raised."""
    _log.error("'%s' raised", behaviour.name, exc_info=error)


@dataclass(frozen=True, slots=True)
class TickContext:
    """How a node reaches what runs its tree; a runner passes each to ``setup`` under its name.

    Attributes:
        clock: tells the time, in s.
        wake: asks for a tick at once.
        wake_at: asks for a tick at a time of the clock, in s.
        on_raise: hears of a behaviour that raised, and of the exception; by default it is logged.
    """

    clock: Clock = field(default_factory=WallClock)
    wake: Callable[[], None] = _nothing
    wake_at: Callable[[float], None] = _nothing
    on_raise: Callable[[Behaviour, Exception], None] = log_failure

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> TickContext:
        """Take what there is among the keyword arguments of a ``setup``."""
        names = ("clock", "wake", "wake_at", "on_raise")
        return cls(**{name: given[name] for name in names if given.get(name) is not None})


NO_RUNNER = TickContext()
"""A tree that is ticked by hand."""
