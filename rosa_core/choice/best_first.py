"""Best-first branch and bound: complete choices one by one, in descending order of score, as far as they are wanted.

The functions are decided one after the other, then the components in the designs chosen. A heap holds the unfinished
choices by their bound; the finished ones are in it with their score, so that one that comes out on top is the best
that is left. Complexity: exponential in the number of functions when limits or sharing mislead the bounds all along,
else about one expansion per decision; memory grows with the number of expansions.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Iterator
from itertools import count
from typing import NamedTuple

from rosa_core.choice.additive import AdditiveProblem, Choice
from rosa_core.choice.bounds import Bounds, bits

_COMPARED = 32
"""Each state is compared with this many others of its kind: beyond that, comparing costs more than it saves."""

Usage = tuple[int, ...]


class Found(NamedTuple):
    """A complete choice: the number of the problem it solves, its score, and what is chosen."""

    problem: int
    score: int
    designs: tuple[str, ...]
    configurations: tuple[str, ...]


class _Node(NamedTuple):
    """A choice made in part. ``usage`` counts components that are not decided yet with the least that they can use."""

    decided: int
    choices: tuple[str, ...]
    parts: int
    pending: tuple[int, ...]
    """The components that are used and have a decision left; known once all functions are decided."""
    score: int
    priced: int
    usage: Usage


class _Search:
    """One additive problem: the root of its tree of choices, and how to go on from a node."""

    def __init__(self, problem: AdditiveProblem, only_best: bool) -> None:
        self.problem = problem
        self.bounds = Bounds(problem)
        self._only_best = only_best
        limits = range(len(problem.limits))
        self._least = [
            tuple(min(option.usage[limit] for option in options) for limit in limits) for options in problem.components
        ]
        self._open = sum(1 << index for index, options in enumerate(problem.components) if len(options) > 1)
        self._least_rest = self._least_usages()
        self._seen: dict[tuple[object, ...], int] = {}
        self._states: dict[tuple[object, ...], list[tuple[int, Usage]]] = {}

    def roots(self) -> Iterator[tuple[int, _Node]]:
        """The node at which nothing is chosen, with its bound; none, if the limits cannot be met."""
        nothing = (0,) * len(self.problem.limits)
        if self._within_limits(nothing, self._least_rest[0]):
            bound = self.bounds.base + self.bounds.rest(0, 0)
            yield bound, _Node(0, (), 0, (), self.problem.constant, self.bounds.base, nothing)

    def is_complete(self, node: _Node) -> bool:
        return node.decided >= len(self.problem.functions) and not node.pending

    def children(self, node: _Node) -> Iterator[tuple[int, _Node]]:
        """Every way to make one more decision that is not known to be useless, with its bound."""
        if self._only_best and self._is_dominated(node):
            return iter(())
        if node.decided < len(self.problem.functions):
            return self._designs(node)
        return self._options(node)

    def _designs(self, node: _Node) -> Iterator[tuple[int, _Node]]:
        bounds, depth = self.bounds, node.decided + 1
        last = depth == len(self.problem.functions)
        reachable, least_rest = bounds.later[depth], self._least_rest[depth]
        for choice, own in zip(self.problem.functions[node.decided], bounds.own[node.decided], strict=True):
            parts = node.parts | choice.parts
            if self.problem.required & ~(parts | reachable):
                continue
            score, priced = node.score + choice.score, node.priced + own
            usage = _add(node.usage, choice.usage)
            for component in bits(choice.parts & ~node.parts):
                priced += bounds.worth[component]
                usage = _add(usage, self._least[component])
                if not self._open >> component & 1:
                    score += self.problem.components[component][0].score
            if not self._within_limits(usage, least_rest):
                continue
            pending = tuple(bits(parts & self._open)) if last else ()
            bound = score if last and not pending else priced + bounds.rest(depth, parts)
            yield bound, _Node(depth, (*node.choices, choice.name), parts, pending, score, priced, usage)

    def _options(self, node: _Node) -> Iterator[tuple[int, _Node]]:
        component, *others = node.pending
        bounds, pending, least = self.bounds, tuple(others), self._least[component]
        for option in self.problem.components[component]:
            usage = tuple(a + b - c for a, b, c in zip(node.usage, option.usage, least, strict=True))
            if not self._within_limits(usage, self._least_rest[-1]):
                continue
            score = node.score + option.score
            priced = node.priced - bounds.worth[component] + bounds.priced(option)
            bound = priced if pending else score
            child = _Node(node.decided, (*node.choices, option.name), node.parts, pending, score, priced, usage)
            yield bound, child

    def _within_limits(self, usage: Usage, rest: Usage) -> bool:
        return all(used + more <= limit for used, more, limit in zip(usage, rest, self.problem.limits, strict=True))

    def _least_usages(self) -> list[Usage]:
        """For each depth, the least that the functions from there on can use."""
        rest = [(0,) * len(self.problem.limits)]
        for choices in reversed(self.problem.functions):
            columns = zip(*map(self._least_usage, choices), strict=True)
            rest.append(_add(rest[-1], tuple(min(column) for column in columns)))
        return rest[::-1]

    def _least_usage(self, choice: Choice) -> Usage:
        usage = choice.usage
        for component in bits(choice.parts):
            usage = _add(usage, tuple(min(0, least) for least in self._least[component]))
        return usage

    def _is_dominated(self, node: _Node) -> bool:
        """Whether a node from which just the same can follow was there before, no worse and using no more."""
        lasting = self.bounds.later[min(node.decided, len(self.bounds.later) - 1)] | self.problem.required
        if node.usage:
            lasting |= self._open
        key = (node.decided, node.pending, node.parts & lasting if not node.pending else 0)
        # Without limits nothing is priced, and the components not decided yet can be counted with their best.
        worth = node.score if node.usage else node.priced
        seen = self._seen.get((*key, node.usage))
        if seen is not None and seen >= worth:
            return True
        self._seen[(*key, node.usage)] = worth
        if not node.usage:
            return False
        states = self._states.setdefault(key, [])
        for score, usage in states:
            if score >= node.score and all(map(int.__le__, usage, node.usage)):
                return True
        if len(states) < _COMPARED:
            states.append((node.score, node.usage))
        return False


def search(problems: Iterable[AdditiveProblem], *, only_best: bool = False) -> Iterator[Found]:
    """The complete choices of several problems together, best first.

    Args:
        problems: the cases that the choice consists of.
        only_best: only the first is wanted: whatever cannot lead to it is dropped, so that those after the first are
            not all there are.
    """
    searches = [_Search(problem, only_best) for problem in problems]
    serial = count()
    heap: list[tuple[int, int, int, int, _Node]] = []

    def push(bound: int, index: int, node: _Node) -> None:
        # Among equal bounds the deeper node goes first: it is nearer to being complete.
        heapq.heappush(heap, (-bound, -len(node.choices), next(serial), index, node))

    for index, one in enumerate(searches):
        for bound, node in one.roots():
            push(bound, index, node)
    while heap:
        _, _, _, index, node = heapq.heappop(heap)
        one = searches[index]
        if one.is_complete(node):
            functions = len(one.problem.functions)
            yield Found(index, node.score, node.choices[:functions], node.choices[functions:])
            continue
        for bound, child in one.children(node):
            push(bound, index, child)


def _add(one: Usage, other: Usage) -> Usage:
    return tuple(map(int.__add__, one, other)) if one else one
