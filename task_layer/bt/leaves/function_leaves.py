"""Leaves made of a plain function."""

from __future__ import annotations

from collections.abc import Callable

from py_trees.common import Status

from task_layer.bt.engine.failing import Leaf


class Condition(Leaf):
    """A condition given by a function: SUCCESS if it returns true, FAILURE if not.

    Args:
        name: the behaviour's name in the tree.
        holds: the function.

    >>> condition = Condition("is_charged", lambda: True)
    >>> condition.tick_once()
    >>> condition.status.name
    'SUCCESS'
    """

    def __init__(self, name: str, holds: Callable[[], bool]) -> None:
        super().__init__(name)
        self._holds = holds

    def update(self) -> Status:
        """Call the function."""
        return Status.SUCCESS if self._holds() else Status.FAILURE


class InstantAction(Leaf):
    """An action given by a function that returns at once: calls it, and succeeds.

    Args:
        name: the behaviour's name in the tree.
        act: the function.

    >>> action = InstantAction("greet", lambda: print("hello"))
    >>> action.tick_once()
    hello
    """

    def __init__(self, name: str, act: Callable[[], None]) -> None:
        super().__init__(name)
        self._act = act

    def update(self) -> Status:
        """Call the function."""
        self._act()
        return Status.SUCCESS
