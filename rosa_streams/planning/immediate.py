"""An immediate plan by dynamic programming: the cheapest tree of units for every tag at once.

Knuth's generalisation of Dijkstra's algorithm (1977) to and/or graphs: options are settled in order of the cost of the
cheapest tree that ends in them. It minimises what the paper's search minimises, the cost of the tree before common
parts are shared, in time of order n log n. Units are settled after what feeds them, so that support is well founded.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

from rosa_streams.planning.problem import Problem

_MOST_PRUNED = 300
_MOST_ROUNDS = 4


@dataclass(frozen=True)
class Settled:
    """The cheapest trees.

    Attributes:
        costs: of the cheapest tree that ends in each option; missing for options that nothing feeds.
        providers: for each tag its options, cheapest tree first.
    """

    costs: dict[int, float]
    providers: list[list[int]]


def settle(problem: Problem, free: frozenset[int] = frozenset(), *, chains: bool = False) -> Settled:
    """The cheapest trees of a problem, where the options in ``free`` cost nothing.

    With ``chains`` only the most expensive need of each option counts, not their sum: no plan with an option costs less
    than that (h^max).
    """
    waiting, missing = _waiting(problem)
    total = [0.0 if number in free else option.cost for number, option in enumerate(problem.options)]
    gives = _gives(problem)
    heap = [(total[number], number) for number, count in enumerate(missing) if not count]
    heapq.heapify(heap)
    costs: dict[int, float] = {}
    found: list[list[int]] = [[] for _ in problem.providers]
    while heap:
        cost, number = heapq.heappop(heap)
        costs[number] = cost
        for need in gives[number]:
            found[need].append(number)
            place = len(found[need])
            for other, count in waiting[need]:
                if place > count or other in costs:
                    continue
                missing[other] -= 1
                # Options are settled in order of cost: the last one to come is the most expensive need.
                if not chains or not missing[other]:
                    total[other] += cost
                if not missing[other]:
                    heapq.heappush(heap, (total[other], other))
    return Settled(costs, found)


def _waiting(problem: Problem) -> tuple[list[list[tuple[int, int]]], list[int]]:
    """For each tag the options that want it and of how many providers, and for each option how many it wants in all."""
    waiting: list[list[tuple[int, int]]] = [[] for _ in problem.providers]
    missing = []
    for number, option in enumerate(problem.options):
        missing.append(sum(count for _, count in option.needs))
        for need, count in option.needs:
            waiting[need].append((number, count))
    return waiting, missing


def _gives(problem: Problem) -> list[list[int]]:
    gives: list[list[int]] = [[] for _ in problem.options]
    for need, providers in enumerate(problem.providers):
        for number in providers:
            gives[number].append(need)
    return gives


def immediate_choice(problem: Problem, settled: Settled | None = None) -> frozenset[int] | None:
    """Options that satisfy every target, found at once; None if there are none.

    Choices are made again with the options of the best one free of cost, so that common parts attract, as long as
    they get better; then options that can be done without are left out.
    """
    settled = settled or settle(problem)
    first = _extracted(problem, settled)
    if first is None:
        return None
    best = first
    for _ in range(_MOST_ROUNDS if len(problem.options) <= 3000 else 0):
        again = _extracted(problem, settle(problem, best))
        if again is None or value(problem, again) >= value(problem, best):
            break
        best = again
    if len(best) > _MOST_PRUNED:
        return best
    fewer = problem.pruned(best)
    return fewer if value(problem, fewer) < value(problem, best) else best


def value(problem: Problem, chosen: frozenset[int]) -> float:
    """What is minimised: cost minus what the quality of the targets' streams is worth."""
    return problem.cost(chosen) - problem.objective.quality_weight * quality(problem, chosen)


def quality(problem: Problem, chosen: frozenset[int]) -> float:
    """The sum over targets of the best quality among the chosen options that may serve it."""
    return sum(
        max(
            (problem.options[number].transformation.quality for number in problem.providers[goal] if number in chosen),
            default=0.0,
        )
        for goal in problem.goals
    )


def _extracted(problem: Problem, settled: Settled) -> frozenset[int] | None:
    weight = problem.objective.quality_weight
    work = []
    for goal in problem.goals:
        providers = settled.providers[goal]
        if not providers:
            return None
        if weight:
            work.append(
                min(
                    providers,
                    key=lambda number: settled.costs[number] - weight * problem.options[number].transformation.quality,
                )
            )
        else:
            work.append(providers[0])
    chosen = set(work)
    while work:
        for need, count in problem.options[work.pop()].needs:
            for provider in settled.providers[need][:count]:
                if provider not in chosen:
                    chosen.add(provider)
                    work.append(provider)
    return frozenset(chosen)
