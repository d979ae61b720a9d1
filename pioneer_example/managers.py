"""Managing systems of the Pioneer besides ``rosa``: one route alone, both as published, and both with the gate."""

from __future__ import annotations

import math

from pioneer_example.blocks import pioneer_blocks
from pioneer_example.robot import PioneerRobot
from pioneer_example.skills import GO_TO_ORIGIN
from rosa_reflexes.rocs import EventRunner, PublishedLoop
from rosa_simulation.mission import Mission
from task_layer.bt import SkillAction, TreeRunner
from task_layer.skill import WaitUntil


def deliberative_manager(mission: Mission) -> TreeRunner:
    """The paper's program without its reactive model: it goes to the origin whatever is in the way."""
    robot = _driven_directly(mission)
    EventRunner(pioneer_blocks(robot, reactive=False), robot.clock).start()
    return _until_over(mission)


def reactive_manager(mission: Mission) -> TreeRunner:
    """The paper's reactive model without a plan: it wanders, and avoids what is near."""
    robot = _driven_directly(mission)
    EventRunner(pioneer_blocks(robot, deliberative=False), robot.clock).start()
    return _until_over(mission)


def rocs_manager(mission: Mission) -> TreeRunner:
    """The paper's program as it was published: sleeping threads, and a pipeline that holds one action."""
    robot = _driven_directly(mission)
    rng = mission.simulation.manager_rng
    PublishedLoop(pioneer_blocks(robot), robot.clock, phase=lambda: float(rng.uniform(0.0, 0.05))).start()
    return _until_over(mission)


def gate_manager(mission: Mission) -> TreeRunner:
    """The same plan, to go to the origin, through the command gate; no knowledge base."""
    _robot(mission).set_up()
    return mission.runner(SkillAction(GO_TO_ORIGIN, mission.skills[GO_TO_ORIGIN]))


def _robot(mission: Mission) -> PioneerRobot:
    robot = mission.robot
    if not isinstance(robot, PioneerRobot):
        raise TypeError("this managing system is for the Pioneer")
    return robot


def _driven_directly(mission: Mission) -> PioneerRobot:
    robot = _robot(mission)
    robot.bypass_gate()
    robot.set_up()
    return robot


def _until_over(mission: Mission) -> TreeRunner:
    robot = mission.robot
    return mission.runner(SkillAction("drive", WaitUntil(lambda: robot.over)), period=math.inf)
