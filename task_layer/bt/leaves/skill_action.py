"""The leaf that carries out a skill."""

from __future__ import annotations

from py_trees.common import Status

from task_layer.bt.engine.failing import Leaf
from task_layer.bt.engine.status import as_status
from task_layer.skill import Skill, updated


class SkillAction(Leaf):
    """Carries out a :class:`~task_layer.skill.Skill`, or the hooks of a subclass, and nothing else.

    The hooks need no ``super()``: :meth:`on_start`, :meth:`on_running` and :meth:`on_halted`.

    Args:
        name: the behaviour's name in the tree.
        skill: what to carry out.
    """

    def __init__(self, name: str, skill: Skill | None = None) -> None:
        super().__init__(name)
        self.skill = skill
        self._started = False

    def on_start(self) -> None:
        """Begin; by default starts the skill."""
        if self.skill is not None:
            self.skill.start()

    def on_running(self) -> Status:
        """Go on: RUNNING, SUCCESS or FAILURE; by default asks the skill.

        Raises:
            TypeError: if there is no skill and a subclass does not define this.
        """
        if self.skill is None:
            raise TypeError(f"'{self.name}' has no skill, and {type(self).__name__} does not define on_running()")
        return as_status(updated(self.skill))

    def on_halted(self) -> None:
        """Clean up after an interruption. (A skill is stopped then, and also when it has ended by itself.)"""

    def initialise(self) -> None:
        """Begin; py_trees calls this."""
        self._started = True
        self.on_start()

    def update(self) -> Status:
        """Go on; py_trees calls this."""
        return self.on_running()

    def terminate(self, new_status: Status) -> None:
        """End; py_trees calls this, also on behaviours that ended long ago: those are left alone."""
        if self._started:
            self._started = False
            try:
                if new_status is Status.INVALID:
                    self.on_halted()
            finally:
                if self.skill is not None:
                    self.skill.stop()
