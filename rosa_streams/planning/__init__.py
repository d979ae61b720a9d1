"""Planning change sets: the paper's search, an immediate plan, and a proven optimum."""

from rosa_streams.planning.compiling import UnitNames
from rosa_streams.planning.explanation import Remedy, Why, why_unsatisfiable
from rosa_streams.planning.plan import Plan, PlanStatus
from rosa_streams.planning.planner import Search, pareto_front, plan
from rosa_streams.planning.problem import problem_of

__all__ = [
    "Plan",
    "PlanStatus",
    "Remedy",
    "Search",
    "UnitNames",
    "Why",
    "pareto_front",
    "plan",
    "problem_of",
    "why_unsatisfiable",
]
