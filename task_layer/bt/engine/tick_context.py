"""What the nodes of a tree know about the runner that ticks them."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import count
from typing import Any

from py_trees.behaviour import Behaviour

from rosa_core import Clock, WallClock

_log = logging.getLogger("task_layer.bt")


def _do_nothing(*_: object) -> None:
    """What waking does in a tree that no runner ticks."""


def log_failure(behaviour: Behaviour, error: Exception) -> None:
    """Log that a behaviour raised."""
    _log.error("'%s' raised", behaviour.name, exc_info=error)


@dataclass(frozen=True, slots=True)
class TickContext:
    """How a node reaches the runner of its tree, which passes each attribute to ``setup`` under its name.

    Attributes:
        clock: the source of the time, in s.
        wake: asks for a tick at once.
        wake_at: asks for a tick at a time of the clock, in s.
        on_raise: called with a behaviour that raised and its exception; by default it is logged.
        tick_number: the number of the present tick, in which a tree may be visited more than once; without a runner
            each visit is a tick.
    """

    clock: Clock = field(default_factory=WallClock)
    wake: Callable[[], None] = _do_nothing
    wake_at: Callable[[float], None] = _do_nothing
    on_raise: Callable[[Behaviour, Exception], None] = log_failure
    tick_number: Callable[[], int] = count().__next__

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> TickContext:
        """Those of the attributes that are among the keyword arguments of a ``setup``; defaults for the others."""
        names = ("clock", "wake", "wake_at", "on_raise", "tick_number")
        return cls(**{name: given[name] for name in names if given.get(name) is not None})


NO_RUNNER = TickContext()
"""The context of a tree that is ticked by hand."""
