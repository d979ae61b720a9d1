"""Planning: from an environment to a change set."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from enum import StrEnum

from rosa_streams.costs import Costs, DeclaredCosts, Objective
from rosa_streams.environment import Environment, Target
from rosa_streams.matching import ValidityMatrix
from rosa_streams.planning.compiling import UnitNames, compiled_change
from rosa_streams.planning.exact import lower_bound, optimal_choice
from rosa_streams.planning.explanation import why_unsatisfiable
from rosa_streams.planning.immediate import Settled, immediate_choice, quality, settle
from rosa_streams.planning.paper_search import paper_search
from rosa_streams.planning.plan import Plan, PlanStatus
from rosa_streams.planning.problem import Problem, problem_of

_SAME = 1e-9


class Search(StrEnum):
    """How a plan is searched for."""

    PAPER = "paper"
    FAST = "fast"
    EXACT = "exact"


def plan(
    environment: Environment,
    costs: Costs | None = None,
    objective: Objective | None = None,
    *,
    search: Search | str = Search.EXACT,
    deadline: float = 10.0,
    matrix: ValidityMatrix | None = None,
    targets: Sequence[Target] | None = None,
    names: UnitNames | None = None,
    remove_unneeded: bool = True,
    now: Callable[[], float] = time.perf_counter,
) -> Plan:
    """Find a change set that makes the environment valid at little cost (definitions 8 and 10 of the paper).

    Args:
        environment: as it is.
        costs: estimates; by default what transformations declare, and a labor of 1 for the others.
        objective: horizon, most cost, weight of quality.
        search: ``paper`` is the paper's, ``fast`` is the immediate one, ``exact`` proves the optimum.
        deadline: in seconds of ``now``, for ``paper`` and ``exact``.
        matrix: of the library; computed if it is not given.
        targets: these instead of the environment's.
        names: gives new units their names.
        remove_unneeded: whether units that no target needs any more are removed.
        now: where the search takes its time from.

    Returns:
        a plan whose change leaves a valid environment; or with the status ``none`` and the reason. A plan within a
        deadline that was not reached is the same for the same input.
    """
    problem = problem_of(environment, costs or DeclaredCosts(), objective, matrix, targets)
    settled = settle(problem)
    missing = [each for each, goal in zip(problem.targets, problem.goals, strict=True) if not settled.providers[goal]]
    if missing:
        why = "\n".join(str(why_unsatisfiable(problem, target)) for target in missing)
        return Plan(PlanStatus.NONE, units=tuple(environment.graph().values()), why=why)
    chosen, bound, status = _choice(problem, settled, Search(search), deadline, now)
    if chosen is None:
        why = f"the search came to no plan in {deadline:g} s"
        return Plan(PlanStatus.NONE, units=tuple(environment.graph().values()), why=why)
    most = problem.objective.max_cost
    if problem.cost(chosen) > most:
        what = "the cheapest plan costs" if status is PlanStatus.OPTIMAL else "the plan that was found costs"
        why = f"{what} {problem.cost(chosen):.6g}, and MAX_COST is {most:.6g}"
        return Plan(PlanStatus.NONE, units=tuple(environment.graph().values()), why=why)
    change, units, used = compiled_change(environment, problem, chosen, names, remove_unneeded=remove_unneeded)
    cost, worth = problem.cost(used), quality(problem, used)
    total = cost - problem.objective.quality_weight * worth
    if total <= bound + _SAME * max(1.0, abs(bound)):
        status, bound = PlanStatus.OPTIMAL, total
    return Plan(status, change, cost, bound, worth, units)


def _choice(
    problem: Problem, settled: Settled, search: Search, deadline: float, now: Callable[[], float]
) -> tuple[frozenset[int] | None, float, PlanStatus]:
    if search is Search.EXACT:
        optimum = optimal_choice(problem, deadline=deadline, now=now)
        return optimum.chosen, optimum.bound, PlanStatus.OPTIMAL if optimum.proven else PlanStatus.FEASIBLE
    chosen = (
        immediate_choice(problem, settled)
        if search is Search.FAST
        else paper_search(problem, timeout=deadline, now=now).chosen
    )
    return chosen, lower_bound(problem), PlanStatus.FEASIBLE


def pareto_front(
    environment: Environment,
    costs: Costs | None = None,
    objective: Objective | None = None,
    *,
    deadline: float = 10.0,
    most: int = 20,
) -> list[Plan]:
    """Plans of which none is cheaper and better at once, from the cheapest to the best, as weights of quality find
    them.

    Weights find the corners of the front's convex hull. Plans beyond ``MAX_COST`` are left out.
    """
    objective = objective or Objective()

    def at(weight: float) -> Plan:
        weighed = Objective(objective.horizon, objective.max_cost, weight)
        return plan(environment, costs, weighed, deadline=deadline)

    cheapest, best = at(0.0), at(1e6)
    front = {(found.cost, found.quality): found for found in (cheapest, best) if found.cost is not None}
    pairs = [(cheapest, best)]
    while pairs and len(front) < most:
        low, high = pairs.pop()
        if low.cost is None or high.cost is None or high.quality <= low.quality:
            continue
        middle = at((high.cost - low.cost) / (high.quality - low.quality))
        if middle.cost is not None and (middle.cost, middle.quality) not in front:
            front[middle.cost, middle.quality] = middle
            pairs += [(low, middle), (middle, high)]
    ordered = sorted(front.values(), key=lambda found: (found.cost or 0.0, -found.quality))
    return [
        found for place, found in enumerate(ordered) if all(found.quality > each.quality for each in ordered[:place])
    ]
