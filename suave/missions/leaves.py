"""What the names of leaves in a mission file stand for; the actions are the managing system's to add."""

from __future__ import annotations

from suave.robot import SuaveRobot
from task_layer.bt import NodeKind, Registry


def mission_leaves(robot: SuaveRobot) -> Registry:
    """A registry with what missions do with the robot itself, and ask of it; names as the exemplar has them.

    The exemplar's own mission files write the same leaves as ``ArmThrusters``, ``SetGuidedMode``, ``IsPipelineFound``.
    """
    registry = Registry()
    for name, act in (("arm_thrusters", robot.arm), ("set_guided_mode", robot.set_guided)):
        for spelling in _spellings(name):
            registry.add(spelling, act)
    for name, holds in (
        ("is_mission_aborted", lambda: robot.over),
        ("is_pipeline_found", lambda: robot.pipeline_found),
        ("is_pipeline_inspected", lambda: robot.pipeline_inspected),
    ):
        for spelling in _spellings(name):
            registry.add(spelling, holds, kind=NodeKind.CONDITION)
    return registry


def _spellings(name: str) -> tuple[str, str]:
    return name, "".join(word.capitalize() for word in name.split("_"))
