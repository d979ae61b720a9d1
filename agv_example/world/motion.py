"""How the robot moves along corridors, what that draws, and when it hits something."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from agv_example.corridors import Corridor
from agv_example.drive_configurations import DriveConfiguration
from agv_example.planning.costs import Costs, drive_costs


def true_costs(corridor: Corridor, origin: str, configuration: DriveConfiguration) -> Costs:
    """What driving the whole corridor costs in this world.

    It is what is estimated; but for a corridor that was never tried in this configuration its length counts, and a
    robot that is not accurate enough for the obstacles there hits them all.

    Args:
        corridor: to be driven.
        origin: the end from which.
        configuration: of the robot.
    """
    costs = drive_costs(corridor, origin, configuration)
    if costs is None:
        costs = drive_costs(replace(corridor, measured={}), origin, configuration) or Costs()
    if configuration.accuracy < corridor.accuracy:
        costs = replace(costs, risk=max(costs.risk, float(corridor.obstacles)))
    return costs


class Collisions:
    """Hits something whenever enough risk has added up: a Poisson process in expected collisions."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self._next = float(rng.exponential())
        self.risk = 0.0
        self.number = 0

    def add(self, risk: float) -> int:
        """So much more risk was taken; how often something was hit by that."""
        self.risk += risk
        before = self.number
        while self.risk >= self._next:
            self._next += float(self._rng.exponential())
            self.number += 1
        return self.number - before
