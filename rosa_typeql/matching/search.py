"""The search for what satisfies several goals at once.

A goal (:mod:`rosa_typeql.matching.goals`) extends a solution (variables to terms) in every way in which it can be
satisfied. :func:`solve` tries goals in the order that :func:`in_order` chose: cheap ones first, and filters as soon as
what they filter is known.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from rosa_typeql.matching.facts import Attribute, FactTables, Thing

Term = Thing | Attribute | str
"""What a variable stands for; a plain text is the label of a type."""
Solution = dict[str, Term]


class TooMuchWorkError(Exception):
    """The search was given up."""


class UnboundVariableError(Exception):
    """A variable (without its ``$``) is compared or asked for, and nothing gives it a value."""


class Search:
    """The facts to search, and how many steps may still be taken.

    Args:
        facts: the tables of one snapshot.
        steps: a bound on the work of the whole search; every fact that is looked at is a step.
    """

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


NONE: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Goal:
    """One thing to satisfy.

    Args:
        variables: all variables that it speaks of.
        binds: those that it gives a value.
        types: the types whose tables it may look into.
        cost: how much there is to try, roughly, once these variables are bound; None: it cannot be tried yet.
        extend: what to add to a solution, for every way of satisfying the goal.
        placed: the goal, ready to be tried when (at least) these variables are bound; None: it is ready anywhere.
    """

    variables: frozenset[str]
    binds: frozenset[str]
    types: frozenset[str]
    cost: Callable[[frozenset[str]], float | None]
    extend: Callable[[Solution, Search], Iterator[Solution]]
    placed: Callable[[frozenset[str]], Goal] | None = None


def not_goal(goals: Sequence[Goal], outside: frozenset[str]) -> Goal:
    """``not { ... }``: nothing satisfies these goals.

    Args:
        goals: those inside.
        outside: the variables that goals outside of it bind; those of them that are used inside must be bound first.
    """
    shared = variables_of(goals) & outside

    def cost(bound: frozenset[str]) -> float | None:
        return 1.2 if shared <= bound else None

    def placed(bound: frozenset[str]) -> Goal:
        inner = in_order(goals, bound)

        def extend(solution: Solution, search: Search) -> Iterator[Solution]:
            search.spend()
            if next(solve(inner, {name: solution[name] for name in shared}, search), None) is None:
                yield {}

        return replace(goal, extend=extend)

    goal = Goal(variables_of(goals), NONE, types_of(goals), cost, _nowhere, placed)
    return goal


def or_goal(branches: Sequence[Sequence[Goal]], binds: frozenset[str], outside: frozenset[str]) -> Goal:
    """``{ ... } or { ... }``; one branch after the other.

    Args:
        branches: the goals of each.
        binds: the variables that all branches bind; they are bound after it.
        outside: as of :func:`not_goal`.
    """
    goals = [goal for branch in branches for goal in branch]
    shared = variables_of(goals) & outside

    def cost(bound: frozenset[str]) -> float | None:
        # Comparisons in a branch may need any of the variables outside, so those come first.
        return 50 if shared <= bound else None

    def placed(bound: frozenset[str]) -> Goal:
        inner = [in_order(branch, bound) for branch in branches]

        def extend(solution: Solution, search: Search) -> Iterator[Solution]:
            for branch in inner:
                search.spend()
                for found in solve(branch, dict(solution), search):
                    yield {name: found[name] for name in binds if name not in solution}

        return replace(goal, extend=extend)

    goal = Goal(variables_of(goals), binds, types_of(goals), cost, _nowhere, placed)
    return goal


def _nowhere(_solution: Solution, _search: Search) -> Iterator[Solution]:
    raise TypeError("a block was not placed among the goals around it")


def variables_of(goals: Iterable[Goal]) -> frozenset[str]:
    """All variables that some goals speak of."""
    return NONE.union(*(goal.variables for goal in goals))


def types_of(goals: Iterable[Goal]) -> frozenset[str]:
    """The types whose tables some goals may look into."""
    return NONE.union(*(goal.types for goal in goals))


def in_order(goals: Iterable[Goal], bound: frozenset[str]) -> list[Goal]:
    """The goals in the order in which to try them, when these variables are bound.

    Args:
        goals: those to be satisfied together.
        bound: the variables that have a value before.

    Returns:
        the cheapest that can be tried comes next each time; of equally cheap ones, the first given.

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
        ordered.append(goal if goal.placed is None else goal.placed(bound))
        bound |= goal.binds
    return ordered


def solve(goals: Sequence[Goal], solution: Solution, search: Search) -> Iterator[Solution]:
    """Every way to satisfy all goals.

    Args:
        goals: in the order in which to try them.
        solution: the variables that have a value before; changed in place while the search goes on.
        search: the facts and the steps that are left.

    Returns:
        ``solution`` itself, extended; each is valid until the next is asked for.

    Raises:
        TooMuchWorkError: if the steps run out.
    """
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
