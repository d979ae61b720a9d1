"""The optimal plan by integer programming (HiGHS through scipy), with a deadline and a proven bound.

One variable an option: it runs or not. An option that runs needs providers; targets need providers. Two things make
this fast and right:

- *Landmarks*: tags that every well-founded plan must give, and those that must be given before an option runs, found by
  a fixpoint over the and/or graph (Keyder, Richter, Helmert 2010). One option is the first to give a tag; alternatives
  exclude each other, so that the linear relaxation cannot split what they need among them.
- *Loop constraints*: a choice in which units feed each other in a circle is cut off by requiring support from outside
  of the circle (loop formulas, Lin and Zhao 2004), and the program is solved again.

Options that another one can stand in for at no more cost are left out before (dominance).
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from rosa_streams.planning.immediate import immediate_choice, settle, value
from rosa_streams.planning.problem import Problem

_TOLERANCE = 1e-7


@dataclass(frozen=True, slots=True)
class Optimum:
    """The best choice that was found.

    Attributes:
        chosen: options; None if there is no solution.
        bound: no solution is worth less than this.
        proven: whether the choice is optimal.
        rounds: how often the integer program was solved.
    """

    chosen: frozenset[int] | None
    bound: float
    proven: bool
    rounds: int = 0


def optimal_choice(
    problem: Problem, *, deadline: float = 10.0, now: Callable[[], float] = time.perf_counter
) -> Optimum:
    """The options that satisfy every target at least cost (minus quality, where that weighs).

    Args:
        problem: what is planned.
        deadline: in seconds of ``now``; then the best choice so far is returned, with the bound proven so far.
        now: where the time comes from.
    """
    end = now() + deadline
    first = immediate_choice(problem)
    if first is None:
        return Optimum(None, math.inf, True)
    if not problem.goals:
        return Optimum(frozenset(), 0.0, True)
    program = _Program(problem, first)
    return program.solve(end, now)


@dataclass
class _Rows:
    """Linear constraints ``sum >= low``, as the parts of a sparse matrix."""

    rows: list[int] = field(default_factory=list)
    columns: list[int] = field(default_factory=list)
    values: list[float] = field(default_factory=list)
    lows: list[float] = field(default_factory=list)

    def add(self, terms: Iterable[tuple[int, float]], low: float) -> None:
        row = len(self.lows)
        for column, coefficient in terms:
            self.rows.append(row)
            self.columns.append(column)
            self.values.append(coefficient)
        self.lows.append(low)


class _Program:
    """The integer program of one problem."""

    def __init__(self, problem: Problem, best: frozenset[int]) -> None:
        self._problem = problem
        self._best = best
        self._best_value = value(problem, best)
        self._kept = _kept_options(problem, best, self._best_value)
        self._column = {number: column for column, number in enumerate(self._kept)}
        self._providers = [
            tuple(number for number in providers if number in self._column) for providers in problem.providers
        ]
        self._rows = _Rows()
        self._costs = [problem.options[number].cost for number in self._kept]
        self._fill()

    def solve(self, end: float, now: Callable[[], float]) -> Optimum:
        bound, rounds = lower_bound(self._problem), 0
        while True:
            left = end - now()
            if left <= 0:
                return Optimum(self._best, min(bound, self._best_value), False, rounds)
            rounds += 1
            result = self._milp(left)
            if result.mip_dual_bound is not None and math.isfinite(result.mip_dual_bound):
                bound = max(bound, float(result.mip_dual_bound))
            if result.x is None:
                # Infeasible can only mean that nothing is better than the choice in hand.
                proven = result.status == 2
                return Optimum(self._best, self._best_value if proven else min(bound, self._best_value), proven, rounds)
            chosen = {number for column, number in enumerate(self._kept) if result.x[column] > 0.5}
            unfounded = self._take(chosen)
            proven = result.status == 0 and not unfounded
            if proven or bound >= self._best_value - _TOLERANCE * max(1.0, abs(self._best_value)):
                return Optimum(self._best, self._best_value, True, rounds)
            if not unfounded:
                return Optimum(self._best, min(bound, self._best_value), False, rounds)
            self._add_loop_constraints(unfounded, chosen - unfounded)

    def _take(self, chosen: set[int]) -> set[int]:
        """Take the choice if it is better and well founded; returns the options in it that nothing feeds."""
        founded = set(self._problem.derivable(chosen))
        if all(not founded.isdisjoint(self._problem.providers[goal]) for goal in self._problem.goals):
            choice = self._problem.pruned(founded)
            if value(self._problem, frozenset(founded)) < value(self._problem, choice):
                choice = frozenset(founded)
            if value(self._problem, choice) < self._best_value:
                self._best, self._best_value = choice, value(self._problem, choice)
        return chosen - founded

    def _milp(self, time_limit: float) -> Any:
        import numpy as np
        from scipy.optimize import Bounds, LinearConstraint, milp
        from scipy.sparse import csr_array

        count = len(self._costs)
        rows = self._rows
        matrix = csr_array((rows.values, (rows.rows, rows.columns)), shape=(len(rows.lows), count))
        options = {"time_limit": max(time_limit, 0.01), "mip_rel_gap": 0.0}
        return milp(
            np.array(self._costs),
            constraints=LinearConstraint(matrix, np.array(rows.lows), np.inf),
            integrality=np.arange(count) < len(self._kept),
            bounds=Bounds(0, 1),
            options=options,
        )

    def _fill(self) -> None:
        of_option, of_goal = _landmarks(self._problem, self._kept, self._providers)
        self._add_tags()
        for goal in {*self._problem.goals, *of_goal}:
            self._rows.add([(self._tag[goal], 1.0)], 1.0)
        for number in self._kept:
            for need, count in self._problem.options[number].needs:
                self._rows.add([(self._tag[need], 1.0), (self._column[number], -1.0)], 0.0)
                if count > 1:
                    others = [(self._column[each], 1.0) for each in self._providers[need] if each != number]
                    self._rows.add([*others, (self._column[number], -float(count))], 0.0)
        for need, achievers in self._achievers.items():
            self._add_achievers(need, achievers, of_option)
        if self._problem.objective.quality_weight:
            self._weigh_quality()

    def _add_tags(self) -> None:
        """A variable for each tag, whether it is given, and for each option that may be the first to give it."""
        wanted = {need for number in self._kept for need, _ in self._problem.options[number].needs}
        self._tag: dict[int, int] = {}
        self._achievers: dict[int, dict[int, int]] = {}
        for need in sorted({*wanted, *self._problem.goals}):
            self._tag[need] = self._new_column()
            self._achievers[need] = {number: self._new_column() for number in self._providers[need]}

    def _add_achievers(self, need: int, achievers: dict[int, int], of_option: dict[int, int]) -> None:
        """One option is the first to give a tag; whatever all of them need by then is given if one of these is it.

        Alternatives exclude each other, so that what several of them need is needed as often as any of them is taken,
        which is what the relaxation would split otherwise.
        """
        rows = self._rows
        given = [(column, 1.0) for column in achievers.values()]
        rows.add([*given, (self._tag[need], -1.0)], 0.0)
        rows.add([*((column, -1.0) for column, _ in given), (self._tag[need], 1.0)], 0.0)
        before: dict[int, list[int]] = {}
        for number, column in achievers.items():
            rows.add([(self._column[number], 1.0), (column, -1.0)], 0.0)
            for other in _bits(of_option[number]):
                if other == need:
                    rows.add([(column, -1.0)], 0.0)  # It needs the tag itself: it is never the first to give it.
                else:
                    before.setdefault(other, []).append(column)
        for other, columns in before.items():
            if len(columns) > 1 and other in self._tag:
                rows.add([*((column, -1.0) for column in columns), (self._tag[other], 1.0)], 0.0)

    def _new_column(self) -> int:
        self._costs.append(0.0)
        return len(self._costs) - 1

    def _weigh_quality(self) -> None:
        """For each target a variable for each option that serves it: one is taken, and its quality has its worth."""
        weight = self._problem.objective.quality_weight
        for goal in self._problem.goals:
            columns = []
            for number in self._providers[goal]:
                column = len(self._costs)
                self._costs.append(-weight * self._problem.options[number].transformation.quality)
                self._rows.add([(self._column[number], 1.0), (column, -1.0)], 0.0)
                columns.append(column)
            self._rows.add([(column, 1.0) for column in columns], 1.0)
            self._rows.add([(column, -1.0) for column in columns], -1.0)

    def _add_loop_constraints(self, unfounded: set[int], founded: set[int]) -> None:
        """If any of the unfounded runs, one of them has what it lacks from an option that was not chosen."""
        support: dict[int, None] = {}
        for number in sorted(unfounded):
            lacking = [
                need
                for need, count in self._problem.options[number].needs
                if sum(1 for provider in self._providers[need] if provider in founded) < count
            ]
            need = min(lacking, key=lambda each: (len(self._providers[each]), each))
            for provider in self._providers[need]:
                if provider not in unfounded and provider not in founded:
                    support[provider] = None
        terms = [(self._column[provider], 1.0) for provider in support]
        for number in sorted(unfounded):
            self._rows.add([*terms, (self._column[number], -1.0)], 0.0)


def _kept_options(problem: Problem, best: frozenset[int], best_value: float) -> list[int]:
    """Options that may be part of an optimum: fed by something, not too expensive, and not dominated."""
    cheapest = settle(problem, chains=True).costs
    slack = problem.objective.quality_weight * sum(
        max((problem.options[number].transformation.quality for number in problem.providers[goal]), default=0.0)
        for goal in problem.goals
    )
    alive = [
        number
        for number in sorted(cheapest)
        if number in best or cheapest[number] - slack <= best_value + _TOLERANCE * max(1.0, abs(best_value))
    ]
    dominated = _dominated(problem, alive)
    return [number for number in alive if number not in dominated or number in best]


def _dominated(problem: Problem, alive: list[int]) -> set[int]:
    """Options that another one can stand in for: it gives all the same tags, needs no more and costs no more."""
    several = {need for number in alive for need, count in problem.options[number].needs if count > 1}
    gives = {number: frozenset(needs) for number, needs in problem.gives(alive).items()}
    goals = set(problem.goals) if problem.objective.quality_weight else set()
    alive_set = set(alive)
    dominated: set[int] = set()
    for number in alive:
        given = gives[number]
        if not given:
            dominated.add(number)
            continue
        if given & several:
            continue  # Where several different streams are wanted, one does not stand in for another.
        option = problem.options[number]
        needs = dict(option.needs)
        rarest = min(given, key=lambda need: (len(problem.providers[need]), need))
        for other in problem.providers[rarest]:
            if other == number or other not in alive_set or other in dominated:
                continue
            rival = problem.options[other]
            if (
                rival.cost <= option.cost
                and given <= gives[other]
                and all(count <= needs.get(need, 0) for need, count in rival.needs)
                and (not given & goals or rival.transformation.quality >= option.transformation.quality)
            ):
                dominated.add(number)
                break
    return dominated


def _landmarks(problem: Problem, kept: list[int], providers: list[tuple[int, ...]]) -> tuple[dict[int, int], list[int]]:
    """For each option the tags that are given before it runs, as bits of whole numbers; the tags that every plan gives.

    A greatest fixpoint over the and/or graph.
    """
    everything = (1 << len(providers)) - 1
    of_tag = [everything] * len(providers)
    of_option: dict[int, int] = {}
    changed = True
    while changed:
        changed = False
        for number in kept:
            found = 0
            for need, _ in problem.options[number].needs:
                found |= of_tag[need]
            of_option[number] = found
        for need, numbers in enumerate(providers):
            common = everything
            for number in numbers:
                common &= of_option[number]
            common |= 1 << need
            if numbers and common != of_tag[need]:
                of_tag[need] = common
                changed = True
    wanted = 0
    for goal in problem.goals:
        wanted |= of_tag[goal]
    return of_option, [need for need in _bits(wanted) if providers[need]]


def _bits(number: int) -> Iterator[int]:
    while number:
        lowest = number & -number
        yield lowest.bit_length() - 1
        number ^= lowest


def lower_bound(problem: Problem) -> float:
    """What no solution is worth less than, at once: the most expensive target's cheapest chain, minus all quality."""
    least = settle(problem, chains=True).costs
    bound, weight = 0.0, problem.objective.quality_weight
    worth = 0.0
    for goal in problem.goals:
        known = [number for number in problem.providers[goal] if number in least]
        bound = max(bound, min((least[number] for number in known), default=math.inf))
        worth += weight * max((problem.options[number].transformation.quality for number in known), default=0.0)
    return bound - worth
