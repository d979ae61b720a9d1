"""What all blocks of a robot know (RoCS paper, sections 4.2 and 5.1): world, robot, strategies and reactions."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from rosa_reflexes.rocs.actions import Activity
from rosa_reflexes.rocs.touchpoints import Actuator, Sensor


@dataclass(frozen=True, slots=True)
class Fact:
    """Something that is known of the world, since a time in s, and by which robot it was found out."""

    value: Any
    time: float
    source: str


class WorldModel:
    """Facts about the world by name. Of two the newer counts, and at the same time the one of the source that comes
    last in the alphabet: robots that exchange their facts agree in the end, in whatever order these arrive.

    Args:
        source: the robot's name.
    """

    def __init__(self, source: str = "") -> None:
        self._source = source
        self._facts: dict[str, Fact] = {}
        self._lock = threading.Lock()

    def set(self, name: str, value: Any, time: float) -> None:
        """The robot has found something out, at a time in s."""
        self.merge({name: Fact(value, time, self._source)})

    def get(self, name: str, default: Any = None) -> Any:
        """What is known."""
        fact = self._facts.get(name)
        return default if fact is None else fact.value

    def facts(self) -> dict[str, Fact]:
        """All of it, to be sent to other robots."""
        with self._lock:
            return dict(self._facts)

    def merge(self, facts: Mapping[str, Fact]) -> None:
        """Learn what another robot knows."""
        with self._lock:
            for name, fact in facts.items():
                known = self._facts.get(name)
                if known is None or (known.time, known.source) < (fact.time, fact.source):
                    self._facts[name] = fact


class RobotModel:
    """The robot's sensors and actuators, and where it is.

    Args:
        sensors: all of them.
        actuators: all of them.

    Attributes:
        pose: x and y in m and the heading in rad, as the robot believes them to be.
    """

    def __init__(self, sensors: Sequence[Sensor[Any]], actuators: Sequence[Actuator[Any]]) -> None:
        self.sensors = {sensor.name: sensor for sensor in sensors}
        self.actuators = {actuator.name: actuator for actuator in actuators}
        self.pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
        self.names = [*(one.name for one in sensors), *(one.name for one in actuators)]


@dataclass
class StrategyModel:
    """Strategies by name, from which the block Plan may choose."""

    strategies: Mapping[str, Any] = field(default_factory=dict)


class ReactiveModel(ABC):
    """A part of the robot's reactive behaviour: a fixed mapping from what sensors say to an action.

    Args:
        name: unique in its robot.
        sensors: what it reads.
        period: every how many seconds it runs.
        priority: of its actions; must be above the plan's.
    """

    def __init__(self, name: str, sensors: Iterable[Sensor[Any]], *, period: float, priority: float) -> None:
        self.name, self.sensors, self.period, self.priority = name, tuple(sensors), period, priority

    @abstractmethod
    def run(self) -> Activity | None:
        """The action that what the sensors say calls for; None: none."""


@dataclass
class Knowledge:
    """The four models; there is one for each robot."""

    robot: RobotModel
    world: WorldModel = field(default_factory=WorldModel)
    strategy: StrategyModel = field(default_factory=StrategyModel)
    reactive: tuple[ReactiveModel, ...] = ()
