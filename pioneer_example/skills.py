"""How the robot's actions are carried out: it drives through the command gate, and pauses while a reflex commands."""

from __future__ import annotations

import math
from collections.abc import Callable

from pioneer_example.robot import PioneerRobot
from pioneer_example.way import Point, Way
from pioneer_example.world.arena import AXLE
from pioneer_example.world.geometry import bearing
from rosa_core.clock import Timer
from rosa_reflexes import HandedBack, Preempted
from rosa_simulation.preemptions import Preemptions
from task_layer.skill import Skill, SkillStatus

GO_TO_ORIGIN, TAKE_DETOUR = "go_to_origin", "take_detour"
_PERIOD = 0.1
_TURN_ON_SPOT = 0.6
_TURN_GAIN, _TURN_FASTEST = 1.5, 1.2
_DETOUR_TIME = 8.0
_DETOUR_PREEMPTIONS = 2


class DriveTo(Skill):
    """Drives to a place; deliberation, so each command comes a while after the pose of which it was made.

    Args:
        robot: what drives.
        preemptions: says when the command is taken.
        target: gives the place when the skill starts.
        tolerance: how near is there, m.
        deliberation_time: from the pose to the command, s.
    """

    def __init__(
        self,
        robot: PioneerRobot,
        preemptions: Preemptions,
        target: Callable[[], Point],
        *,
        tolerance: float,
        deliberation_time: float,
    ) -> None:
        self._robot, self._preemptions, self._target = robot, preemptions, target
        self._tolerance, self._deliberation_time = tolerance, deliberation_time
        self._timer: Timer | None = None
        self._place: Point = (0.0, 0.0)
        self.preempted_times = 0

    def start(self) -> None:
        """Set out."""
        self._place, self.preempted_times = self._target(), 0
        self._preemptions.watch(self)
        clock = self._robot.clock
        self._timer = clock.call_every(_PERIOD, self._decide, start=clock.now())

    def update(self) -> SkillStatus:
        """Done once the robot is there."""
        x, y, _ = self._robot.pose
        near = math.hypot(self._place[0] - x, self._place[1] - y) < self._tolerance
        return SkillStatus.SUCCESS if near else SkillStatus.RUNNING

    def stop(self) -> None:
        """Stand still, as far as it is for this skill to say."""
        self._preemptions.unwatch(self)
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        self._robot.submit(0.0, 0.0, self._robot.gate.epoch)

    def preempted(self, _event: Preempted) -> None:
        """Pause: what is decided now would be refused."""
        self.preempted_times += 1

    def handed_back(self, _event: HandedBack) -> None:
        """Decide anew at once, from where the robot is."""
        self._decide()

    def _decide(self) -> None:
        robot = self._robot
        if robot.gate.holder is not None and self.preempted_times:
            return
        epoch, pose, speed = robot.gate.epoch, robot.pose, robot.speed
        angle = bearing(pose, *self._place)
        turn = max(min(_TURN_GAIN * angle, _TURN_FASTEST), -_TURN_FASTEST) * AXLE / 2.0
        ahead = 0.0 if abs(angle) > _TURN_ON_SPOT else speed * math.cos(angle)

        def submit() -> None:
            if self._timer is not None:
                robot.submit(ahead - turn, ahead + turn, epoch)

        robot.clock.call_later(self._deliberation_time, submit)


class TakeDetour(DriveTo):
    """Drives to a place beside what stands in the way; there or not, the way is tried anew after that."""

    def __init__(self, robot: PioneerRobot, preemptions: Preemptions, way: Way, *, deliberation_time: float) -> None:
        super().__init__(robot, preemptions, way.detour, tolerance=0.25, deliberation_time=deliberation_time)
        self._way = way
        self._until = 0.0

    def start(self) -> None:
        """Set out; there is only so much time for it."""
        self._until = self._robot.clock.now() + _DETOUR_TIME
        super().start()

    def update(self) -> SkillStatus:
        """Failed if reflexes do not let it through."""
        if self.preempted_times > _DETOUR_PREEMPTIONS or self._robot.clock.now() > self._until:
            return SkillStatus.FAILURE
        return super().update()

    def stop(self) -> None:
        """The way is tried anew."""
        super().stop()
        self._way.clear()
