"""``rosa check --mission``: checks a mission against its knowledge model."""

from __future__ import annotations

import sys
from pathlib import Path

from rosa_cli.options import TreeOptions
from rosa_core import InputError, KnowledgeModel
from rosa_simulation.scenario import find_scenario
from task_layer.bt.mission_check import check_mission


def check_mission_file(mission: Path, files: list[Path], options: TreeOptions, *, scenario: str | None) -> str:
    """A line that the mission can be run; warnings go to standard error.

    Raises:
        InputError: if it cannot be run, with all reasons.
    """
    leaves = None if scenario is None else find_scenario(scenario).mission_leaves()
    findings = check_mission(
        mission,
        KnowledgeModel.load(*files),
        leaves,
        tree=options.tree,
        nodes=options.nodes or (),
        ros_packages=options.packages(),
    )
    for warning in findings.warnings:
        print(f"warning: {warning}", file=sys.stderr)
    if findings.problems:
        raise InputError(findings.problems)
    count = len(findings.warnings)
    return f"ok: a mission of {findings.nodes} nodes, {count or 'no'} warning{'' if count == 1 else 's'}"
