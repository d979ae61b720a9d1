"""The leaf that performs an action and has the robot configured for it (ROSA paper, section 6.2.5)."""

from __future__ import annotations

from py_trees.common import Status

from rosa_core import Result
from task_layer.bt.leaves.rosa_leaf import RosaLeaf
from task_layer.bt.leaves.skill_action import SkillAction
from task_layer.skill import Skill


class RosaAction(RosaLeaf, SkillAction):
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
        SkillAction.__init__(self, name or action_name, skill)
        self.action_name = action_name
        self.preference = preference
        self._refusal: str | None = None

    def initialise(self) -> None:
        """Request the action, and begin it unless it is refused; py_trees calls this."""
        self._refusal = None
        if not self.kb.is_action_feasible(self.action_name):
            self._refuse(self.kb.why("action", self.action_name))
            return
        self.requests.request(self.action_name, preference=self.preference, refused=self._refuse)
        if self._refusal is None:
            self.feedback_message = f"performing {self.action_name}"
            SkillAction.initialise(self)

    def update(self) -> Status:
        """Go on, unless the request was refused; py_trees calls this."""
        if self._refusal is not None:
            self.feedback_message = self._refusal
            return Status.FAILURE
        return SkillAction.update(self)

    def terminate(self, new_status: Status) -> None:
        """Finish or cancel the action if it was running; py_trees calls this."""
        if not self._started:
            return
        completed = False
        try:
            SkillAction.terminate(self, new_status)
            completed = new_status is Status.SUCCESS
        finally:
            self._end(new_status, completed)

    def _end(self, status: Status, completed: bool) -> None:
        """Tell the knowledge base, whatever the hooks and the skill have done."""
        if status is Status.INVALID:
            self.requests.cancel(self.action_name)
            self.feedback_message = f"{self.action_name} was interrupted"
            return
        self.requests.finish(self.action_name, Result.COMPLETED if completed else Result.FAILED)
        if self._refusal is None and self.feedback_message == f"performing {self.action_name}":
            self.feedback_message = f"{self.action_name} {'completed' if completed else 'failed'}"

    def _refuse(self, reason: str) -> None:
        self._refusal = reason
