"""The paper's program for the Pioneer in RoCS blocks (table 1 and figure 5), with the numbers of its source code.

``TurnToPosition``, which table 1 names and defines nowhere, is read as ``TurnToOrigin``. What the source has as
``AvoidWall`` is called ``AvoidCollision``, as in the table. Speeds are those of our robot, so that managers compare.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from pioneer_example.robot import PioneerRobot
from pioneer_example.world.geometry import bearing, wrapped
from pioneer_example.world.sonar_ring import SONARS
from rosa_reflexes.rocs import (
    Action,
    ActionStatus,
    Activity,
    Actuator,
    Analyze,
    Execute,
    Knowledge,
    MacroAction,
    Monitor,
    Pipeline,
    Plan,
    Queued,
    ReactiveModel,
    Robot,
    RobotModel,
    Sensor,
    build_robot,
)

Numbers = tuple[float, ...]

NEAR, MORE_THAN = 0.5, 3
"""It avoids what more than so many of the sonars 2 to 6 hear nearer than this, m."""
AVOIDING_TURN = math.pi / 3.4
AVOIDING_TIME = 0.5
"""How long it drives on after the turn, s."""
_TURN_GAIN, _TURN_FASTEST, _TURN_SLOWEST = 0.35, 0.2, 0.02


class Range(Sensor[float]):
    """A sonar; infinite without an echo."""

    def __init__(self, robot: PioneerRobot, number: int) -> None:
        super().__init__(f"sonar {number}")
        self._robot, self._number = robot, number

    def get_data(self) -> float:
        """The range, m."""
        samples = self._robot.samples
        sample = samples[self._number] if self._number < len(samples) else None
        return math.inf if sample is None else sample


class PositionSensor(Sensor[Numbers]):
    """Knows the true position, m."""

    def __init__(self, robot: PioneerRobot) -> None:
        super().__init__("position")
        self._robot = robot

    def get_data(self) -> Numbers:
        """x and y."""
        return self._robot.pose[:2]


class OrientationSensor(Sensor[float]):
    """Knows the true heading, rad."""

    def __init__(self, robot: PioneerRobot) -> None:
        super().__init__("orientation")
        self._robot = robot

    def get_data(self) -> float:
        """The heading."""
        return self._robot.pose[2]


class Wheel(Actuator[float]):
    """One of the two wheels; commands in m/s."""

    def __init__(self, robot: PioneerRobot, side: int) -> None:
        super().__init__(("left wheel", "right wheel")[side])
        self._robot, self._side = robot, side

    def actuate(self, command: float) -> None:
        """Turn so fast from now on."""
        left, right = self._robot.wheels
        self._robot.set_wheels((command, right) if self._side == 0 else (left, command))


class PioneerP3DXModel(RobotModel):
    """The robot's sixteen sonars, its position and orientation sensors, and its wheels."""

    def __init__(self, robot: PioneerRobot) -> None:
        self.robot = robot
        self.ranges = [Range(robot, number) for number in range(len(SONARS))]
        self.position, self.orientation = PositionSensor(robot), OrientationSensor(robot)
        self.wheels = (Wheel(robot, 0), Wheel(robot, 1))
        super().__init__([*self.ranges, self.position, self.orientation], self.wheels)


class SetWheelSpeed(Action):
    """Sets the wheels' speeds, m/s, and is over after ``hold`` seconds."""

    def __init__(self, model: PioneerP3DXModel, left: float, right: float, hold: float = 0.0) -> None:
        self._model, self._speeds, self._hold = model, (left, right), hold
        self._until = 0.0

    def start(self) -> None:
        """Set them."""
        self._until = self._model.robot.clock.now() + self._hold
        for wheel, speed in zip(self._model.wheels, self._speeds, strict=True):
            wheel.actuate(speed)

    def act(self) -> ActionStatus:
        """Wait until it is over."""
        over = self._model.robot.clock.now() >= self._until - 1e-9
        return ActionStatus.SUCCESS if over else ActionStatus.RUNNING


class TurnAngle(Action):
    """Turns on the spot by an angle, rad, the slower the less is left."""

    def __init__(self, model: PioneerP3DXModel, angle: float, precision: float = 0.05) -> None:
        self._model, self._angle, self._precision = model, angle, precision
        self._target = 0.0

    def start(self) -> None:
        """Note where to."""
        self._target = self._model.orientation.get_data() + self._angle

    def act(self) -> ActionStatus:
        """Turn on."""
        left = wrapped(self._target - self._model.orientation.get_data())
        if abs(left) < self._precision:
            return ActionStatus.SUCCESS
        speed = math.copysign(min(max(_TURN_GAIN * abs(left), _TURN_SLOWEST), _TURN_FASTEST), left)
        self._model.wheels[0].actuate(-speed)
        self._model.wheels[1].actuate(speed)
        return ActionStatus.RUNNING


class TurnToOrigin(MacroAction):
    """Turns until the origin is ahead."""

    def __init__(self, model: PioneerP3DXModel) -> None:
        super().__init__()
        self._model = model

    def decompose(self) -> Sequence[Activity]:
        """One turn."""
        return [TurnAngle(self._model, bearing(self._model.pose, 0.0, 0.0))]


class GoToOrigin(MacroAction):
    """Turns to the origin and drives on."""

    def __init__(self, model: PioneerP3DXModel) -> None:
        super().__init__()
        self._model = model

    def decompose(self) -> Sequence[Activity]:
        """Turn, then drive; how far, the next action decides."""
        speed = self._model.robot.speed
        return [TurnToOrigin(self._model), SetWheelSpeed(self._model, speed, speed)]


