"""How the robot's actions are carried out; the nodes do the work, a skill knows when it is done."""

from __future__ import annotations

from suave.robot import SuaveRobot
from task_layer.skill import Skill, SkillStatus


class StartRobot(Skill):
    """Arm the thrusters and go to GUIDED mode: the mission begins."""

    def __init__(self, robot: SuaveRobot) -> None:
        self._robot = robot

    def start(self) -> None:
        """Arm, then follow setpoints."""
        self._robot.arm()
        self._robot.set_guided()

    def update(self) -> SkillStatus:
        """Done at once."""
        return SkillStatus.SUCCESS


class SearchPipeline(Skill):
    """Search until the pipeline is found."""

    def __init__(self, robot: SuaveRobot) -> None:
        self._robot = robot

    def update(self) -> SkillStatus:
        """Done once the pipeline has been seen."""
        return SkillStatus.SUCCESS if self._robot.pipeline_found else SkillStatus.RUNNING


class InspectPipeline(Skill):
    """Follow the pipeline to its end and back."""

    def __init__(self, robot: SuaveRobot) -> None:
        self._robot = robot

    def update(self) -> SkillStatus:
        """Done once the whole path has been followed."""
        return SkillStatus.SUCCESS if self._robot.pipeline_inspected else SkillStatus.RUNNING


class Recharge(Skill):
    """Fly to the station and recharge."""

    def __init__(self, robot: SuaveRobot) -> None:
        self._robot = robot
        self._charges = 0

    def start(self) -> None:
        """Note how often the battery was recharged before."""
        self._charges = self._count()

    def update(self) -> SkillStatus:
        """Done once the battery was recharged since the start."""
        return SkillStatus.SUCCESS if self._count() > self._charges else SkillStatus.RUNNING

    def _count(self) -> int:
        return 0 if self._robot.battery is None else self._robot.battery.charges


def make_skills(robot: SuaveRobot) -> dict[str, Skill]:
    """The skills of the actions that the knowledge models have, by the actions' names."""
    skills: dict[str, Skill] = {"search_pipeline": SearchPipeline(robot), "inspect_pipeline": InspectPipeline(robot)}
    return skills if not robot.with_battery else {**skills, "recharge": Recharge(robot)}
