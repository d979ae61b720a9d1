"""How an action is carried out, written once for behaviour trees and plans alike."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum


class SkillStatus(Enum):
    """How far a skill has got."""

    RUNNING = "running"
    SUCCESS = "success"
    FAILURE = "failure"


class Skill:
    """The behaviour of one action. Override :meth:`update`, and the others where there is something to do.

    The life of a skill: ``start``, then ``update`` until it is no longer ``RUNNING`` or the task layer turns to
    something else, then ``stop``, exactly once for every start. After that it may be started again.
    """

    def start(self) -> None:
        """Begin. The architecture for the action is requested at the same time; do not wait for it here."""

    def update(self) -> SkillStatus:
        """Look how far it has got; must return at once."""
        raise TypeError(f"{type(self).__name__} must define update()")

    def stop(self) -> None:
        """Clean up: the skill succeeded, failed, or was interrupted."""


class WaitUntil(Skill):
    """Runs until something is so; for actions whose work the components do.

    Args:
        done: whether the action is done.
    """

    def __init__(self, done: Callable[[], bool]) -> None:
        self._done = done

    def update(self) -> SkillStatus:
        """Look whether it is so."""
        return SkillStatus.SUCCESS if self._done() else SkillStatus.RUNNING


class WithHooks(Skill):
    """A skill with something to do when it begins and when it is over.

    Args:
        skill: how the action is carried out.
        begin: called before the skill starts.
        end: called after it has stopped.
    """

    def __init__(self, skill: Skill, begin: Callable[[], object], end: Callable[[], object]) -> None:
        self._skill, self._begin, self._end = skill, begin, end

    def start(self) -> None:
        """Begin both."""
        self._begin()
        self._skill.start()

    def update(self) -> SkillStatus:
        """What the skill says."""
        return self._skill.update()

    def stop(self) -> None:
        """End both."""
        self._skill.stop()
        self._end()
