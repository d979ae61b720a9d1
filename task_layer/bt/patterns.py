"""Patterns of nodes for missions on a knowledge base."""

from __future__ import annotations

from task_layer.bt.leaves.is_action_feasible import IsActionFeasible
from task_layer.bt.leaves.rosa_action import RosaAction
from task_layer.bt.nodes.sequential import ReactiveSequence
from task_layer.skill import Skill


def if_feasible(action: str | RosaAction, skill: Skill | None = None, *, name: str | None = None) -> ReactiveSequence:
    """A reactive sequence that performs an action as long as it is feasible (ROSA paper, figure 5).

    The condition is checked at every tick: an action that becomes unfeasible is halted, and the sequence fails.

    Args:
        action: the action's name in the knowledge base, or the leaf that performs it.
        skill: how it is carried out, if only the name is given.
        name: the sequence's name in the tree.

    Returns:
        the sequence of ``IsActionFeasible`` and the action.

    Raises:
        ValueError: if a leaf and a skill are given.

    >>> [child.name for child in if_feasible("recharge").children]
    ['IsActionFeasible', 'recharge']
    """
    if isinstance(action, RosaAction):
        if skill is not None:
            raise ValueError(f"'{action.name}' is a leaf; give it its skill, not the pattern")
        leaf = action
    else:
        leaf = RosaAction(action, skill)
    condition = IsActionFeasible(leaf.action_name)
    return ReactiveSequence(name or f"{leaf.action_name} if feasible", [condition, leaf])
