"""The baseline of the ROSA paper: one managing behaviour tree with the adaptation logic in it, over system modes."""

from __future__ import annotations

import math
from collections.abc import Callable
from importlib.resources import as_file, files
from typing import Any

from py_trees.behaviour import Behaviour

from rosa_simulation.system_modes import ModeManager
from suave.managers.manager import ManagedMission
from suave.managers.modes import mode_manager
from suave.managers.situation import Situation, observed
from suave.missions.leaves import mission_leaves
from task_layer.bt import TreeRunner, load_tree

BT_PERIOD = 0.1
"""Seconds between two ticks."""


def bt_manager(mission: ManagedMission) -> TreeRunner:
    """The managing tree (ROSA paper, figure 9), ticked at 10 Hz: what changes is found out by asking at every tick.

    It is also ticked at once when a node with memory goes on to its next child, and when an action of the robot ends.
    """
    tree = load_managing_tree(mission, observed(mission), mode_manager(mission))
    runner = mission.runner(tree, period=math.inf)
    mission.call_every(BT_PERIOD, runner.wake)
    return runner


def load_managing_tree(mission: ManagedMission, situation: Situation, modes: ModeManager) -> Behaviour:
    """The managing tree of the plain or the extended mission: 37 or 50 nodes."""
    registry = mission_leaves(mission.robot)
    for name, leaf in _leaves(situation, modes).items():
        registry.add(name, leaf)
    for action in mission.actions:
        registry.add(action, mission.skills[action], request=False)
    name = "suave_extended_bt.xml" if mission.extended else "suave_bt.xml"
    with as_file(files("suave.managers").joinpath(name)) as path:
        return load_tree(path, registry)


def _leaves(situation: Situation, modes: ModeManager) -> dict[str, Callable[..., Any]]:
    """The leaves that adapt, by the names that the exemplar has for them; their parameters are their ports."""

    def change_mode(node_name: str, mode_name: str) -> bool:
        return modes.change_mode(node_name, mode_name)

    def water_visibility(threshold: float) -> bool:
        return situation.reaches("water_visibility", threshold)

    def battery_level(threshold: float) -> bool:
        return situation.reaches("battery_level", threshold)

    return {
        "change_mode": change_mode,
        "water_visibility": water_visibility,
        "battery_level": battery_level,
        "thrusters_ok": lambda: not situation.failed,
    }
