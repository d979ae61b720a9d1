"""ROSA: the knowledge base infers what is feasible, the adaptation loop configures, the tree chooses the action."""

from __future__ import annotations

from rosa_simulation.mission import Mission
from task_layer.bt import TreeRunner


def rosa_manager(mission: Mission) -> TreeRunner:
    """The mission's tree on a knowledge base."""
    kb = mission.knowledge_base()
    return mission.runner(mission.managed_tree(kb), kb)
