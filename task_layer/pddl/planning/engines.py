"""Solving a ground task with an engine of unified-planning, as is or with durations and negations compiled away."""

from __future__ import annotations

import warnings
from collections.abc import Collection
from typing import Any, Protocol

from rosa_core import InputError
from rosa_core.errors import Problem, nearest
from task_layer.pddl.grounding.ground_task import GroundTask, Operator, State
from task_layer.pddl.planning.errors import PlannerFailedError

DEFAULT_ENGINE = "pyperplan"

_SEARCHES = ({"search": "ehs", "heuristic": "hadd"}, {"search": "gbf", "heuristic": "hadd"})
"""Enforced hill climbing is quick and stays so with many goals, but may miss a plan; greedy best-first search does not.
(The landmark heuristic is quicker still; but it adds up floats in an order that differs from process to process.)"""

_PACKAGES = {"fast-downward": "the extra 'fast-downward'", "aries": "the extra 'aries'", "tamer": "the extra 'tamer'"}

TimedOperators = list[tuple[Operator, float]]


class Solver(Protocol):
    """Finds operators that lead from a state to the goal."""

    @property
    def overlapping(self) -> bool:
        """Whether the starts that it gives may overlap; otherwise they only give the order."""
        ...

    def solve(self, state: State, excluded: Collection[int]) -> TimedOperators | None:
        """Operators with their starts (s), or None if there is no plan.

        Raises:
            PlannerFailedError: if it is not known whether there is one.
        """
        ...

    def close(self) -> None:
        """Let go of what it holds."""
        ...


class EngineSolver:
    """An engine of unified-planning, in this process.

    Args:
        task: what is to be planned.
        engine: the engine's name in unified-planning.

    Raises:
        InputError: if there is no such engine, or it cannot do what the task asks for.
    """

    def __init__(self, task: GroundTask, engine: str = DEFAULT_ENGINE) -> None:
        # unified-planning takes a while to import, which only those who plan should wait for.
        from task_layer.pddl.planning.propositional import Features, PropositionalProblem

        self.name = engine
        made_by = _engine_class(engine)
        supported = made_by.supported_kind()
        timed = any(operator.duration for operator in task.operators)
        self.overlapping = timed and supported.has_continuous_time()
        # Engines that plan with time are not asked to compile conditional effects away: that would be wrong with time.
        conditional = self.overlapping or supported.has_conditional_effects()
        features = Features(self.overlapping, supported.has_negative_conditions(), conditional)
        self._problem = PropositionalProblem(task, features, alone=engine == DEFAULT_ENGINE)
        missing = self._problem.problem.kind.features - supported.features
        if missing:
            words = ", ".join(sorted(feature.lower().replace("_", " ") for feature in missing))
            hint = f"use another, such as {DEFAULT_ENGINE}: {', '.join(planners())}"
            raise InputError(Problem(f"the engine '{engine}' cannot plan this task: it lacks {words}", hint=hint))
        choices = _SEARCHES if engine == DEFAULT_ENGINE else ({},)
        self._engines = [made_by(**given) for given in choices]
        for chosen in self._engines:
            chosen.skip_checks = True

    def solve(self, state: State, excluded: Collection[int]) -> TimedOperators | None:
        """Ask the engine; where it has several searches, the next when one finds nothing."""
        self._problem.set_initial_state(state, excluded)
        for engine in self._engines:
            found = self._answer(engine)
            if found is not None:
                return found
        return None

    def close(self) -> None:
        """Let go of the engines."""
        for engine in self._engines:
            engine.destroy()

    def _answer(self, engine: Any) -> TimedOperators | None:
        from unified_planning.engines import PlanGenerationResultStatus as Outcome

        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                result = engine.solve(self._problem.problem)
        except Exception as error:
            # Engines are programs of others: whatever they raise, the robot must go on.
            message = str(error).strip().splitlines() or [""]
            raise PlannerFailedError(f"{self.name} failed: {type(error).__name__} {message[0]}".rstrip()) from error
        if result.status in (Outcome.UNSOLVABLE_PROVEN, Outcome.UNSOLVABLE_INCOMPLETELY):
            return None
        if result.plan is None:
            raise PlannerFailedError(f"{self.name} failed: it ended with '{result.status.name.lower()}' and no plan")
        return list(self._operators(result.plan))

    def _operators(self, plan: Any) -> TimedOperators:
        from unified_planning.plans import PlanKind

        if plan.kind is PlanKind.TIME_TRIGGERED_PLAN:
            timed = [(instance.action, float(start)) for start, instance, _ in plan.timed_actions]
        else:
            if plan.kind is not PlanKind.SEQUENTIAL_PLAN:
                plan = plan.convert_to(PlanKind.SEQUENTIAL_PLAN, self._problem.problem)
            timed = [(instance.action, float(place)) for place, instance in enumerate(plan.actions)]
        pairs = [(self._problem.operator(action), start) for action, start in timed]
        return [(operator, start) for operator, start in pairs if operator is not None]


def planners() -> list[str]:
    """The engines that are installed and make plans."""
    factory = _factory()
    # Names in brackets are of engines that only pass on to another one.
    return sorted(name for name in factory.engines if "[" not in name and factory.engine(name).is_oneshot_planner())


def _factory() -> Any:
    from unified_planning.environment import get_environment

    return get_environment().factory


def _engine_class(name: str) -> Any:
    known = planners()
    if name in known:
        return _factory().engine(name)
    package = _PACKAGES.get(name)
    hint = f"install {package}" if package else nearest(name, known) or f"installed are: {', '.join(known)}"
    raise InputError(Problem(f"there is no engine '{name}'", hint=hint))
