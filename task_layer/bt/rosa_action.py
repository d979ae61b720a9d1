"""The leaf that performs an action and has the robot configured for it (ROSA paper, section 6.2.5)."""

from __future__ import annotations

from py_trees.common import Status

from rosa_core import Result
from task_layer.bt.rosa_leaf import RosaLeaf
from task_layer.skill import Skill, SkillStatus

_STATUS = {
    SkillStatus.RUNNING: Status.RUNNING,
    SkillStatus.SUCCESS: Status.SUCCESS,
    SkillStatus.FAILURE: Status.FAILURE,
}


class RosaAction(RosaLeaf):
    """Requests its action when it starts, and finishes or cancels it when it ends.

    What the action does is either a :class:`~task_layer.skill.Skill`, or the hooks :meth:`on_start`,
    :meth:`on_running` and :meth:`on_halted` of a subclass. A request that the knowledge base refuses is a FAILURE
    with the reason as feedback, and the skill is not started.

    Args:
        action_name: the action's name in the knowledge base.
        skill: how the action is carried out.
        name: the behaviour's name in the tree; by default the action's.
        preference: the measure whose estimations are to decide between configurations.
    """

    def __init__(
        self,
        action_name: str,
        skill: Skill | None = None,
        *,
        name: str | None = None,
        preference: str | None = None,
    ) -> None:
        super().__init__(name or action_name, action_name)
        self.skill = skill
        self.preference = preference
        self._started = False
        self._refusal: str | None = None

    def on_start(self) -> None:
        """Begin; by default starts the skill."""
        if self.skill is not None:
            self.skill.start()

    def on_running(self) -> Status:
        """Go on: RUNNING, SUCCESS or FAILURE; by default asks the skill."""
        if self.skill is None:
            raise TypeError(f"'{self.name}' has no skill, and {type(self).__name__} does not define on_running()")
        return _STATUS[self.skill.update()]

    def on_halted(self) -> None:
        """Clean up after an interruption. A skill is stopped here and when it has ended by itself."""
        if self.skill is not None:
            self.skill.stop()

    def initialise(self) -> None:
        """Request the action; py_trees calls this."""
        self._refusal = None
        if not self.kb.is_action_feasible(self.action_name):
            self._refused(f"the request would be refused: {self.kb.explain('action', self.action_name).summary}")
            return
        self.requests.request(self.action_name, preference=self.preference, refused=self._refused)
        if self._refusal is None:
            self._started = True
            self.on_start()

    def update(self) -> Status:
        """Go on, unless the request was refused; py_trees calls this."""
        if self._refusal is not None:
            self.feedback_message = self._refusal
            return Status.FAILURE
        self.feedback_message = f"performing {self.action_name}"
        return self.on_running()

    def terminate(self, new_status: Status) -> None:
        """Finish or cancel the action; py_trees calls this, also on behaviours that ended long ago."""
        if not self._started:
            return
        self._started = False
        if new_status is Status.INVALID:
            self.on_halted()
            self.requests.cancel(self.action_name)
            self.feedback_message = f"{self.action_name} was interrupted"
            return
        if self.skill is not None:
            self.skill.stop()
        completed = new_status is Status.SUCCESS
        self.requests.finish(self.action_name, Result.COMPLETED if completed else Result.FAILED)
        self.feedback_message = f"{self.action_name} {'completed' if completed else self._refusal or 'failed'}"

    def _refused(self, reason: str) -> None:
        self._refusal = reason
