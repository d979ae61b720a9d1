"""Co-adaptive planning: the best path and the best configuration for each corridor of it, together and exactly."""

from agv_example.planning.costs import Costs, Criterion, drive_costs
from agv_example.planning.objective import Objective
from agv_example.planning.pareto import TooManyRoutesError
from agv_example.planning.planner import CoAdaptivePlanner
from agv_example.planning.route import Leg, Position, Route

__all__ = [
    "CoAdaptivePlanner",
    "Costs",
    "Criterion",
    "Leg",
    "Objective",
    "Position",
    "Route",
    "TooManyRoutesError",
    "drive_costs",
]
