"""What becomes of a behaviour that raises: it fails, and says why."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from types import new_class
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.outcome import FAILURE, IDLE
from task_layer.bt.engine.tick_context import NO_RUNNER, TickContext

OWN_CLASS = "_bt_own_class"
"""The attribute in which a class that was made here has the class of the user."""


def fail(behaviour: Behaviour, error: Exception, on_raise: Callable[[Behaviour, Exception], None]) -> Status:
    """Count a behaviour that raised as failed, with the reason as its feedback message; the tree goes on."""
    on_raise(behaviour, error)
    try:
        # A composite of py_trees halts its running children only when it is stopped with INVALID.
        behaviour.stop(IDLE if behaviour.children else FAILURE)
    except Exception as second_error:
        on_raise(behaviour, second_error)
    behaviour.status = FAILURE
    behaviour.feedback_message = f"raised {type(error).__name__}: {error}"
    return FAILURE


class Leaf(Behaviour):
    """A behaviour that fails when it raises, whatever ticks it: a node of this package, one of py_trees, or nothing.

    Args:
        name: the behaviour's name in the tree.
    """

    tick_context: TickContext = NO_RUNNER

    def setup(self, **kwargs: Any) -> None:
        """Keep what the runner passes: see :class:`~task_layer.bt.engine.tick_context.TickContext`."""
        self.tick_context = TickContext.of(kwargs)
        super().setup(**kwargs)

    def tick(self) -> Iterator[Behaviour]:
        """Tick as py_trees does, and fail if that raises."""
        try:
            yield from super().tick()
        except Exception as error:
            fail(self, error, self.tick_context.on_raise)
            yield self


def let_fail(root: Behaviour) -> None:
    """Let a behaviour of any class, and whatever it ticks, fail when it raises instead of ending the program."""
    root.__class__ = _failing(type(root))


@cache
def _failing(kind: type[Behaviour]) -> type[Behaviour]:
    body: dict[str, Any] = {name: getattr(kind, name) for name in ("__module__", "__qualname__", "__doc__")}
    body[OWN_CLASS] = kind
    return new_class(kind.__name__, (Leaf, kind), exec_body=lambda names: names.update(body))
