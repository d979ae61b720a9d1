"""The search for what satisfies several goals at once.

A goal (:mod:`rosa_typeql.matching.goals`) extends a solution (variables to terms) in every way in which it can be
satisfied. :func:`solve` tries goals in the order that :func:`in_order` chose: cheap ones first, and filters as soon as
what they filter is known.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from rosa_typeql.matching.facts import Attribute, FactTables, Thing

Term = Thing | Attribute | str
"""What a variable stands for; a plain text is the label of a type."""
Solution = dict[str, Term]


class TooMuchWorkError(Exception):
    """The search was given up."""


class UnboundVariableError(Exception):
    """A variable (without its ``$``) is compared or told, and nothing gives it a value."""


class Search:
    """The facts to search, and how many steps may still be taken."""

    __slots__ = ("facts", "steps", "steps_left")

    def __init__(self, facts: FactTables, steps: int) -> None:
        self.facts = facts
        self.steps = steps
        self.steps_left = steps

    def spend(self, steps: int = 1) -> None:
        """Take steps.

        Raises:
            TooMuchWorkError: if there are none left.
        """
        self.steps_left -= steps
        if self.steps_left < 0:
            raise TooMuchWorkError


class Goal(Protocol):
    """One thing to satisfy."""

    @property
    def variables(self) -> frozenset[str]:
        """All variables that it speaks of."""

    @property
    def binds(self) -> frozenset[str]:
        """Those that it gives a value."""

    @property
    def types(self) -> frozenset[str]:
        """The types whose tables it may look into."""

    def cost(self, bound: frozenset[str]) -> float | None:
        """How much there is to try, roughly, once these variables are bound; None: it cannot be tried yet."""

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        """What to add to the solution, for every way of satisfying the goal."""


_NONE: frozenset[str] = frozenset()


@dataclass(slots=True)
class NotGoal:
    """``not { ... }``: nothing satisfies these goals. ``shared`` are the variables that stand outside as well."""

    goals: list[Goal]
    shared: frozenset[str]
    _ordered: list[Goal] = field(default_factory=list)

    @property
    def variables(self) -> frozenset[str]:
        return _NONE.union(*(goal.variables for goal in self.goals))

    @property
    def binds(self) -> frozenset[str]:
        return _NONE

    @property
    def types(self) -> frozenset[str]:
        return _NONE.union(*(goal.types for goal in self.goals))

    def cost(self, bound: frozenset[str]) -> float | None:
        return 1.2 if self.shared <= bound else None

    def place(self, bound: frozenset[str]) -> None:
        """It will be tried when (at least) these variables are bound."""
        self._ordered = in_order(self.goals, bound)

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        search.spend()
        inside = {name: solution[name] for name in self.shared}
        if next(solve(self._ordered, inside, search), None) is None:
            yield {}


@dataclass(slots=True)
class OrGoal:
    """``{ ... } or { ... }``; what all branches bind is bound after it. ``shared``: also bound by goals outside."""

    branches: list[list[Goal]]
    shared: frozenset[str]
    binds: frozenset[str]
    _ordered: list[list[Goal]] = field(default_factory=list)

    @property
    def variables(self) -> frozenset[str]:
        return _NONE.union(*(goal.variables for branch in self.branches for goal in branch))

    @property
    def types(self) -> frozenset[str]:
        return _NONE.union(*(goal.types for branch in self.branches for goal in branch))

    def cost(self, bound: frozenset[str]) -> float | None:
        # Comparisons in a branch may need any of the variables outside, so those come first.
        return 50 if self.shared <= bound else None

    def place(self, bound: frozenset[str]) -> None:
        """It will be tried when (at least) these variables are bound."""
        self._ordered = [in_order(branch, bound) for branch in self.branches]

    def extend(self, solution: Solution, search: Search) -> Iterator[Solution]:
        for branch in self._ordered:
            search.spend()
            for found in solve(branch, dict(solution), search):
                yield {name: found[name] for name in self.binds if name not in solution}


def in_order(goals: Iterable[Goal], bound: frozenset[str]) -> list[Goal]:
    """The goals in the order in which to try them, when these variables are bound.

    Raises:
        UnboundVariableError: if a goal needs a variable that nothing gives a value.
    """
    left = list(goals)
    ordered: list[Goal] = []
    while left:
        costs = [(cost, index) for index, goal in enumerate(left) if (cost := goal.cost(bound)) is not None]
        if not costs:
            raise UnboundVariableError(min(left[0].variables - bound, default=""))
        goal = left.pop(min(costs)[1])
        if isinstance(goal, NotGoal | OrGoal):
            goal.place(bound)
        ordered.append(goal)
        bound |= goal.binds
    return ordered


def solve(goals: Sequence[Goal], solution: Solution, search: Search) -> Iterator[Solution]:
    """Every way to satisfy all goals, starting from a solution of some variables; each is valid until the next."""
    if not goals:
        yield solution
        return
    # A stack of what is left to try instead of recursion: there may be more goals than Python allows calls.
    choices = [goals[0].extend(solution, search)]
    added: list[Solution] = [{}]
    while choices:
        for name in added[-1]:
            solution.pop(name, None)
        added[-1] = {}
        addition = next(choices[-1], None)
        if addition is None:
            choices.pop()
            added.pop()
            continue
        added[-1] = {name: term for name, term in addition.items() if name not in solution}
        solution.update(added[-1])
        if len(choices) == len(goals):
            yield solution
        else:
            choices.append(goals[len(choices)].extend(solution, search))
            added.append({})
