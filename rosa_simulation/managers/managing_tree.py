"""The baseline of the ROSA paper: one managing behaviour tree with the adaptation logic in it, over system modes."""

from __future__ import annotations

import math

from py_trees.behaviour import Behaviour

from rosa_simulation.managers.modes import mode_control, mode_manager, observed
from rosa_simulation.mission import Mission
from rosa_simulation.system_modes import ModeManager, Situation
from task_layer.bt import TreeRunner, load_tree

BT_PERIOD = 0.1
"""Seconds between two ticks."""


def bt_manager(mission: Mission) -> TreeRunner:
    """The managing tree (ROSA paper, figure 9), ticked at 10 Hz: what changes is found out by asking at every tick.

    It is also ticked at once when a node with memory goes on to its next child, and when an action of the robot ends.
    """
    tree = load_managing_tree(mission, observed(mission), mode_manager(mission))
    runner = mission.runner(tree, period=math.inf)
    mission.call_every(BT_PERIOD, runner.wake)
    return runner


def load_managing_tree(mission: Mission, situation: Situation, modes: ModeManager) -> Behaviour:
    """The managing tree of a mission.

    Its leaves are those of the mission, ``change_mode`` (ports ``node_name`` and ``mode_name``), and the conditions of
    the robot's :class:`~rosa_simulation.system_modes.ModeControl`.

    Args:
        mission: whose robot is managed.
        situation: what its conditions ask.
        modes: changes the modes.

    Raises:
        ValueError: if the robot's mode control names no managing tree.
    """

    def change_mode(node_name: str, mode_name: str) -> bool:
        return modes.change_mode(node_name, mode_name)

    control = mode_control(mission)
    if control.tree_file is None:
        raise ValueError("this robot has no managing tree")
    registry = mission.unguarded_leaves().add("change_mode", change_mode)
    for name, condition in control.conditions(situation).items():
        registry.add(name, condition)
    for action, skill in mission.skills.items():
        registry.add(action, skill, request=False)
    return load_tree(control.tree_file, registry)
