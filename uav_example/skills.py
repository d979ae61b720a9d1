"""How the robot's actions are carried out; the nodes do the work, a skill knows when it is done."""

from __future__ import annotations

from task_layer.skill import Skill, SkillStatus, WaitUntil
from uav_example.robot import UavRobot
from uav_example.world.area import Analysis, Sample

SEARCH = "search"
ANALYZE = "analyze"
ANALYZE_IN_SITU = "analyze_in_situ"
RETURN_BASE = "return_base"
LAND_FOLD = "land_fold"


class AnalyzeSample(Skill):
    """Analyse the sample that was waiting when the skill was started; fails if there was none.

    Args:
        robot: whose world says which sample is waiting.
        analysis: the way in which this skill analyses it.
    """

    def __init__(self, robot: UavRobot, analysis: Analysis) -> None:
        self._robot = robot
        self._analysis = analysis
        self._sample: Sample | None = None

    def start(self) -> None:
        """Note which sample is waiting."""
        self._sample = self._robot.world.waiting

    def update(self) -> SkillStatus:
        """Done once that sample was analysed in this way."""
        if self._sample is None:
            return SkillStatus.FAILURE
        done = self._robot.world.analyses.get(self._sample.number) is self._analysis
        return SkillStatus.SUCCESS if done else SkillStatus.RUNNING


def make_skills(robot: UavRobot) -> dict[str, Skill]:
    """The skills by the names of their actions in the knowledge model."""
    world, base = robot.world, (0.0, 0.0, robot.world.parameters.home_height)
    return {
        SEARCH: WaitUntil(lambda: world.waiting is not None or robot.search.done),
        ANALYZE: AnalyzeSample(robot, Analysis.PICKED_UP),
        ANALYZE_IN_SITU: AnalyzeSample(robot, Analysis.IN_SITU),
        RETURN_BASE: WaitUntil(lambda: world.battery.full and world.aircraft.position == base),
        LAND_FOLD: WaitUntil(lambda: world.aircraft.landed and world.gripper.folded),
    }
