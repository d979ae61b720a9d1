"""What the leaves that talk to the knowledge base have in common."""

from __future__ import annotations

from typing import Any

from rosa_core import KnowledgeBase
from task_layer.action_requests import ActionRequests
from task_layer.bt.engine.failing import Leaf


class RosaLeaf(Leaf):
    """A leaf about one action of the knowledge base; ``tree.setup(kb=kb)`` connects it."""

    action_name: str
    found_unfeasible_at: float | None = None
    """The time of the tree's clock, in s, at which the action was last found unfeasible; None: it was feasible then."""
    _requests: ActionRequests | None = None
    _known_reason: tuple[int, str] | None = None

    def setup(self, **kwargs: Any) -> None:
        """Connect to the knowledge base.

        Args:
            kb: the :class:`~rosa_core.KnowledgeBase`.
            action_requests: an :class:`~task_layer.action_requests.ActionRequests`, if requests are to be collected
                (the runner passes one); without it they are made at once.

        Raises:
            UnknownElementError: if the knowledge base has no such action.
            RuntimeError: if there is neither ``kb`` nor ``action_requests``.
        """
        super().setup(**kwargs)
        requests = kwargs.get("action_requests")
        if requests is None:
            if "kb" not in kwargs:
                raise RuntimeError(f"'{self.name}' needs the knowledge base: tree.setup(kb=kb)")
            requests = ActionRequests(kwargs["kb"])
        requests.kb.is_action_feasible(self.action_name)
        self._requests = requests

    @property
    def requests(self) -> ActionRequests:
        """The way to the knowledge base.

        Raises:
            RuntimeError: before setup.
        """
        if self._requests is None:
            raise RuntimeError(f"'{self.name}' was ticked before setup; call tree.setup(kb=kb) first")
        return self._requests

    @property
    def kb(self) -> KnowledgeBase:
        """The knowledge base."""
        return self.requests.kb

    def why_unfeasible(self) -> str:
        """Why the action is unfeasible, which this notes; as long as nothing has changed it is not asked again."""
        self.found_unfeasible_at = self.tick_context.clock.now()
        revision = self.kb.revision
        if self._known_reason is None or self._known_reason[0] != revision:
            self._known_reason = (revision, self.kb.why("action", self.action_name))
        return self._known_reason[1]
