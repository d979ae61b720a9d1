"""The arena as plane geometry: robots are circles that go where their wheels say, and stop at what they touch."""

from __future__ import annotations

import math
from collections.abc import Mapping

from pioneer_example.world.arena import AXLE, RADIUS, Arena
from pioneer_example.world.backend import Wheels, ramped
from pioneer_example.world.geometry import Circle, Pose, Rectangle
from pioneer_example.world.sonar_ring import MOUNT, RAYS, heard

_STEP = 0.005


class KinematicBackend:
    """Robots without mass.

    Args:
        arena: what there is.
    """

    def __init__(self, arena: Arena) -> None:
        self._obstacles = arena.obstacles
        self._poses = dict(arena.starts)
        self._wheels: dict[str, Wheels] = dict.fromkeys(arena.starts, (0.0, 0.0))
        self._touching = dict.fromkeys(arena.starts, False)

    def step(self, seconds: float, commands: Mapping[str, Wheels]) -> None:
        """Let time pass, in steps of 5 ms."""
        for _ in range(round(seconds / _STEP)):
            for robot, command in commands.items():
                self._wheels[robot] = ramped(self._wheels[robot], command, _STEP)
                self._move(robot)

    def pose(self, robot: str) -> Pose:
        """Where a robot is."""
        return self._poses[robot]

    def ranges(self, robot: str) -> list[float]:
        """By rays to all obstacles and the other robot."""
        x, y, heading = self._poses[robot]
        around = self._around(robot)
        rays = []
        for angle in RAYS:
            cos, sin = math.cos(heading + angle), math.sin(heading + angle)
            at = x + MOUNT * cos, y + MOUNT * sin
            rays.append(min(obstacle.ray(*at, cos, sin) for obstacle in around))
        return heard(rays)

    def touches(self, robot: str) -> bool:
        """Whether it was stopped by something."""
        return self._touching[robot]

    def _around(self, robot: str) -> list[Rectangle | Circle]:
        others = [Circle(pose[0], pose[1], RADIUS) for name, pose in self._poses.items() if name != robot]
        return [*self._obstacles, *others]

    def _move(self, robot: str) -> None:
        x, y, heading = self._poses[robot]
        left, right = self._wheels[robot]
        speed, turn = (left + right) / 2.0, (right - left) / AXLE
        heading += turn * _STEP
        to = x + speed * math.cos(heading) * _STEP, y + speed * math.sin(heading) * _STEP
        around = self._around(robot)
        before = min(obstacle.distance(x, y) for obstacle in around)
        after = min(obstacle.distance(*to) for obstacle in around)
        hit = after < RADIUS and after < before
        self._touching[robot] = hit
        if hit:
            self._wheels[robot] = (0.0, 0.0) if left * right > 0.0 else (left, right)
        self._poses[robot] = (x, y, heading) if hit else (*to, heading)
