"""What a behaviour tree that cannot go on is waiting for."""

from __future__ import annotations

from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from rosa_core import KnowledgeBase
from task_layer.bt.leaves.rosa_action import RosaAction
from task_layer.bt.leaves.rosa_leaf import RosaLeaf


@dataclass(frozen=True, slots=True)
class UnfeasibleAction:
    """An action that a mission would perform if it were feasible.

    Attributes:
        action: its name in the knowledge base.
        reason: why it is unfeasible.
        remedies: what would have to change, all of it, for it to be feasible; empty if nothing that is known would do.
    """

    action: str
    reason: str
    remedies: tuple[str, ...]


def unfeasible_actions(root: Behaviour, kb: KnowledgeBase, since: float) -> tuple[UnfeasibleAction, ...]:
    """The actions that a tree asked for and found unfeasible, in the order of the tree; none if it performs another.

    Args:
        root: the tree, before it is halted.
        kb: its knowledge base.
        since: what the tree found before this time of its clock, in s, does not count.
    """
    found: dict[str, None] = {}
    for leaf in _in_order(root):
        if isinstance(leaf, RosaAction) and leaf.status is Status.RUNNING:
            return ()
        if isinstance(leaf, RosaLeaf) and leaf.found_unfeasible_at is not None and leaf.found_unfeasible_at >= since:
            found[leaf.action_name] = None
    return tuple(_explained(action, kb) for action in found if not kb.is_action_feasible(action))


def _explained(action: str, kb: KnowledgeBase) -> UnfeasibleAction:
    return UnfeasibleAction(action, kb.why("action", action), tuple(map(str, kb.explain("action", action).remedies)))


def _in_order(root: Behaviour) -> list[Behaviour]:
    found, to_do = [], [root]
    while to_do:
        node = to_do.pop()
        found.append(node)
        to_do.extend(reversed(node.children))
    return found
