"""The missions' trees, as the ROSA paper draws and counts them."""

from __future__ import annotations

import numpy as np
import py_trees
import pytest

from rosa_core import SimulationClock
from suave.mission_config import MissionConfig
from suave.missions.trees import extended_mission, plain_mission
from suave.robot import SuaveRobot
from task_layer.bt import IsActionFeasible, ReactiveSequence, RosaAction, SkillAction


def robot() -> SuaveRobot:
    return SuaveRobot(SimulationClock(), MissionConfig(), np.random.default_rng(0), with_battery=True)


def guarded(action: str) -> py_trees.behaviour.Behaviour:
    return ReactiveSequence(action, [IsActionFeasible(action), RosaAction(action)])


@pytest.mark.parametrize(("mission", "managed", "bare"), [(plain_mission, 14, 10), (extended_mission, 22, 16)])
def test_the_trees_have_as_many_nodes_as_the_papers(mission, managed: int, bare: int) -> None:
    assert len(list(mission(robot(), guarded).iterate())) == managed
    assert len(list(mission(robot(), SkillAction).iterate())) == bare


def test_the_tree_can_be_drawn() -> None:
    shown = py_trees.display.unicode_tree(extended_mission(robot(), guarded))
    for name in ("is_mission_aborted", "arm_thrusters", "set_guided_mode", "recharge", "is_pipeline_inspected"):
        assert name in shown
