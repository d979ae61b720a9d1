"""What it costs to drive a corridor in some configuration, and to get from one configuration to another."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Any

import numpy as np

from agv_example.corridors import Corridor
from agv_example.drive_configurations import DriveConfiguration, DriveOptions

if TYPE_CHECKING:
    from numpy.typing import NDArray

HITS_PER_SAFETY = 0.25
"""Each unit of estimated safety leaves a quarter of the obstacles hit that would have been: an assumption."""


class Criterion(StrEnum):
    """What a route can be judged by; less is better."""

    ENERGY = "energy"
    TIME = "time"
    RISK = "risk"


@dataclass(frozen=True, slots=True)
class Costs:
    """What driving costs.

    Attributes:
        energy: in units of draw times second.
        time: s.
        risk: the expected number of collisions.

    Example:
        >>> Costs(10.0, 2.0) + Costs(5.0, 1.0, 0.5)
        Costs(energy=15.0, time=3.0, risk=0.5)
    """

    energy: float = 0.0
    time: float = 0.0
    risk: float = 0.0

    def __add__(self, other: Costs) -> Costs:
        return Costs(self.energy + other.energy, self.time + other.time, self.risk + other.risk)


def drive_costs(corridor: Corridor, origin: str, configuration: DriveConfiguration) -> Costs | None:
    """Driving the whole corridor from one end; None if it was measured, but not in this configuration.

    Args:
        corridor: to be driven.
        origin: the end from which.
        configuration: of the robot.

    Returns:
        what was measured from that end; without any measurement there, the length at the configuration's speed and the
        obstacles that its safety leaves.

    Example:
        >>> slow = DriveConfiguration("slow", (), (), frozenset(), speed=0.5, energy=2.0, accuracy=1.0, safety=1.0)
        >>> drive_costs(Corridor("C1", "A", "B", length=10.0, obstacles=4), "A", slow)
        Costs(energy=40.0, time=20.0, risk=1.0)
    """
    measured = corridor.measured.get(origin)
    if measured is not None:
        drive = measured.drive(configuration.components, configuration.speed)
        return None if drive is None else Costs(drive.time * configuration.energy, drive.time, drive.hits)
    time = corridor.length / configuration.speed
    return Costs(time * configuration.energy, time, corridor.obstacles * HITS_PER_SAFETY**configuration.safety)


def permits(corridor: Corridor, configuration: DriveConfiguration) -> bool:
    """Whether the configuration is accurate enough and not too fast; light is a matter of what is feasible.

    Args:
        corridor: with the least accuracy, and the speed limit.
        configuration: of the robot.
    """
    limit = corridor.speed_limit
    return configuration.accuracy >= corridor.accuracy and (limit is None or configuration.speed <= limit)


@dataclass(frozen=True, slots=True)
class StartUp:
    """What starting one component takes: seconds, during which the robot stands, and energy. Stopping takes nothing.

    What a reconfiguration costs depends on the number of components that it starts alone, so that a detour by a third
    configuration is never cheaper than the direct way.
    """

    time: float = 0.5
    energy: float = 0.5

    def costs(self, running: frozenset[str], components: frozenset[str]) -> Costs:
        """Of having ``components`` run where ``running`` do.

        Args:
            running: the components that run.
            components: those that are to run; others are stopped, at no cost.

        Example:
            >>> StartUp(time=0.5, energy=2.0).costs(frozenset({"lidar"}), frozenset({"camera", "lamp"}))
            Costs(energy=4.0, time=1.0, risk=0.0)
        """
        started = len(components - running)
        return Costs(self.energy * started, self.time * started, 0.0)


Arc = tuple[Corridor, str]
"""A corridor, and the end from which it is driven."""


@dataclass(frozen=True)
class CostTable:
    """The costs of all arcs (rows) in all configurations (columns); ``allowed`` says which can be had at all."""

    energy: NDArray[np.float64]
    time: NDArray[np.float64]
    risk: NDArray[np.float64]
    allowed: NDArray[np.bool_]

    def of(self, criterion: Criterion) -> NDArray[np.float64]:
        """One of them."""
        columns = {Criterion.ENERGY: self.energy, Criterion.TIME: self.time, Criterion.RISK: self.risk}
        return columns[criterion]

    def costs(self, arc: int, configuration: int) -> Costs:
        """Those of one arc in one configuration.

        Args:
            arc: the row.
            configuration: the column.
        """
        at = (arc, configuration)
        return Costs(float(self.energy[at]), float(self.time[at]), float(self.risk[at]))


def cost_table(arcs: Sequence[Arc], options: DriveOptions) -> CostTable:
    """The same as :func:`drive_costs` and :func:`permits`, for all at once.

    Args:
        arcs: corridors, each with the end from which it is driven.
        options: the configurations, and the light in which each is feasible.

    Returns:
        a row for each arc, a column for each configuration.
    """
    configurations = options.configurations

    def column(figure: Callable[[DriveConfiguration], float]) -> NDArray[np.float64]:
        return np.array([figure(one) for one in configurations], dtype=np.float64)

    def row(figure: Callable[[Corridor], Any]) -> NDArray[np.float64]:
        return np.array([figure(corridor) for corridor, _ in arcs], dtype=np.float64)[:, None]

    speed = column(lambda one: one.speed)
    time = row(lambda corridor: corridor.length) / speed
    energy = time * column(lambda one: one.energy)
    risk = row(lambda corridor: corridor.obstacles) * HITS_PER_SAFETY ** column(lambda one: one.safety)
    allowed = column(lambda one: one.accuracy) >= row(lambda corridor: corridor.accuracy)
    allowed &= speed <= row(lambda corridor: np.inf if corridor.speed_limit is None else corridor.speed_limit)
    allowed &= _lit(arcs, options)
    table = CostTable(energy, time, risk, allowed)
    for number, (corridor, origin) in enumerate(arcs):
        if origin in corridor.measured:
            _fill_measured(table, number, corridor, origin, configurations)
    return table


def _lit(arcs: Sequence[Arc], options: DriveOptions) -> NDArray[np.bool_]:
    """Which configurations are feasible in the light of each arc."""
    rows: dict[float, int] = {}
    which = np.array([rows.setdefault(corridor.light, len(rows)) for corridor, _ in arcs], dtype=np.intp)
    feasible = np.zeros((len(rows), len(options.configurations)), dtype=np.bool_)
    for light, number in rows.items():
        feasible[number, sorted(options.in_light(light))] = True
    return feasible[which]


def _fill_measured(
    table: CostTable, number: int, corridor: Corridor, origin: str, configurations: Sequence[DriveConfiguration]
) -> None:
    for column, configuration in enumerate(configurations):
        costs = drive_costs(corridor, origin, configuration)
        if costs is None:
            table.allowed[number, column] = False
        else:
            table.energy[number, column], table.time[number, column] = costs.energy, costs.time
            table.risk[number, column] = costs.risk