class AvoidCollision(MacroAction):
    """Turns away and drives on for a while."""

    def __init__(self, model: PioneerP3DXModel) -> None:
        super().__init__()
        self._model = model

    def start(self) -> None:
        """Stand still first."""
        for wheel in self._model.wheels:
            wheel.actuate(0.0)
        super().start()

    def decompose(self) -> Sequence[Activity]:
        """Turn to the left, then drive."""
        speed = self._model.robot.speed
        return [
            TurnAngle(self._model, AVOIDING_TURN, precision=0.02),
            SetWheelSpeed(self._model, speed, speed, AVOIDING_TIME),
        ]


class RangeMonitor(Monitor[Numbers]):
    """Watches the sonars."""

    def interpret(self) -> Numbers:
        """All ranges, m."""
        return tuple(sensor.get_data() for sensor in self.sensors)


class PositionMonitor(Monitor[Numbers]):
    """Watches the position."""

    def interpret(self) -> Numbers:
        """x and y, m."""
        position: Numbers = self.sensors[0].get_data()
        return position


class OrientationMonitor(Monitor[Numbers]):
    """Watches the heading."""

    def interpret(self) -> Numbers:
        """The heading, rad."""
        return (self.sensors[0].get_data(),)


class PassRange(Analyze[Numbers, Numbers]):
    """Passes the ranges on."""

    def process(self, values: Mapping[str, Numbers]) -> Numbers | None:
        """As they are."""
        return next(iter(values.values()), None)


class PassPosition(Analyze[Numbers, Numbers]):
    """Passes the position on, and notes it in the robot model."""

    def __init__(self, name: str, model: RobotModel) -> None:
        super().__init__(name)
        self._model = model

    def process(self, values: Mapping[str, Numbers]) -> Numbers | None:
        """As it is."""
        position = next(iter(values.values()), None)
        if position is not None:
            self._model.pose = (position[0], position[1], self._model.pose[2])
        return position


class PassOrientation(Analyze[Numbers, Numbers]):
    """Passes the heading on, and notes it in the robot model."""

    def __init__(self, name: str, model: RobotModel) -> None:
        super().__init__(name)
        self._model = model

    def process(self, values: Mapping[str, Numbers]) -> Numbers | None:
        """As it is."""
        heading = next(iter(values.values()), None)
        if heading is not None:
            self._model.pose = (*self._model.pose[:2], heading[0])
        return heading


class GoToOriginPlanner(Plan[Numbers]):
    """Whenever there is nothing to do: go to the origin."""

    def __init__(self, model: PioneerP3DXModel) -> None:
        super().__init__("GoToOriginPlanner", priority=1.0)
        self._model = model

    def run(self, changes: Mapping[str, Numbers]) -> Iterable[Activity]:
        """Go to the origin, once it is known where the robot is."""
        return [GoToOrigin(self._model)] if {"PassPosition", "PassOrientation"} <= changes.keys() else []


class AvoidObstacleModel(ReactiveModel):
    """Avoids what several sonars to the front hear near."""

    def __init__(self, model: PioneerP3DXModel) -> None:
        super().__init__("AvoidObstacleModel", model.ranges[2:7], period=0.05, priority=15.0)
        self._model = model

    def run(self) -> Activity | None:
        """Avoid it."""
        near = sum(sensor.get_data() < NEAR for sensor in self.sensors)
        return AvoidCollision(self._model) if near > MORE_THAN else None


class WanderModel(ReactiveModel):
    """Drives straight on when nothing else is to be done; for a robot without a plan."""

    def __init__(self, model: PioneerP3DXModel) -> None:
        super().__init__("WanderModel", model.ranges, period=0.05, priority=1.0)
        self._model = model

    def run(self) -> Activity | None:
        """Straight on."""
        speed = self._model.robot.speed
        return SetWheelSpeed(self._model, speed, speed)


def pioneer_blocks(robot: PioneerRobot, *, deliberative: bool = True, reactive: bool = True) -> Robot:
    """The paper's program, with both routes or one of them.

    Args:
        robot: whose wheels are driven; not through its gate.
        deliberative: with monitors, analyzes and plan; otherwise it wanders.
        reactive: with the reactive model that avoids obstacles.
    """

    def note(queued: Queued) -> None:
        name = type(queued.activity).__name__
        robot.begin_action(name, reactive=queued.source == "AvoidObstacleModel" or not deliberative)

    model = PioneerP3DXModel(robot)
    models: list[ReactiveModel] = [AvoidObstacleModel(model)] if reactive else []
    execute = Execute(Pipeline(), on_action=note)
    if not deliberative:
        knowledge = Knowledge(model, reactive=(*models, WanderModel(model)))
        return build_robot("pioneer", knowledge, execute)
    plan = GoToOriginPlanner(model)
    ranges = RangeMonitor("RangeMonitor", model.ranges, period=0.05)
    position = PositionMonitor("PositionMonitor", [model.position], period=0.05)
    orientation = OrientationMonitor("OrientationMonitor", [model.orientation], period=0.05)
    pass_range, pass_position = PassRange("PassRange"), PassPosition("PassPosition", model)
    pass_orientation = PassOrientation("PassOrientation", model)
    ranges.attach(pass_range)
    position.attach(pass_position)
    orientation.attach(pass_orientation)
    for analyze in (pass_range, pass_position, pass_orientation):
        analyze.attach(plan)
    knowledge = Knowledge(model, reactive=tuple(models))
    return build_robot("pioneer", knowledge, execute, monitors=[position, orientation, ranges], plan=plan)
