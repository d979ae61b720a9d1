"""How the robot's actions are carried out, and what it is on its way for."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from agv_example.navigator import Navigator
from agv_example.world import AgvRobot
from task_layer.skill import Skill, SkillStatus

ARRIVE = "arrive"


class GoalQueue:
    """Goals that are to be reached in turn; what was reached the robot knows.

    Args:
        robot: knows what it has reached.
        goals: names of places, in their order; one may come twice.
    """

    def __init__(self, robot: AgvRobot, goals: Sequence[str]) -> None:
        self.goals = tuple(goals)
        self._robot = robot

    @property
    def number(self) -> int:
        """How many goals are reached; the index of the one that is due."""
        return len(self._robot.reached)

    @property
    def due(self) -> str | None:
        """The goal to go to now; None when all are reached."""
        return None if self.number >= len(self.goals) else self.goals[self.number]

    @property
    def done(self) -> bool:
        """Whether all goals are reached."""
        return self.due is None

    def arrive(self) -> bool:
        """Report that the goal is reached; False if the robot is not there."""
        goal = self.due
        if goal is None or not self._robot.is_at(goal):
            return False
        self._robot.arrive(goal)
        return True


class Arrive(Skill):
    """Report that the goal which is due is reached; fails anywhere else."""

    def __init__(self, goal_queue: GoalQueue) -> None:
        self._goal_queue = goal_queue

    def update(self) -> SkillStatus:
        """Done at once."""
        return SkillStatus.SUCCESS if self._goal_queue.arrive() else SkillStatus.FAILURE


class Navigate(Skill):
    """Drive the best way to a goal.

    Args:
        navigator: knows the way.
        robot: the robot.
        goal: says which goal is due; None: no more.
        until: the place on the way where this drive ends; by default the goal.
    """

    def __init__(
        self,
        navigator: Navigator,
        robot: AgvRobot,
        goal: Callable[[], str | None],
        *,
        until: str | None = None,
    ) -> None:
        self._navigator, self._robot, self._goal = navigator, robot, goal
        self._until = until

    def update(self) -> SkillStatus:
        """Done once the robot is there; failed when there is no way."""
        goal = self._goal()
        place = goal if self._until is None else self._until
        if goal is None or place is None or self._robot.is_at(place):
            return SkillStatus.SUCCESS
        if not self._navigator.has_way(goal) or not self._navigator.leads_to(place):
            return SkillStatus.FAILURE
        self._navigator.follow()
        return SkillStatus.RUNNING

    def stop(self) -> None:
        """Stand still."""
        self._navigator.halt()
