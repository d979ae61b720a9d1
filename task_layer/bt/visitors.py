"""Visitors for py_trees: what they say of a tree whose nodes are idle again as soon as their parent has ended."""

from __future__ import annotations

from uuid import UUID

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.visitors import VisitorBase


class TipVisitor(VisitorBase):
    """Finds the leaf that decided the outcome of the last tick, which ``tip()`` of py_trees gives for its own nodes.

    Here the children of a node that has ended are idle again (INVALID), so that :meth:`Node.tip` ends at that node.
    This visitor sees each node before that happens. Add it to a ``BehaviourTree``, or call :meth:`run` with each node
    that ``root.tick()`` yields, after :meth:`initialise`.

    Attributes:
        tip: the leaf whose outcome came to be that of the root; None before the first tick.
        statuses: the status that each node of the last tick had when it had been ticked, by its ``id``.
        feedback: its feedback message then.

    >>> from py_trees.behaviours import Failure, Success
    >>> from py_trees.trees import BehaviourTree
    >>> from task_layer.bt import Sequence
    >>> tree, visitor = BehaviourTree(Sequence("root", [Success("first"), Failure("second")])), TipVisitor()
    >>> tree.add_visitor(visitor)
    >>> tree.tick()
    >>> tree.root.tip().name, visitor.tip.name, visitor.status.name
    ('root', 'second', 'FAILURE')
    """

    def __init__(self) -> None:
        super().__init__(full=False)
        self.initialise()

    @property
    def status(self) -> Status:
        """The status of :attr:`tip` in the last tick; INVALID before the first."""
        return Status.INVALID if self.tip is None else self.statuses[self.tip.id]

    @property
    def feedback_message(self) -> str:
        """What :attr:`tip` said in the last tick."""
        return "" if self.tip is None else self.feedback[self.tip.id]

    def initialise(self) -> None:
        """Begin a tick; py_trees calls this."""
        self.tip: Behaviour | None = None
        self.statuses: dict[UUID, Status] = {}
        self.feedback: dict[UUID, str] = {}
        self._tips: dict[UUID, Behaviour] = {}
        self._order: dict[UUID, int] = {}
        self._visits = 0

    def run(self, behaviour: Behaviour) -> None:
        """Take note of a node that was ticked; py_trees calls this, for children before their parents."""
        self.statuses[behaviour.id] = behaviour.status
        self.feedback[behaviour.id] = behaviour.feedback_message
        self._visits += 1
        self._order[behaviour.id] = self._visits
        ticked = [child for child in behaviour.children if child.id in self._tips]
        deciding = [child for child in ticked if self.statuses[child.id] is behaviour.status] or ticked
        if deciding:
            last = max(deciding, key=lambda child: self._order[child.id])
            self._tips[behaviour.id] = self._tips[last.id]
        else:
            self._tips[behaviour.id] = behaviour
        self.tip = self._tips[behaviour.id]
