"""Where the robot is, and how it is to get where it should be."""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from operator import add

from agv_example.drive_configurations import DriveConfiguration
from agv_example.planning.costs import Costs


@dataclass(frozen=True, slots=True)
class Position:
    """Where the robot is.

    Attributes:
        place: where it is or, in a corridor, the end at which it came in.
        corridor: that it is in, if it is not at the place.
        travelled: how far into the corridor, m.
    """

    place: str
    corridor: str | None = None
    travelled: float = 0.0

    def __str__(self) -> str:
        return self.place if self.corridor is None else f"{self.travelled:.1f} m into {self.corridor} from {self.place}"


@dataclass(frozen=True, slots=True)
class Leg:
    """One corridor of a route.

    Attributes:
        corridor: its name.
        start: the place from which it is driven.
        end: the place at which the robot leaves it.
        configuration: in which it is driven.
        costs: of driving it, getting ready included.
        back: the robot turns round in the corridor and leaves it by the end at which it came in.
    """

    corridor: str
    start: str
    end: str
    configuration: DriveConfiguration
    costs: Costs
    back: bool = False

    def __str__(self) -> str:
        return f"{'back out of ' if self.back else ''}{self.corridor} ({self.configuration.name})"


@dataclass(frozen=True, slots=True)
class Route:
    """The way to a goal, corridor by corridor.

    Attributes:
        goal: the name of the place.
        legs: none, if the robot is there already.
    """

    goal: str
    legs: tuple[Leg, ...]

    @property
    def costs(self) -> Costs:
        """Of all legs together."""
        return reduce(add, (leg.costs for leg in self.legs), Costs())

    @property
    def corridors(self) -> tuple[str, ...]:
        """The names of its corridors."""
        return tuple(leg.corridor for leg in self.legs)

    def __str__(self) -> str:
        return " -> ".join(map(str, self.legs)) or f"at {self.goal} already"
