"""The control nodes of BehaviorTree.CPP v4 that choose one of several branches, as py_trees composites."""

from __future__ import annotations

from collections.abc import Sequence as Children

from py_trees import composites
from py_trees.behaviour import Behaviour

from task_layer.bt.engine.node import Flow, Node
from task_layer.bt.engine.outcome import FAILURE, RUNNING, SKIPPED, SUCCESS
from task_layer.bt.ports.parameter import Parameter, value_of


class IfThenElse(Node, composites.Composite):
    """Ticks the second child if the first succeeds, the third if it fails; the choice holds until the branch ends.

    FAILURE if the first child fails and there is no third.

    Args:
        name: the node's name in the tree.
        children: two or three: the condition, the branch if it succeeds, the branch if it fails.

    Raises:
        ValueError: when it is ticked, if there are fewer or more children.
    """

    _branch = 0

    def flow(self) -> Flow:
        """Tick the condition unless a branch is running, then the branch."""
        _check_branches(self)
        self.status = RUNNING
        if self._branch == 0:
            outcome = yield self.children[0]
            if outcome is SUCCESS:
                self._branch = 1
            elif outcome is FAILURE and len(self.children) == 3:
                self._branch = 2
            else:
                return outcome
        outcome = yield self.children[self._branch]
        if outcome is not RUNNING:
            self.halt_children()
            self._branch = 0
        return outcome

    def reset(self) -> None:
        """Discard the choice."""
        self._branch = 0


class WhileDoElse(Node, composites.Composite):
    """Ticks the second child while the first succeeds, the third while it fails; the first is ticked at every tick.

    Args:
        name: the node's name in the tree.
        children: two or three: the condition, the branch while it succeeds, the branch while it fails.

    Raises:
        ValueError: when it is ticked, if there are fewer or more children.
    """

    def flow(self) -> Flow:
        """Tick the condition, halt the branch that is no longer chosen, and tick the other."""
        _check_branches(self)
        self.status = RUNNING
        condition, *branches = self.children
        outcome = yield condition
        if outcome is RUNNING or outcome is SKIPPED:
            return outcome
        chosen = 0 if outcome is SUCCESS else 1
        if len(branches) == 2:
            self.halt_child(branches[1 - chosen])
        if chosen < len(branches):
            outcome = yield branches[chosen]
        if outcome is not RUNNING:
            self.halt_children()
        return outcome


class Switch(Node, composites.Composite):
    """Ticks the child whose case equals the variable's value, and the last child if no case does.

    Args:
        name: the node's name in the tree.
        children: one for each case, and a last one for any other value.
        variable: the value that is compared; None for no value.
        cases: the values to compare with, in order; texts of numbers are compared as numbers.

    Raises:
        ValueError: when it is ticked, if there is not one child more than there are cases.
    """

    def __init__(
        self,
        name: str,
        children: Children[Behaviour] | None = None,
        *,
        variable: Parameter[object],
        cases: Children[Parameter[object]],
    ) -> None:
        super().__init__(name, children)
        self.variable = variable
        self.cases = tuple(cases)
        self._running: Behaviour | None = None

    def flow(self) -> Flow:
        """Choose a child, halt the one chosen before if it is another, and tick."""
        if len(self.children) != len(self.cases) + 1:
            raise ValueError(
                f"'{self.name}' has {len(self.children)} children for {len(self.cases)} cases and the default"
            )
        chosen = self.children[self._matching()]
        if self._running is not None and self._running is not chosen:
            self.halt_child(self._running)
        outcome = yield chosen
        self._running = chosen if outcome is RUNNING else None
        if outcome is SUCCESS or outcome is FAILURE:
            self.halt_children()
        return outcome

    def reset(self) -> None:
        """Discard the choice."""
        self._running = None

    def _matching(self) -> int:
        value = value_of(self.variable)
        if value is not None:
            for index, case in enumerate(self.cases):
                if _same(value, value_of(case)):
                    return index
        return len(self.cases)


def _check_branches(node: Node) -> None:
    if len(node.children) not in (2, 3):
        raise ValueError(f"'{node.name}' must have two or three children, not {len(node.children)}")


def _same(one: object, other: object) -> bool:
    if str(one) == str(other):
        return True
    try:
        return float(str(one)) == float(str(other))
    except ValueError:
        return False
