"""A case done with both trees, and the first difference between them."""

from __future__ import annotations

import dataclasses

from tests.task_layer.oracle.description import Case, to_xml
from tests.task_layer.oracle.ours import NeverReturnsError, run_ours
from tests.task_layer.oracle.theirs import run_theirs
from tests.task_layer.oracle.trace import StepResult


def difference(case: Case) -> str | None:
    """What is different: the tree, the steps before that were the same, and both traces of the one that is not.

    Steps that BehaviorTree.CPP does not get through (see :func:`run_theirs`) are left out.
    """
    try:
        ours = run_ours(case)
    except NeverReturnsError:
        case = case.woken_by_nobody()
        ours = run_ours(case)
    lines = [to_xml(case.root), *_leaves(case)]
    for our, their in zip(ours, run_theirs(case), strict=False):
        if not _same(our, their):
            return "\n".join([*lines, f"ours    {our}", f"BT.CPP  {their}"])
        lines.append(f"both    {our}")
    return None


def _same(ours: StepResult, theirs: StepResult) -> bool:
    known = {name: status for name, status in ours.leaves.items() if name in theirs.leaves}
    return dataclasses.replace(ours, leaves=known) == theirs


def _leaves(case: Case) -> list[str]:
    leaves = [node for node in case.root.nodes() if node.script]
    return [f"{leaf.name}: {leaf.script}{f', {leaf.sets}' if leaf.sets else ''}" for leaf in leaves]
