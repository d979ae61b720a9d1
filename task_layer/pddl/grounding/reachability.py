"""Why there is no plan: what cannot become true even if nothing ever became false again (the delete relaxation)."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from task_layer.pddl.grounding.ground_task import Condition, GroundTask, Operator, State


@dataclass(frozen=True, slots=True)
class Obstacle:
    """Something that keeps actions from being performed, such as an action that is unfeasible.

    ``facts`` would hold without it (a mask), and ``operators`` could be used, by index.
    """

    facts: int = 0
    operators: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class NoPlan:
    """There is no plan, and why.

    Attributes:
        goals: the goals that cannot be reached; empty if each can be, but not all of them together.
        obstacles: the names of what stands in the way: without all of these the goals could be reached, and every one
            of them counts. Empty if the goals could not be reached without any obstacle either.
        never: facts that are needed, and that no action makes true.
    """

    goals: tuple[str, ...] = ()
    obstacles: tuple[str, ...] = ()
    never: tuple[str, ...] = ()

    def __str__(self) -> str:
        if not self.goals:
            return "each goal can be reached, but not all of them together"
        text = f"{', '.join(self.goals)} cannot be reached"
        if self.obstacles:
            return f"{text}: in the way {'is' if len(self.obstacles) == 1 else 'are'} {', '.join(self.obstacles)}"
        if self.never:
            return f"{text}: nothing makes {', '.join(self.never)} true"
        return text


def can_be_reached(task: GroundTask, state: State, excluded: Collection[int] = frozenset()) -> Condition:
    """The facts that can be true, and those that can be false, if nothing that has held once were ever lost.

    Source: the delete relaxation, Bonet and Geffner (2001), with negative conditions relaxed alike.

    Args:
        task: what is planned.
        state: from where.
        excluded: the operators that may not be used, by index.

    Returns:
        masks of both; a condition can be met only if its facts are among them.
    """
    true, false = state, ~state
    waiting = [operator for operator in task.operators if operator.index not in excluded]
    before = None
    while before != (true, false):
        before = (true, false)
        still: list[Operator] = []
        for operator in waiting:
            if _can_hold(operator.condition, true, false):
                # What it makes true at its start counts, even if not for long: another step may run meanwhile.
                effects = (*operator.start_effects, *operator.end_effects)
                taking_place = [effect for effect in effects if _can_hold(effect.condition, true, false)]
                for effect in taking_place:
                    true |= effect.add
                    false |= effect.delete
                if len(taking_place) == len(effects):
                    continue
            still.append(operator)
        waiting = still
    return Condition(true, false)


def unreachable(task: GroundTask, state: State, excluded: Collection[int] = frozenset()) -> frozenset[int]:
    """The operators, by index, that no plan from this state can have; engines need not look at them."""
    reached = can_be_reached(task, state, excluded)
    return frozenset(
        operator.index
        for operator in task.operators
        if not _can_hold(operator.condition, reached.positive, reached.negative)
    )


def _can_hold(condition: Condition, true: int, false: int) -> bool:
    return not condition.positive & ~true and not condition.negative & ~false


def explain(
    task: GroundTask, state: State, excluded: Collection[int], obstacles: Mapping[str, Obstacle]
) -> NoPlan | None:
    """Why the goal cannot be reached, or None if the delete relaxation does not show that it cannot.

    Args:
        task: what is planned.
        state: from where.
        excluded: the operators that may not be used.
        obstacles: what may be in the way, by name.

    Returns:
        the goals that cannot be reached, and what is in the way.
    """
    reached = can_be_reached(task, state, excluded)
    unmet = [_unmet(goal, reached) for goal in task.goals]
    if not unmet:
        return NoPlan(goals=("the goal",))
    if any(not rest.facts for rest in unmet):
        return None
    nearest = min(unmet, key=lambda rest: rest.facts.bit_count())
    in_the_way = _smallest(task, state, excluded, obstacles)
    return NoPlan(
        goals=tuple(task.literals_of(nearest)),
        obstacles=in_the_way,
        never=() if in_the_way else tuple(task.facts_in(_never_true(task, nearest, reached))),
    )


def _unmet(condition: Condition, reached: Condition) -> Condition:
    return Condition(condition.positive & ~reached.positive, condition.negative & ~reached.negative)


def _smallest(
    task: GroundTask, state: State, excluded: Collection[int], obstacles: Mapping[str, Obstacle]
) -> tuple[str, ...]:
    """Obstacles without which the goals could be reached, and none of which can be left in the way."""

    def reachable(removed: Iterable[str]) -> bool:
        facts, freed = state, set(excluded)
        for name in removed:
            facts |= obstacles[name].facts
            freed -= obstacles[name].operators
        reached = can_be_reached(task, facts, freed)
        return any(not _unmet(goal, reached).facts for goal in task.goals)

    chosen = list(obstacles)
    if not reachable(chosen):
        return ()
    for name in list(chosen):
        without = [other for other in chosen if other != name]
        if reachable(without):
            chosen = without
    return tuple(chosen)


def _never_true(task: GroundTask, wanted: Condition, reached: Condition) -> int:
    """The facts without an achiever on which the unreached goals depend."""
    found, seen, queue = 0, 0, wanted.positive
    while queue:
        fact = queue & -queue
        queue ^= fact
        seen |= fact
        achievers = [operator for operator in task.operators if any(effect.add & fact for effect in operator.effects)]
        if not achievers:
            found |= fact
        for operator in achievers:
            queue |= operator.condition.positive & ~reached.positive & ~seen
    return found
