"""Why a target cannot be satisfied, down to the streams that nothing gives, and what would help."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from rosa_streams.environment import Target, Transformation
from rosa_streams.planning.immediate import settle
from rosa_streams.planning.problem import Option, Problem
from rosa_streams.tags import Concept
from rosa_streams.tags.concepts import Named, Predicate

_MOST_LINES = 40


@dataclass(frozen=True, slots=True)
class Remedy:
    """Streams that would, together, make a target satisfiable."""

    streams: tuple[Concept, ...]

    def __str__(self) -> str:
        return "register a transformation that gives " + " and one that gives ".join(map(str, self.streams))


@dataclass(frozen=True, slots=True)
class Why:
    """Why a target cannot be satisfied.

    Attributes:
        target: which.
        reasons: lines, each deeper one indented by two spaces.
        missing: the tags at the bottom that no transformation gives.
        remedies: the smallest additions first.
    """

    target: Target
    reasons: tuple[str, ...]
    missing: tuple[Concept, ...]
    remedies: tuple[Remedy, ...]

    def __str__(self) -> str:
        lines = [f"{self.target.qid} cannot be satisfied: it asks for {self.target.tag}"]
        lines += [f"  {line}" for line in self.reasons]
        lines += [f"  to help: {remedy}" for remedy in self.remedies]
        return "\n".join(lines)


def why_unsatisfiable(problem: Problem, target: Target) -> Why:
    """Explain a target of the problem that no choice of options satisfies."""
    derivable = frozenset(problem.derivable())
    goal = problem.goals[[each.qid for each in problem.targets].index(target.qid)]
    walk = _Walk(problem, derivable)
    lines = list(walk.need(goal, 0, ()))
    if len(lines) > _MOST_LINES:
        lines = [*lines[:_MOST_LINES], f"... and {len(lines) - _MOST_LINES} more lines"]
    return Why(target, tuple(lines), tuple(walk.missing), tuple(_remedies(problem, goal)))


class _Walk:
    """Goes from a need down to what is missing, each need once."""

    def __init__(self, problem: Problem, derivable: frozenset[int]) -> None:
        self.missing: dict[Concept, None] = {}
        self._problem = problem
        self._derivable = derivable
        self._explained: set[int] = set()

    def need(self, need: int, depth: int, path: tuple[str, ...]) -> Iterator[str]:
        indent, tag = "  " * depth, self._problem.tags[need]
        providers = self._problem.providers[need]
        if not providers:
            self.missing[tag] = None
            near = _nearest(self._problem, tag)
            yield f"{indent}no transformation gives {tag}" + (f"; the nearest is {near}" if near else "")
            return
        options = [self._problem.options[number] for number in providers]
        if need in self._explained:
            options = [option for option in options if option.name in path]
            if not options:
                yield f"{indent}{tag}: as above"
        self._explained.add(need)
        for option in options:
            yield from self._option(option, depth, path)

    def _option(self, option: Option, depth: int, path: tuple[str, ...]) -> Iterator[str]:
        indent, name = "  " * depth, option.name
        if name in path:
            circle = " -> ".join((*reversed(path[path.index(name) :]), path[-1]))
            yield f"{indent}{name} would feed itself, and no source feeds the loop: {circle}"
            return
        for lacked, count in option.needs:
            having = sum(1 for provider in self._problem.providers[lacked] if provider in self._derivable)
            if having >= count:
                continue
            ports = [port.name for port in option.transformation.inputs if port.tag == self._problem.tags[lacked]]
            if having:
                yield (
                    f"{indent}{name} wants {count} different streams of {self._problem.tags[lacked]} "
                    f"({', '.join(ports)}), and there {'is' if having == 1 else 'are'} {having}"
                )
                continue
            yield f"{indent}{name} would give it and lacks its input {', '.join(ports)}:"
            yield from self.need(lacked, depth + 1, (*path, name))


def _nearest(problem: Problem, tag: Concept) -> str | None:
    """The output that shares most with what is asked for, if any shares something."""
    best: tuple[int, str] | None = None
    wanted = {str(atom) for atom in tag.atoms}
    named = {str(atom) for atom in tag.atoms if isinstance(atom, Named | Predicate)}
    for option in problem.options:
        for port in option.transformation.outputs:
            given = {str(atom) for atom in port.tag.atoms}
            if given & named:
                shared = len(given & wanted)
                if best is None or shared > best[0]:
                    best = (shared, f"{port.tag} from {option.transformation.tid}.{port.name}")
    return best[1] if best else None


def _remedies(problem: Problem, goal: int, most: int = 3) -> Iterator[Remedy]:
    """The fewest streams that would satisfy the goal if something gave them; then others without the first of these."""
    barred: set[int] = set()
    for _ in range(most):
        found = _smallest_supply(problem, goal, barred)
        if not found:
            return
        yield Remedy(tuple(problem.tags[need] for need in found))
        barred.add(found[0])


def _smallest_supply(problem: Problem, goal: int, barred: set[int]) -> list[int]:
    """Tags to supply from outside, by the cheapest tree where a supplied tag costs 1 and an option next to nothing."""
    count = len(problem.options)
    supplier = Transformation("supply", "supply")
    options = [Option(each.transformation, each.unit, 1e-6, each.needs) for each in problem.options]
    numbers: dict[int, list[int]] = {}
    wanted = {need: times for option in problem.options for need, times in option.needs}
    wanted[goal] = 1
    for need in range(len(problem.tags)):
        # The goal itself is the last resort: it is always the smallest, and says least.
        cost = 1.5 if need == goal and problem.providers[goal] else 1.0
        for _ in range(0 if need in barred else wanted.get(need, 1)):
            numbers.setdefault(need, []).append(len(options))
            options.append(Option(supplier, None, cost, ()))
    providers = [(*problem.providers[need], *numbers.get(need, ())) for need in range(len(problem.tags))]
    extended = Problem(tuple(options), problem.tags, tuple(providers), problem.targets[:1], (goal,), problem.objective)
    settled = settle(extended)
    if not settled.providers[goal]:
        return []
    supplied: set[int] = set()
    seen: set[int] = set()
    work = [settled.providers[goal][0]]
    while work:
        number = work.pop()
        if number in seen:
            continue
        seen.add(number)
        if number >= count:
            supplied.update(need for need, those in numbers.items() if number in those)
        for need, times in options[number].needs:
            work.extend(settled.providers[need][:times])
    return sorted(supplied)
