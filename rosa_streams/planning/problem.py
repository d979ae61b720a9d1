"""The planning problem: which units may run, what each needs and gives, and what is wished for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from rosa_streams.costs import Costs, Objective
from rosa_streams.environment import Environment, Target, Transformation, Unit
from rosa_streams.matching import ValidityMatrix
from rosa_streams.tags import Concept


@dataclass(frozen=True, slots=True)
class Option:
    """A unit that may run after the update: one that runs already, or a new one.

    Attributes:
        transformation: what it is an instance of.
        unit: the one that runs, or None for a new one.
        cost: upkeep over the horizon, and labor if it is new.
        needs: numbers of tags, each with how many input ports ask for it. Ports with the same tag want different
            streams: a fusion of a stream with itself is none.
    """

    transformation: Transformation
    unit: Unit | None
    cost: float
    needs: tuple[tuple[int, int], ...]

    @property
    def name(self) -> str:
        """The unit's name, or the transformation's if it is new."""
        return self.transformation.tid if self.unit is None else self.unit.cid


@dataclass(frozen=True)
class Problem:
    """What is to be planned.

    Attributes:
        options: numbered; the ones that could be of use to a target only.
        tags: what is asked for; needs are numbers of tags.
        providers: for each tag the numbers of the options with an output that matches it.
        targets: in order of their names.
        goals: for each target the number of its tag.
    """

    options: tuple[Option, ...]
    tags: tuple[Concept, ...]
    providers: tuple[tuple[int, ...], ...]
    targets: tuple[Target, ...]
    goals: tuple[int, ...]
    objective: Objective

    def cost(self, chosen: Iterable[int]) -> float:
        """Labor and upkeep of these options."""
        return sum(self.options[number].cost for number in chosen)

    def derivable(self, among: Iterable[int] | None = None) -> list[int]:
        """The options (of these, or of all) that sources feed in the end, in an order in which each can be started."""
        allowed = set(range(len(self.options))) if among is None else set(among)
        return list(self._derive(allowed))

    def unsatisfiable_goals(self) -> tuple[Target, ...]:
        """The targets that no choice of options satisfies."""
        derivable = set(self.derivable())
        return tuple(
            target
            for target, goal in zip(self.targets, self.goals, strict=True)
            if derivable.isdisjoint(self.providers[goal])
        )

    def is_solution(self, chosen: Iterable[int]) -> bool:
        """Whether sources feed all of these options and they satisfy every target."""
        wanted = set(chosen)
        return set(self.derivable(wanted)) == wanted and all(
            not wanted.isdisjoint(self.providers[goal]) for goal in self.goals
        )

    def pruned(self, chosen: Iterable[int]) -> frozenset[int]:
        """A solution without options that it can do without, the most expensive ones left out first."""
        kept = set(chosen)
        gives = self.gives(kept)
        for number in sorted(kept, key=lambda number: (-self.options[number].cost, -number)):
            if number not in kept:
                continue
            fewer = set(self._derive(kept - {number}, gives))
            if all(any(each in fewer for each in self.providers[goal]) for goal in self.goals):
                kept = fewer
        return frozenset(kept)

    def _derive(self, allowed: set[int], gives: dict[int, list[int]] | None = None) -> Iterator[int]:
        missing: dict[int, dict[int, int]] = {}
        waiting: dict[int, list[int]] = {}
        ready: list[int] = []
        for number in sorted(allowed):
            needs = dict(self.options[number].needs)
            missing[number] = needs
            for need in needs:
                waiting.setdefault(need, []).append(number)
            if not needs:
                ready.append(number)
        gives = self.gives(allowed) if gives is None else gives
        for number in ready:
            yield number
            for need in gives.get(number, ()):
                for other in waiting.get(need, ()):
                    left = missing[other]
                    if need in left and other != number:
                        left[need] -= 1
                        if left[need] == 0:
                            del left[need]
                            if not left:
                                ready.append(other)

    def gives(self, options: Iterable[int]) -> dict[int, list[int]]:
        """For each of these options the tags that it matches."""
        wanted = set(options)
        found: dict[int, list[int]] = {number: [] for number in wanted}
        for need, providers in enumerate(self.providers):
            for number in providers:
                if number in wanted:
                    found[number].append(need)
        return found


def problem_of(
    environment: Environment,
    costs: Costs,
    objective: Objective | None = None,
    matrix: ValidityMatrix | None = None,
    targets: Sequence[Target] | None = None,
) -> Problem:
    """The planning problem of an environment.

    Args:
        environment: with its units; each may be reused, and a transformation without one may get a new one.
        costs: estimates of labor and upkeep.
        objective: horizon, most cost, weight of quality.
        matrix: of the library, with at least these transformations; computed if it is not given.
        targets: these instead of the environment's.
    """
    objective = objective or Objective()
    wanted = list(environment.goal().values()) if targets is None else list(targets)
    if matrix is None:
        matrix = ValidityMatrix.of(environment.library().values(), wanted, environment.similarity)
    return _Building(environment, costs, objective, matrix, wanted).problem()


class _Building:
    """Collects options backwards from the targets."""

    def __init__(
        self,
        environment: Environment,
        costs: Costs,
        objective: Objective,
        matrix: ValidityMatrix,
        targets: list[Target],
    ) -> None:
        self._library = {each.tid: each for each in environment.transformations}
        self._units: dict[str, list[Unit]] = {}
        for cid, unit in environment.graph().items():
            del cid
            self._units.setdefault(unit.tid, []).append(unit)
        self._costs, self._objective, self._matrix, self._targets = costs, objective, matrix, targets
        self._numbers: dict[Concept, int] = {}
        self._tags: list[Concept] = []
        self._options: list[Option] = []
        self._options_of: dict[str, tuple[int, ...]] = {}

    def problem(self) -> Problem:
        goals = tuple(self._number(target.tag) for target in self._targets)
        providers: list[tuple[int, ...]] = []
        while len(providers) < len(self._tags):
            tag = self._tags[len(providers)]
            owners = dict.fromkeys(port.owner for port in self._matrix.providers_of_tag(tag))
            found = [number for owner in owners if owner in self._library for number in self._of(owner)]
            providers.append(tuple(sorted(found)))
        return Problem(
            tuple(self._options), tuple(self._tags), tuple(providers), tuple(self._targets), goals, self._objective
        )

    def _number(self, tag: Concept) -> int:
        number = self._numbers.get(tag)
        if number is None:
            number = self._numbers[tag] = len(self._tags)
            self._tags.append(tag)
        return number

    def _of(self, tid: str) -> tuple[int, ...]:
        known = self._options_of.get(tid)
        if known is not None:
            return known
        transformation = self._library[tid]
        needs: dict[int, int] = {}
        for port in transformation.inputs:
            number = self._number(port.tag)
            needs[number] = needs.get(number, 0) + 1
        upkeep = self._objective.horizon * self._costs.upkeep(transformation)
        first = len(self._options)
        units = self._units.get(tid)
        if units:
            self._options += [Option(transformation, unit, upkeep, tuple(needs.items())) for unit in units]
        else:
            cost = upkeep + self._costs.labor(transformation)
            self._options.append(Option(transformation, None, cost, tuple(needs.items())))
        numbers = self._options_of[tid] = tuple(range(first, len(self._options)))
        return numbers
