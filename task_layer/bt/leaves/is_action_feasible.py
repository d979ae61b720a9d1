"""The condition in front of an action (ROSA paper, figure 5)."""

from __future__ import annotations

from py_trees.common import Status

from task_layer.bt.leaves.rosa_leaf import RosaLeaf


class IsActionFeasible(RosaLeaf):
    """SUCCESS if an action is feasible, FAILURE if not; the feedback message has the reason (ROSA paper, figure 5).

    Args:
        action_name: the action's name in the knowledge base.
        name: the behaviour's name in the tree.
    """

    def __init__(self, action_name: str, name: str = "IsActionFeasible") -> None:
        super().__init__(name)
        self.action_name = action_name

    def update(self) -> Status:
        """Ask the knowledge base.

        Raises:
            RuntimeError: before ``tree.setup(kb=kb)``.
        """
        if self.kb.is_action_feasible(self.action_name):
            self.feedback_message = f"{self.action_name} is feasible"
            self.found_unfeasible_at = None
            return Status.SUCCESS
        self.feedback_message = self.why_unfeasible()
        return Status.FAILURE
