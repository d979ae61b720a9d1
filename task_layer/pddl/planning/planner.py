"""Plans from any state, with the operators that may be used there."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from types import TracebackType

from task_layer.pddl.grounding.ground_task import GroundTask, Operator, State
from task_layer.pddl.grounding.reachability import NoPlan, Obstacle, explain, unreachable
from task_layer.pddl.planning.engines import DEFAULT_ENGINE, EngineSolver, Solver, TimedOperators
from task_layer.pddl.planning.errors import PlannerFailedError
from task_layer.pddl.planning.plan import Plan, parallel_plan, sequential_plan, timed_plan

_NO_OBSTACLES: Mapping[str, Obstacle] = {}


@dataclass(frozen=True, slots=True)
class PlannerAnswer:
    """The answer of a planner: a plan, or why there is none.

    Attributes:
        plan: the plan.
        no_plan: the reason, if there is no plan.
        cached: whether it was known from before.
        cost_s: the wall-clock time that it took, in s.
    """

    plan: Plan | None
    no_plan: NoPlan | None
    cached: bool
    cost_s: float


class Planner:
    """Makes plans with an engine of unified-planning, and remembers them by state and usable operators.

    If not even the delete relaxation reaches the goal, the engine is not asked. Plans are checked against the
    ground facts before they are given out, and steps that they can do without are left out.

    It is a context manager, which closes it.

    Args:
        task: what is to be planned.
        engine: the engine's name in unified-planning; it may be any that is installed and can do it.
        timeout: the most wall-clock time for a plan, in s. With one, the engine runs in a process of its own, which is
            ended when time is up; without, in this process, as long as it takes.
        parallel: whether steps that do not interfere may run at once.
        remembered: how many answers to remember.

    Raises:
        InputError: if there is no such engine, or it cannot plan this task.
        PlannerFailedError: if the engine's process cannot be started.
        ValueError: if the timeout is not positive.

    Example:
        >>> from task_layer.pddl import parse_task
        >>> task = parse_task(
        ...     "(define (domain d) (:predicates (there)) (:action go :parameters () :effect (there)))",
        ...     "(define (problem p) (:domain d) (:init) (:goal (there)))",
        ... )
        >>> with Planner(task) as planner:
        ...     print(planner.plan().plan.names)
        ('(go)',)
    """

    def __init__(
        self,
        task: GroundTask,
        *,
        engine: str = DEFAULT_ENGINE,
        timeout: float | None = None,
        parallel: bool = False,
        remembered: int = 256,
    ) -> None:
        self.task = task
        self.engine = engine
        self._parallel = parallel
        self._remembered = remembered
        self._answers: OrderedDict[tuple[State, frozenset[int]], Plan | None] = OrderedDict()
        self._solver: Solver
        if timeout is None:
            self._solver = EngineSolver(task, engine)
        else:
            from task_layer.pddl.planning.planner_process import ProcessSolver

            self._solver = ProcessSolver(task, engine, timeout)

    def plan(
        self,
        state: State | None = None,
        excluded: Collection[int] = frozenset(),
        obstacles: Mapping[str, Obstacle] = _NO_OBSTACLES,
    ) -> PlannerAnswer:
        """A plan from a state to the goal.

        Args:
            state: from where, a mask of facts; by default the problem file's initial state.
            excluded: operators, by index, that may not be used.
            obstacles: what may be in the way when there is no plan, by name.

        Returns:
            the plan, or why there is none.

        Raises:
            PlannerFailedError: if it is not known whether there is a plan.
        """
        began = time.perf_counter()
        state = self.task.initial if state is None else state
        key = (state, frozenset(excluded))
        cached = key in self._answers
        plan = self._answers.pop(key) if cached else self._solve(state, key[1])
        self._answers[key] = plan
        if len(self._answers) > self._remembered:
            self._answers.popitem(last=False)
        no_plan = None if plan is not None else self.why_none(state, key[1], obstacles)
        return PlannerAnswer(plan, no_plan, cached, time.perf_counter() - began)

    def why_none(self, state: State, excluded: Collection[int], obstacles: Mapping[str, Obstacle]) -> NoPlan:
        """Why there is no plan, if there is none.

        Args:
            state: from where, a mask of facts.
            excluded: operators, by index, that may not be used.
            obstacles: what may be in the way, by name.
        """
        return explain(self.task, state, excluded, obstacles) or NoPlan()

    def close(self) -> None:
        """End the engine's process, if it has one."""
        self._solver.close()

    def __enter__(self) -> Planner:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def _solve(self, state: State, excluded: frozenset[int]) -> Plan | None:
        if self.task.is_goal(state):
            return sequential_plan(self.task, ())
        if explain(self.task, state, excluded, _NO_OBSTACLES) is not None:
            return None
        found = self._solver.solve(state, excluded | unreachable(self.task, state, excluded))
        if found is None:
            return None
        plan = self._as_plan(found, state)
        if not plan.reaches_goal(state):
            raise PlannerFailedError(f"{self.engine} failed: its plan does not reach the goal: {' '.join(plan.names)}")
        return plan

    def _as_plan(self, found: TimedOperators, state: State) -> Plan:
        if self._solver.overlapping:
            return timed_plan(self.task, found)
        operators = without_redundant(self.task, [operator for operator, _ in found], state)
        return parallel_plan(self.task, operators) if self._parallel else sequential_plan(self.task, operators)


def without_redundant(task: GroundTask, operators: list[Operator], state: State) -> list[Operator]:
    """The plan without the steps that it can do without, the first such step first.

    Args:
        task: what it is a plan for.
        operators: the steps, in order.
        state: from where.

    Source: action elimination, Nakhost and Mueller (2010), with one step at a time.
    """
    plan = sequential_plan(task, operators)
    redundant: set[int] = set()
    for index in range(len(operators)):
        if plan.reaches_goal(state, ended={*redundant, index}):
            redundant.add(index)
    return [operator for index, operator in enumerate(operators) if index not in redundant]
