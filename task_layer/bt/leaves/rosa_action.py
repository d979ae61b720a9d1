"""The leaf that performs an action and has the robot configured for it (ROSA paper, section 6.2.5)."""

from __future__ import annotations

from py_trees.common import Status

from rosa_core import Result
from task_layer.action_requests import ActionRequest
from task_layer.bt.leaves.rosa_leaf import RosaLeaf
from task_layer.bt.leaves.skill_action import SkillAction
from task_layer.skill import Skill


class RosaAction(RosaLeaf, SkillAction):
    """Requests its action when it is first ticked, and finishes or cancels it when it ends.

    What the action does is either a :class:`~task_layer.skill.Skill`, or the hooks :meth:`on_start`,
    :meth:`on_running` and :meth:`on_halted` of a subclass. It starts, and goes on for the first time, once the
    knowledge base has accepted the request: with a runner at the end of the tick, without one at once. A request that
    is refused is a FAILURE with the reason as feedback, and the skill is not started.

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
        self._request: ActionRequest | None = None
        self._refusal: str | None = None
        self._waiting = False
        self._early: Status | Exception | None = None

    def initialise(self) -> None:
        """Request the action; py_trees calls this."""
        self._refusal = self._early = self.found_unfeasible_at = None
        self._waiting = False
        self.feedback_message = f"performing {self.action_name}"
        self._request = self.requests.request(
            self.action_name, preference=self.preference, accepted=self._accepted, refused=self._refused
        )

    def update(self) -> Status:
        """Go on, unless the request was refused; RUNNING until it is answered; py_trees calls this."""
        if self._refusal is not None:
            self.feedback_message = self._refusal
            return Status.FAILURE
        early, self._early = self._early, None
        if isinstance(early, Exception):
            raise early
        if early is not None:
            return early
        if not self._started:
            self._waiting = True
            return Status.RUNNING
        return SkillAction.update(self)

    def terminate(self, new_status: Status) -> None:
        """Finish or cancel the action if it was running; py_trees calls this."""
        request, self._request = self._request, None
        if request is None:
            return
        completed = False
        try:
            SkillAction.terminate(self, new_status)
            completed = new_status is Status.SUCCESS
        finally:
            self._end(request, new_status, completed)
        early, self._early = self._early, None
        if isinstance(early, Exception):
            raise early

    def _accepted(self) -> bool:
        """Start; whether it has come to its end already, which the tree has to hear in this tick."""
        try:
            SkillAction.initialise(self)
            if self._waiting:
                status = SkillAction.update(self)
                self._early = None if status is Status.RUNNING else status
        except Exception as error:
            self._early = error
        return self._early is not None

    def _refused(self, reason: str) -> None:
        self._refusal = reason
        self.found_unfeasible_at = self.tick_context.clock.now()

    def _end(self, request: ActionRequest, status: Status, completed: bool) -> None:
        """Report the end to the knowledge base, whatever the hooks and the skill have done."""
        if self._refusal is not None:
            return
        if status is Status.INVALID:
            self.requests.cancel(request)
            self.feedback_message = f"{self.action_name} was interrupted"
            return
        self.requests.finish(request, Result.COMPLETED if completed else Result.FAILED)
        if self.feedback_message == f"performing {self.action_name}":
            self.feedback_message = f"{self.action_name} {'completed' if completed else 'failed'}"
