"""A ground task as a problem of unified-planning: each fact a fluent, each operator an action, neither with arguments.

So every engine is given names that it can read, whatever the files call things, and what an engine cannot do can be
compiled away in a few lines: durations, negative conditions, conditional effects.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from unified_planning.environment import Environment, get_environment
from unified_planning.model import DurativeAction, Fluent, InstantaneousAction, Problem, ProblemKind
from unified_planning.model.timing import EndTiming, OpenTimeInterval, StartTiming, TimePointInterval

from rosa_core import InputError
from rosa_core.errors import Problem as InputProblem
from task_layer.pddl.grounding.bits import bits
from task_layer.pddl.grounding.ground_task import Condition, Effect, GroundTask, Operator, State


@dataclass(frozen=True, slots=True)
class Features:
    """What a problem may make use of.

    ``durations``: actions take time, and may overlap. ``negative``: conditions that something does not hold.
    ``conditional``: effects that take place under a condition.
    """

    durations: bool
    negative: bool
    conditional: bool


MOST_OUTCOMES = 64
"""Into how many actions without conditional effects one with them may be split."""


class _ProblemOfKnownKind(Problem):  # type: ignore[misc]  # unified-planning is not typed
    """A problem whose kind is computed once: initial values do not change it, and computing it takes long."""

    known_kind: ProblemKind | None = None

    @property
    def kind(self) -> ProblemKind:
        """What an engine must be able to do to solve it."""
        if self.known_kind is None:
            self.known_kind = super().kind
        return self.known_kind


class PropositionalProblem:
    """A ground task in unified-planning, whose initial state can be changed.

    Args:
        task: the ground task.
        features: what the problem may make use of; the rest is compiled away.
        alone: make it in an environment of its own, and compute its kind only once. Some engines are not up to that:
            they put expressions of the global environment into the problem, or know problems by their class.
    """

    def __init__(self, task: GroundTask, features: Features, *, alone: bool = True) -> None:
        self.task = task
        self._features = features
        self._environment = Environment() if alone else get_environment()
        self.problem = _ProblemOfKnownKind("task", self._environment) if alone else Problem("task", self._environment)
        self._true = [self._fluent(f"f{index}") for index in range(len(task.facts))]
        self._false = {} if features.negative else self._twins()
        self._reached = self._fluent("reached") if len(task.goals) != 1 else None
        self._operators: dict[str, Operator] = {}
        self._actions = [action for operator in task.operators for action in self._actions_of(operator)]
        self._excluded: frozenset[int] = frozenset()
        self._state: State = 0
        self._add_goal()
        self.problem.add_actions(self._actions)
        for node in self._false.values():
            self.problem.set_initial_value(node, True)

    def set_initial_state(self, state: State, excluded: Collection[int] = ()) -> None:
        """Set the initial state, and leave out some operators."""
        changed = state ^ self._state
        self._state = state
        for index in bits(changed):
            holds = bool(state >> index & 1)
            self.problem.set_initial_value(self._true[index], holds)
            if index in self._false:
                self.problem.set_initial_value(self._false[index], not holds)
        if self._excluded != frozenset(excluded):
            self._excluded = frozenset(excluded)
            self.problem.clear_actions()
            self.problem.add_actions([*self._reaching, *(a for a in self._actions if self._is_wanted(a))])

    def operator(self, action: Any) -> Operator | None:
        """The operator that an action stands for; None for one that was only made for a choice of goals."""
        return self._operators.get(action.name)

    def _is_wanted(self, action: Any) -> bool:
        return self._operators[action.name].index not in self._excluded

    def _fluent(self, name: str) -> Any:
        fluent = Fluent(name, environment=self._environment)
        self.problem.add_fluent(fluent, default_initial_value=False)
        return fluent()

    def _twins(self) -> dict[int, Any]:
        """For each fact that is asked not to hold, a fluent that it does not."""
        mask = 0
        for operator in self.task.operators:
            effects = (*operator.start_effects, *operator.end_effects)
            conditions = [operator.at_start, operator.over_all, operator.at_end, *(e.condition for e in effects)]
            for condition in conditions:
                mask |= condition.negative
            # Where effects are split by a condition, it is also asked not to hold.
            mask |= 0 if self._features.conditional else _union(effect.condition.positive for effect in effects)
        for goal in self.task.goals:
            mask |= goal.negative
        return {index: self._fluent(f"not-f{index}") for index in bits(mask)}

    def _add_goal(self) -> None:
        self._reaching: list[Any] = []
        if self._reached is None:
            for node in self._literals(self.task.goals[0]):
                self.problem.add_goal(node)
            return
        self.problem.add_goal(self._reached)
        for index, goal in enumerate(self.task.goals):
            action = InstantaneousAction(f"goal{index}", _env=self._environment)
            for node in self._literals(goal):
                action.add_precondition(node)
            action.add_effect(self._reached, True)
            self._reaching.append(action)
        self.problem.add_actions(self._reaching)

    def _literals(self, condition: Condition) -> Iterator[Any]:
        yield from (self._true[index] for index in bits(condition.positive))
        for index in bits(condition.negative):
            yield (
                self._environment.expression_manager.Not(self._true[index])
                if self._features.negative
                else self._false[index]
            )

    def _actions_of(self, operator: Operator) -> Iterator[Any]:
        if self._features.durations:
            actions = [self._durative(f"a{operator.index}", operator)]
        elif self._features.conditional:
            actions = [self._plain(f"a{operator.index}", operator.condition, operator.effects)]
        else:
            outcomes = outcomes_of(operator)
            actions = [self._plain(f"a{operator.index}-{i}", *outcome) for i, outcome in enumerate(outcomes)]
        for action in actions:
            self._operators[action.name] = operator
            yield action

    def _plain(self, name: str, condition: Condition, effects: Iterable[Effect]) -> Any:
        action = InstantaneousAction(name, _env=self._environment)
        for node in self._literals(condition):
            action.add_precondition(node)
        for effect in effects:
            self._add_effect(action.add_effect, effect)
        return action

    def _durative(self, name: str, operator: Operator) -> Any:
        action = DurativeAction(name, _env=self._environment)
        action.set_fixed_duration(operator.duration or 1)
        start, end = StartTiming(), EndTiming()
        for interval, condition in (
            (TimePointInterval(start), operator.at_start),
            (OpenTimeInterval(start, end), operator.over_all),
            (TimePointInterval(end), operator.at_end),
        ):
            for node in self._literals(condition):
                action.add_condition(interval, node)
        for timing, effects in ((start, operator.start_effects), (end, operator.end_effects)):
            for effect in effects:
                self._add_effect(lambda *given, at=timing: action.add_effect(at, *given), effect)
        return action

    def _add_effect(self, add: Any, effect: Effect) -> None:
        given = self._environment.expression_manager.And(list(self._literals(effect.condition)))
        for mask, value in ((effect.add, True), (effect.delete & ~effect.add, False)):
            for index in bits(mask):
                add(self._true[index], value, given)
                if index in self._false:
                    add(self._false[index], not value, given)


def outcomes_of(operator: Operator) -> list[tuple[Condition, tuple[Effect, ...]]]:
    """Conditions and unconditional effects that together are an operator with conditional effects.

    Raises:
        InputError: if there would be too many.
    """
    outcomes = [(operator.condition, 0, 0)]
    for effect in operator.effects:
        applied = [
            (condition.also(effect.condition), add | effect.add, delete | effect.delete)
            for condition, add, delete in outcomes
        ]
        negated = [Condition(negative=1 << index) for index in bits(effect.condition.positive)]
        negated += [Condition(positive=1 << index) for index in bits(effect.condition.negative)]
        not_applied = [(condition.also(other), add, delete) for condition, add, delete in outcomes for other in negated]
        outcomes = [outcome for outcome in (*applied, *not_applied) if not outcome[0].impossible]
        if len(outcomes) > MOST_OUTCOMES:
            what = f"the conditional effects of {operator.name} have more than {MOST_OUTCOMES} outcomes"
            hint = "use an engine that plans with conditional effects (extra 'fast-downward'), or split the action"
            raise InputError(InputProblem(what, hint=hint))
    return [(condition, (Effect(add, delete & ~add),)) for condition, add, delete in outcomes]


def _union(masks: Iterable[int]) -> int:
    union = 0
    for mask in masks:
        union |= mask
    return union
