"""When a plan is no longer good, and the next one."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

from rosa_core import Clock
from task_layer.pddl.errors import PlannerFailedError
from task_layer.pddl.execution.belief import Belief
from task_layer.pddl.execution.feasibility import FeasibilityBridge
from task_layer.pddl.execution.records import ExecutionLimits, Failures, PlanRecord
from task_layer.pddl.grounding.ground_task import Operator, State, apply
from task_layer.pddl.grounding.reachability import Obstacle
from task_layer.pddl.planning.plan import Plan, followed_by
from task_layer.pddl.planning.planner import Planned, Planner


class Replanner:
    """Keeps a plan that reaches the goal from what is believed to hold.

    Args:
        planner: makes the plans.
        bridge: knows what is feasible.
        belief: knows what holds.
        failures: knows what is not to be tried.
        limits: when to give up.
        clock: where the time comes from.
        on_plan: hears of every plan, and of every time that there is none.
    """

    def __init__(
        self,
        planner: Planner,
        bridge: FeasibilityBridge,
        belief: Belief,
        failures: Failures,
        limits: ExecutionLimits,
        clock: Clock,
        on_plan: Callable[[PlanRecord], None],
    ) -> None:
        self._planner = planner
        self._bridge = bridge
        self._belief = belief
        self._failures = failures
        self._limits = limits
        self._clock = clock
        self._on_plan = on_plan
        self._hopeless: tuple[State, frozenset[int], tuple[int, ...]] | None = None
        self._ask_again = 0.0
        self.made = 0
        """How many plans were made."""
        self.why_none = ""
        """Why there is no plan, after the latest time that there was none."""

    def flaw(self, plan: Plan, ended: Collection[int], running: Collection[int]) -> str | None:
        """Why what is left of a plan will not do; None if it will."""
        state, excluded = self._belief.expected(), self.excluded()
        if excluded:
            for index, step in enumerate(plan.steps):
                if step.operator.index in excluded and index not in ended and index not in running:
                    return f"{step.operator.name} cannot be done"
        if plan.reaches_goal(state, ended, running):
            return None
        found = plan.first_flaw(state, ended, running)
        if found is None:
            return "what is left of the plan does not reach the goal"
        step, missing = found
        unfeasible = [name for name, bit in self._planner.task.feasibility.items() if bit & missing.positive]
        if unfeasible:
            return f"{', '.join(unfeasible)} unfeasible"
        return f"{step.operator.name} needs {', '.join(self._planner.task.literals_of(missing))}"

    def excluded(self) -> frozenset[int]:
        """The operators, by index, that cannot be used now."""
        barred = self._failures.barred(self._clock.now())
        unfeasible = self._bridge.excluded()
        if not barred:
            return unfeasible
        return unfeasible | {operator.index for operator in self._planner.task.operators if operator.name in barred}

    def next_plan(self, reason: str, running: Sequence[Operator]) -> tuple[Plan, bool] | None:
        """A new plan, if there is one.

        What runs is kept if there is a plan that goes on from its end: then it is the plan's beginning. As long as
        nothing has changed since there was no plan, the planner is not asked again.

        Returns:
            the plan, and whether it begins with what runs; or None.
        """
        state, excluded = self._belief.expected(), self.excluded()
        key = (state, excluded, tuple(operator.index for operator in running))
        if key == self._hopeless and self._clock.now() < self._ask_again:
            return None
        try:
            found = self._found(state, excluded, running)
        except PlannerFailedError as error:
            self._none(str(error), key, self._limits.retry_delay, reason, 0.0)
            return None
        planned, kept = found
        if planned.plan is None:
            self._none(str(planned.no_plan), key, float("inf"), reason, planned.cost_s)
            return None
        self.made += 1
        self._hopeless = None
        self._record(reason, planned.plan.names, len(running) if kept else 0, "", planned.cached, planned.cost_s)
        return planned.plan, kept

    def _found(self, state: State, excluded: frozenset[int], running: Sequence[Operator]) -> tuple[Planned, bool]:
        obstacles = self._obstacles()
        spent = 0.0
        after = self._after(state, running)
        if running and after is not None:
            planned = self._planner.plan(after, excluded, obstacles)
            if planned.plan is not None:
                return replace(planned, plan=followed_by(running, planned.plan)), True
            spent = planned.cost_s
        planned = self._planner.plan(state, excluded, obstacles)
        return replace(planned, cost_s=planned.cost_s + spent), not running

    def _after(self, state: State, running: Sequence[Operator]) -> State | None:
        """The state once everything that runs has ended; None if something could not end as it should."""
        for operator in running:
            if not operator.over_all.also(operator.at_end).holds(state):
                return None
            state = apply(state, operator.end_effects)
        return state

    def _obstacles(self) -> dict[str, Obstacle]:
        """What is in the way: unfeasible actions, and steps that failed."""
        found = {f"{action} (unfeasible)": obstacle for action, obstacle in self._bridge.obstacles().items()}
        for step, times in self._failures.barred(self._clock.now()).items():
            same = frozenset(operator.index for operator in self._planner.task.operators if operator.name == step)
            found[f"{step} (failed {times} {'time' if times == 1 else 'times'})"] = Obstacle(operators=same)
        return found

    def _none(
        self, why: str, key: tuple[State, frozenset[int], tuple[int, ...]], delay: float, reason: str, cost_s: float
    ) -> None:
        self.why_none = why
        self._hopeless = key
        self._ask_again = self._clock.now() + delay
        self._record(reason, (), 0, why, False, cost_s)

    def _record(self, reason: str, steps: tuple[str, ...], kept: int, why: str, cached: bool, cost_s: float) -> None:
        engine = self._planner.engine
        self._on_plan(PlanRecord(self._clock.now(), reason, steps, kept, why, cached, engine, cost_s))
