"""From a problem with variables, as unified-planning reads it, to ground facts and operators."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator
from itertools import product
from typing import Any

from rosa_core import InputError
from rosa_core.errors import Location, Problem
from task_layer.pddl.grounding.formulas import Atom, Binding, Formulas, TooManyAlternativesError, UngroundableError
from task_layer.pddl.grounding.ground_task import NOTHING, Condition, Effect, GroundTask, Operator, ground_name

MOST_OPERATORS = 100_000
MOST_ALTERNATIVES = 256


def ground(
    problem: Any,
    *,
    changing: Collection[str],
    feasibility: str,
    written: Callable[[str], str],
    where: Callable[[str | None], Location],
) -> GroundTask:
    """Ground a unified-planning ``Problem``.

    What no action changes and nobody senses is looked up in the initial state and left out.

    Args:
        problem: as the reader made it.
        changing: plain names of predicates that change although no action changes them.
        feasibility: the plain name of the predicate that says whether an action is feasible.
        written: a plain name as it was written in the files.
        where: the place of an action in the domain file, or of the goal for None.

    Raises:
        InputError: if conditions depend on numbers that change, or there would be too many operators.
    """
    return _Grounder(problem, {*changing, feasibility}, feasibility, written, where).task()


class _Grounder:
    def __init__(
        self,
        problem: Any,
        changing: set[str],
        feasibility: str,
        written: Callable[[str], str],
        where: Callable[[str | None], Location],
    ) -> None:
        self._problem = problem
        self._written = written
        self._where = where
        self._feasibility = feasibility
        changed = {effect.fluent.fluent().name for action in problem.actions for effect in _effects_of(action)}
        values = {
            (node.fluent().name, tuple(argument.object().name for argument in node.args)): value.constant_value()
            for node, value in problem.explicit_initial_values.items()
        }
        self._formulas = Formulas(problem, values, changed | changing, MOST_ALTERNATIVES)
        self._operators: list[Operator] = []
        self._feasible: dict[str, int] = {}

    def task(self) -> GroundTask:
        """Ground everything."""
        self._number_feasibility()
        for action in self._problem.actions:
            try:
                for binding in self._bindings(action):
                    self._add_operators(action, binding)
            except UngroundableError as error:
                raise InputError(Problem(str(error), self._where(action.name), error.hint)) from None
        try:
            goals = self._formulas.all_of(self._problem.goals, {})
        except UngroundableError as error:
            raise InputError(Problem(str(error), self._where(None), error.hint)) from None
        facts = self._formulas.facts
        return GroundTask(
            name=self._written(self._problem.name or ""),
            facts=tuple(self._shown(atom) for atom in facts),
            operators=tuple(self._operators),
            initial=sum(1 << index for atom, index in facts.items() if self._formulas.initially(atom)),
            goals=tuple(goals),
            feasibility=self._feasible,
        )

    def _number_feasibility(self) -> None:
        for fluent in self._problem.fluents:
            if fluent.name == self._feasibility and fluent.arity == 1:
                for item in self._problem.objects(fluent.signature[0].type):
                    mask = self._formulas.mask((fluent.name, (item.name,)))
                    self._feasible[self._written(item.name)] = mask

    def _bindings(self, action: Any) -> Iterator[Binding]:
        """Every choice of objects for the parameters that meets the conditions which never change."""
        parameters = action.parameters
        tests: list[list[Any]] = [[] for _ in range(len(parameters) + 1)]
        asked: dict[str, list[Any]] = {parameter.name: [] for parameter in parameters}
        objects = [[item.name for item in self._problem.objects(parameter.type)] for parameter in parameters]
        places = {parameter.name: place for place, parameter in enumerate(parameters, 1)}
        for node in _conjuncts(condition for _, conditions in _conditions_of(action) for condition in conditions):
            if self._formulas.is_fixed(node):
                names = [argument.parameter().name for argument in node.args if argument.is_parameter_exp()]
                tests[max((places[name] for name in names), default=0)].append(node)
                for name in dict.fromkeys(names):
                    asked[name].append(node)

        def extend(binding: Binding, place: int) -> Iterator[Binding]:
            if not all(self._formulas.all_of([test], binding) for test in tests[place]):
                return
            if place == len(parameters):
                yield binding
                return
            name = parameters[place].name
            fitting = [self._formulas.fitting(node, name, binding) for node in asked[name]]
            for item in objects[place]:
                if all(item in several for several in fitting):
                    yield from extend({**binding, name: item}, place + 1)

        yield from extend({}, 0)

    def _requirements(self, action: Any, binding: Binding) -> Iterator[tuple[Condition, Condition, Condition]]:
        """The choices of what must hold at the start, throughout and at the end."""
        required = {"start": [NOTHING], "all": [NOTHING], "end": [NOTHING]}
        for when, conditions in _conditions_of(action):
            required[when] = _both(required[when], self._formulas.all_of(conditions, binding))
        return product(required["start"], required["all"], required["end"])

    def _add_operators(self, action: Any, binding: Binding) -> None:
        requirements = self._requirements(action, binding)
        start_effects = self._effects(action, binding, "start")
        end_effects = self._effects(action, binding, "end")
        _check_conditional(action, start_effects, end_effects)
        duration = self._duration(action, binding)
        mask = sum(self._feasible.values())
        for at_start, over_all, at_end in requirements:
            required = at_start.positive | over_all.positive | at_end.positive
            self._operators.append(
                Operator(
                    index=len(self._operators),
                    action=self._written(action.name),
                    arguments=tuple(self._written(binding[parameter.name]) for parameter in action.parameters),
                    at_start=at_start,
                    over_all=over_all,
                    at_end=at_end,
                    start_effects=start_effects,
                    end_effects=end_effects,
                    duration=duration,
                    feasibility=required & mask,
                )
            )
        if len(self._operators) > MOST_OPERATORS:
            raise TooManyAlternativesError(
                f"there are more than {MOST_OPERATORS} ways to fill in the parameters of the actions",
                "give parameters narrower types, or fewer objects",
            )

    def _duration(self, action: Any, binding: Binding) -> float:
        if not _is_durative(action):
            return 0.0
        duration = self._formulas.number(action.duration.lower, binding)
        if duration < 0 or math.isinf(duration):
            what = f"the duration of '{self._written(action.name)}' is {duration:g} s"
            raise UngroundableError(what, "no action can take less than no time, or for ever")
        return duration

    def _effects(self, action: Any, binding: Binding, when: str) -> tuple[Effect, ...]:
        add = delete = 0
        conditional: list[Effect] = []
        for time, effect in _timed_effects_of(action):
            if time != when or not effect.fluent.type.is_bool_type():
                continue
            for inner in self._formulas.choices(effect.forall, binding):
                mask = self._formulas.mask(self._formulas.atom(effect.fluent, inner))
                value = self._formulas.all_of([effect.value], inner) != []
                for condition in self._formulas.all_of([effect.condition], inner):
                    if condition != NOTHING:
                        conditional.append(Effect(mask * value, mask * (not value), condition))
                    elif value:
                        add |= mask
                    else:
                        delete |= mask
        unconditional = (Effect(add, delete & ~add),) if add or delete else ()
        return (*unconditional, *conditional)

    def _shown(self, atom: Atom) -> str:
        name, arguments = atom
        return ground_name(self._written(name), map(self._written, arguments))


def _check_conditional(action: Any, start: tuple[Effect, ...], end: tuple[Effect, ...]) -> None:
    """Refuse a conditional effect on what the other end is about, too: its outcome could not be known beforehand."""
    for effects, others in ((start, end), (end, start)):
        touched = 0
        for other in others:
            touched |= other.add | other.delete | (other.condition.facts if others is end else 0)
        if any(effect.condition != NOTHING and (effect.add | effect.delete) & touched for effect in effects):
            raise UngroundableError(
                f"action '{action.name}' has a conditional effect on what its other end also changes or asks for",
                "split it into two actions",
            )


def _both(these: list[Condition], those: list[Condition]) -> list[Condition]:
    both = (one.also(other) for one, other in product(these, those))
    return [condition for condition in dict.fromkeys(both) if not condition.impossible]


def _is_durative(action: Any) -> bool:
    return hasattr(action, "duration")


def _conditions_of(action: Any) -> Iterator[tuple[str, list[Any]]]:
    """The conditions with when they are for: ``start``, ``end``, or ``all``."""
    if not _is_durative(action):
        yield "start", action.preconditions
        return
    for interval, conditions in action.conditions.items():
        if interval.lower != interval.upper:
            yield "all", conditions
        else:
            yield "start" if interval.lower.is_from_start() else "end", conditions


def _timed_effects_of(action: Any) -> Iterator[tuple[str, Any]]:
    if not _is_durative(action):
        yield from (("end", effect) for effect in action.effects)
        return
    for timing, effects in action.effects.items():
        yield from (("start" if timing.is_from_start() else "end", effect) for effect in effects)


def _effects_of(action: Any) -> Iterator[Any]:
    return (effect for _, effect in _timed_effects_of(action))


def _conjuncts(nodes: Iterable[Any]) -> Iterator[Any]:
    for node in nodes:
        if node.is_and():
            yield from _conjuncts(node.args)
        else:
            yield node
