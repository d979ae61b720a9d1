"""Actions, atomic or made of others (RoCS paper, sections 4.2 and 5.1).

What the block Execute carries out is any :class:`Activity`; a skill of the task layer is one as it stands.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from enum import Enum
from typing import Protocol


class ActionStatus(Enum):
    """How far an action has got."""

    RUNNING = "running"
    SUCCESS = "success"
    FAILURE = "failure"


class Activity(Protocol):
    """Something that takes its time: ``start``, then ``update`` until it is not running any more, then ``stop``."""

    def start(self) -> None:
        """Begin; must return at once."""
        ...

    def update(self) -> Enum:
        """How far it has got, with the values of :class:`ActionStatus`; must return at once."""
        ...

    def stop(self) -> None:
        """Clean up: it is over, or was interrupted."""
        ...


def is_running(status: Enum) -> bool:
    """Whether an activity goes on, whichever enumeration says so."""
    return bool(status.value == ActionStatus.RUNNING.value)


class Action(ABC):
    """An atomic action; its behaviour is in :meth:`act`."""

    @property
    def name(self) -> str:
        """What it is called; by default its class."""
        return type(self).__name__

    def start(self) -> None:  # noqa: B027 - it need not be overridden
        """Begin; by default there is nothing to do."""

    @abstractmethod
    def act(self) -> ActionStatus:
        """Do what is to be done now, and say whether it goes on."""

    def update(self) -> ActionStatus:
        """Act."""
        return self.act()

    def stop(self) -> None:  # noqa: B027
        """Clean up: by default there is nothing to do."""


class MacroAction(Action):
    """An action that is made of others, carried out in order; it fails with the first of them that fails."""

    def __init__(self) -> None:
        self._left: list[Activity] = []
        self._current: Activity | None = None

    @abstractmethod
    def decompose(self) -> Sequence[Activity]:
        """The actions that it is made of, as things are now."""

    def start(self) -> None:
        """Decompose it."""
        self._left, self._current = list(self.decompose()), None

    def act(self) -> ActionStatus:
        """Carry on with the one whose turn it is; what is over at once lets the next one begin at once."""
        while True:
            if self._current is None:
                if not self._left:
                    return ActionStatus.SUCCESS
                self._current = self._left.pop(0)
                self._current.start()
            status = self._current.update()
            if is_running(status):
                return ActionStatus.RUNNING
            self.stop()
            if status.value == ActionStatus.FAILURE.value:
                return ActionStatus.FAILURE

    def stop(self) -> None:
        """Stop the one whose turn it is."""
        current, self._current = self._current, None
        if current is not None:
            current.stop()


def decomposition(action: MacroAction) -> str:
    """What an action is made of, as the paper's table 1 writes it, such as ``TurnAngle; SetWheelSpeed``."""
    return "; ".join(getattr(part, "name", type(part).__name__) for part in action.decompose())
