"""The baseline of the ROSA paper: one managing behaviour tree with the adaptation logic in it, over system modes."""

from __future__ import annotations

import math
from importlib.resources import as_file, files

import py_trees
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from suave.managers.manager import ManagedMission, call_periodically
from suave.managers.modes import mode_manager
from suave.managers.situation import Situation, observed
from suave.managers.system_modes import ModeManager
from suave.robot import SuaveRobot
from task_layer.bt import Condition, InstantAction, SkillAction, TreeRunner

BT_PERIOD = 0.1
"""Seconds between ticks."""
