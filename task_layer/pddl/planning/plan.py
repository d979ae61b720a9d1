"""Plans: which steps, in which order, and whether what is left of one still reaches the goal."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field

from task_layer.pddl.grounding.ground_task import NOTHING, Condition, Effect, GroundTask, Operator, State, apply

_EPSILON = 1e-6
"""Times of a plan that are closer than this, in s, count as the same."""


@dataclass(frozen=True, slots=True)
class PlanStep:
    """A step of a plan.

    Attributes:
        operator: what is to be done.
        start: when, in s from the plan's beginning, as far as the domain gives durations.
    """

    operator: Operator
    start: float

    @property
    def end(self) -> float:
        """When it should be over, s."""
        return self.start + self.operator.duration


@dataclass(frozen=True, slots=True)
class Plan:
    """Steps in order of their planned starts.

    Attributes:
        task: what it is a plan for.
        steps: the steps.
        after_ends: for each step, the steps that must have ended before it starts.
        after_starts: for each step, the steps that must have started before it starts.
        overlapping: whether a step may rely on another that is still running: then order is kept by start and end.
    """

    task: GroundTask
    steps: tuple[PlanStep, ...]
    after_ends: tuple[frozenset[int], ...]
    after_starts: tuple[frozenset[int], ...]
    overlapping: bool = False
    _transitions: tuple[_Transition, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_transitions", () if self.overlapping else _transitions(self.steps))

    def __len__(self) -> int:
        return len(self.steps)

    @property
    def names(self) -> tuple[str, ...]:
        """The steps as PDDL writes them."""
        return tuple(step.operator.name for step in self.steps)

    @property
    def duration(self) -> float:
        """How long it takes, s, as far as the domain gives durations."""
        return max((step.end for step in self.steps), default=0.0)

    def reaches_goal(
        self, state: State, ended: Collection[int] = frozenset(), running: Collection[int] = frozenset()
    ) -> bool:
        """Whether the steps that have not ended bring a state to the goal, each with its requirements met.

        Args:
            state: what holds now.
            ended: the steps, by number, that are over.
            running: the steps that have started: only their ends are to come.

        Returns:
            whether it does; of a plan without ``overlapping`` in one pass over its steps.
        """
        if self.overlapping:
            return self._overlapping_reach(state, ended, running)
        for index, positive, negative, keep, add, conditional in self._transitions:
            if index in ended:
                continue
            if index in running:
                operator = self.steps[index].operator
                if not operator.over_all.also(operator.at_end).holds(state):
                    return False
                state = apply(state, operator.end_effects)
                continue
            if state & positive != positive or state & negative:
                return False
            state = apply(state, conditional) if conditional else state & keep | add
        return self.task.is_goal(state)

    def first_flaw(
        self, state: State, ended: Collection[int] = frozenset(), running: Collection[int] = frozenset()
    ) -> tuple[PlanStep, Condition] | None:
        """The first step whose requirements will not be met, with what is missing.

        Args:
            state: what holds now.
            ended: the steps, by number, that are over.
            running: the steps that have started.

        Returns:
            the step and what is missing; None if every step's requirements will be met, or if steps overlap: then
            what is missing depends on when things end.
        """
        if self.overlapping:
            return None
        for index, step in enumerate(self.steps):
            if index in ended:
                continue
            operator = step.operator
            now = index in running
            condition = operator.over_all.also(operator.at_end) if now else operator.condition
            if not condition.holds(state):
                return step, condition.missing(state)
            state = apply(state, operator.end_effects if now else operator.effects)
        return None

    def _overlapping_reach(self, state: State, ended: Collection[int], running: Collection[int]) -> bool:
        opened = {index: self.steps[index].operator.over_all for index in running}
        for index, is_end in _starts_and_ends(self.steps):
            operator = self.steps[index].operator
            if index in ended or (index in running and not is_end):
                continue
            condition, effects = (
                (operator.over_all.also(operator.at_end), operator.end_effects)
                if is_end
                else (operator.at_start, operator.start_effects)
            )
            if not condition.holds(state):
                return False
            state = apply(state, effects)
            if is_end:
                opened.pop(index, None)
            else:
                opened[index] = operator.over_all
            if not all(over_all.holds(state) for over_all in opened.values()):
                return False
        return self.task.is_goal(state)


_Transition = tuple[int, int, int, int, int, tuple[Effect, ...]]
"""A step, what must and must not hold, what stays, what becomes true; instead of the last two, conditional effects."""


def _transitions(steps: Sequence[PlanStep]) -> tuple[_Transition, ...]:
    made: list[_Transition] = []
    for index, step in enumerate(steps):
        condition, effects = step.operator.condition, step.operator.effects
        if any(effect.condition != NOTHING for effect in effects):
            made.append((index, condition.positive, condition.negative, -1, 0, effects))
            continue
        add = delete = 0
        for effect in effects:
            add |= effect.add
            delete |= effect.delete
        made.append((index, condition.positive, condition.negative, ~delete, add, ()))
    return tuple(made)


def _starts_and_ends(steps: Sequence[PlanStep]) -> list[tuple[int, bool]]:
    """Starts and ends in order of time, ends first if they coincide: the step, and whether it is its end."""
    starts = [(step.start, True, index, False) for index, step in enumerate(steps)]
    ends = [(step.end, step.operator.duration == 0, index, True) for index, step in enumerate(steps)]
    return [(index, is_end) for _, _, index, is_end in sorted(starts + ends)]


def sequential_plan(task: GroundTask, operators: Iterable[Operator]) -> Plan:
    """A plan whose steps run one at a time.

    Args:
        task: what it is a plan for.
        operators: the steps, in order.
    """
    steps: list[PlanStep] = []
    now = 0.0
    for operator in operators:
        steps.append(PlanStep(operator, now))
        now += operator.duration
    before = tuple(frozenset({index - 1} if index else ()) for index in range(len(steps)))
    return Plan(task, tuple(steps), before, before)


def parallel_plan(task: GroundTask, operators: Iterable[Operator]) -> Plan:
    """A plan in which steps run at once that neither change nor need what the other changes.

    The order of the operators given is kept between all others, so that every order of execution which the plan leaves
    open has the same outcome.

    Args:
        task: what it is a plan for.
        operators: the steps, in an order that reaches the goal.
    """
    steps: list[PlanStep] = []
    after: list[frozenset[int]] = []
    for operator in operators:
        before = frozenset(index for index, step in enumerate(steps) if _interfere(step.operator, operator))
        after.append(before)
        steps.append(PlanStep(operator, max((steps[index].end for index in before), default=0.0)))
    return Plan(task, tuple(steps), tuple(after), tuple(after))


def timed_plan(task: GroundTask, timed: Iterable[tuple[Operator, float]]) -> Plan:
    """A plan whose steps overlap as their times say: each starts after what ends, and what starts, before it.

    Args:
        task: what it is a plan for.
        timed: the steps with their starts, in s from the plan's beginning.
    """
    steps = tuple(PlanStep(operator, start) for operator, start in sorted(timed, key=lambda pair: pair[1]))
    ends = [
        frozenset(i for i, other in enumerate(steps) if i != index and _ends_before(other, i, step, index))
        for index, step in enumerate(steps)
    ]
    starts = [frozenset(range(index)) for index in range(len(steps))]
    return Plan(task, steps, tuple(ends), tuple(starts), overlapping=True)


def _ends_before(one: PlanStep, place: int, other: PlanStep, other_place: int) -> bool:
    return place < other_place and one.end <= other.start + _EPSILON


def _interfere(one: Operator, other: Operator) -> bool:
    return bool(one.changes & (other.facts | other.changes) or one.facts & other.changes)


def continued_plan(running: Sequence[Operator], plan: Plan) -> Plan:
    """A plan that begins with steps that are already running, and goes on with another plan once they have ended."""
    if not running:
        return plan
    later = max(operator.duration for operator in running)
    steps = [PlanStep(operator, 0.0) for operator in running]
    steps += [PlanStep(step.operator, step.start + later) for step in plan.steps]
    count = len(running)
    first = frozenset(range(count))
    nothing: list[frozenset[int]] = [frozenset()] * count

    def shifted(sets: Iterable[frozenset[int]]) -> tuple[frozenset[int], ...]:
        return (*nothing, *(first | {index + count for index in before} for before in sets))

    return Plan(plan.task, tuple(steps), shifted(plan.after_ends), shifted(plan.after_starts), plan.overlapping)
