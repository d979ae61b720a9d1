"""What the robot has learnt from its reflexes about the way to the origin."""

from __future__ import annotations

import math

from pioneer_example.robot import PioneerRobot
from pioneer_example.world.arena import RADIUS
from pioneer_example.world.geometry import bearing
from rosa_reflexes import HandedBack, Preempted

Point = tuple[float, float]
_BESIDE = RADIUS + 0.2
_ASIDE = 0.75
"""How far beside an obstacle the detour leads, m."""

_RECENT, _OFTEN = 12.0, 3
"""Reflexes do not get past an obstacle that takes the command so often in so many seconds."""


class Way:
    """Where something stands on the straight way, if anything does.

    Args:
        robot: whose way it is.
    """

    def __init__(self, robot: PioneerRobot) -> None:
        self._robot = robot
        self._obstacle: Point | None = None
        self._side = 1.0
        self._times: list[float] = []

    def preempted(self, event: Preempted) -> None:
        """Something is ahead: note where."""
        if event.reflex != "keep clear":
            return
        self._times = [time for time in self._times if event.time - time < _RECENT] + [event.time]
        x, y, heading = self._robot.pose
        ahead = max(self._robot.gate.readings["range.front"], 0.0) + RADIUS
        self._obstacle = (x + ahead * math.cos(heading), y + ahead * math.sin(heading))

    def handed_back(self, _event: HandedBack) -> None:
        """The reflex has turned to the freer side; that is where the detour is to lead."""
        self._side = 1.0 if bearing(self._robot.pose, 0.0, 0.0) < 0.0 else -1.0

    @property
    def is_blocked(self) -> bool:
        """Whether the obstacle stands between the robot and the origin, and the reflexes do not get past it."""
        if self._obstacle is None or len(self._times) < _OFTEN:
            return False
        x, y, _ = self._robot.pose
        distance = math.hypot(x, y)
        dx, dy = -x / distance, -y / distance
        along = (self._obstacle[0] - x) * dx + (self._obstacle[1] - y) * dy
        beside = (self._obstacle[0] - x) * dy - (self._obstacle[1] - y) * dx
        return 0.0 < along < distance and abs(beside) < _BESIDE

    def detour(self) -> Point:
        """A place beside the obstacle, on the side to which the reflex turned."""
        x, y, _ = self._robot.pose
        ox, oy = self._obstacle or (x, y)
        distance = math.hypot(x, y) or 1.0
        dx, dy = -x / distance, -y / distance
        return ox - self._side * dy * _ASIDE, oy + self._side * dx * _ASIDE

    def clear(self) -> None:
        """Nothing is known of the way any more."""
        self._obstacle = None
        self._times.clear()
