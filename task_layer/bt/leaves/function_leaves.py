"""Leaves made of a plain function."""

from __future__ import annotations

from collections.abc import Callable

import py_trees
from py_trees.common import Status


class Condition(py_trees.behaviour.Behaviour):
    """SUCCESS while ``holds()`` is true, FAILURE while it is not."""

    def __init__(self, name: str, holds: Callable[[], bool]) -> None:
        super().__init__(name)
        self._holds = holds

    def update(self) -> Status:
        """Ask the function."""
        return Status.SUCCESS if self._holds() else Status.FAILURE


class InstantAction(py_trees.behaviour.Behaviour):
    """Calls ``act()`` and succeeds at once."""

    def __init__(self, name: str, act: Callable[[], None]) -> None:
        super().__init__(name)
        self._act = act

    def update(self) -> Status:
        """Call the function."""
        self._act()
        return Status.SUCCESS
