"""How an action is carried out, written once for behaviour trees and plans alike."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum


class SkillStatus(Enum):
    """How far something that the task layer carries out has got: a skill, a function that is a leaf, a leaf."""

    RUNNING = "running"
    SUCCESS = "success"
    FAILURE = "failure"


class Skill:
    """The behaviour of one action. Override :meth:`update`, and the others where there is something to do.

    The life of a skill: ``start``, then ``update`` until it is no longer ``RUNNING`` or the task layer turns to
    something else, then ``stop``, exactly once for every start. After that it may be started again. A skill that raises
    has failed.

    Example:
        >>> class Count(Skill):
        ...     def start(self) -> None:
        ...         self.left = 2
        ...
        ...     def update(self) -> SkillStatus:
        ...         self.left -= 1
        ...         return SkillStatus.RUNNING if self.left else SkillStatus.SUCCESS
        >>> skill = Count()
        >>> skill.start()
        >>> skill.update(), skill.update()
        (<SkillStatus.RUNNING: 'running'>, <SkillStatus.SUCCESS: 'success'>)
    """

    def start(self) -> None:
        """Begin; must return at once.

        If the skill carries out an action of the knowledge base, that has accepted the request for it. The
        reconfiguration for the action may still be going on; do not wait for it here.
        """

    def update(self) -> SkillStatus:
        """Look how far it has got; must return at once. The first time is in the tick that started it.

        Returns:
            ``RUNNING`` as long as there is something left to do.

        Raises:
            TypeError: if a subclass does not define it.
        """
        raise TypeError(f"{type(self).__name__} must define update()")

    def stop(self) -> None:
        """Clean up: the skill succeeded, failed, or was interrupted."""


def updated(skill: Skill) -> SkillStatus:
    """Ask a skill how far it has got.

    Args:
        skill: one that has started.

    Returns:
        what its ``update`` says.

    Raises:
        TypeError: if that is no :class:`SkillStatus`. Whatever ``update`` raises is raised as well.
    """
    status = skill.update()
    if not isinstance(status, SkillStatus):
        raise TypeError(f"update() must return a SkillStatus, not {status!r}")
    return status


class WaitUntil(Skill):
    """Runs until a condition holds; for actions whose work the components do.

    Args:
        done: whether the action is done.

    Example:
        >>> WaitUntil(lambda: True).update()
        <SkillStatus.SUCCESS: 'success'>
    """

    def __init__(self, done: Callable[[], bool]) -> None:
        self._done = done

    def update(self) -> SkillStatus:
        """Ask the condition."""
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
