"""When a plan is no longer good, and the next one."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from task_layer.pddl.execution.context import ExecutionContext
from task_layer.pddl.execution.records import PlanRecord
from task_layer.pddl.grounding.ground_task import Operator, State, apply
from task_layer.pddl.grounding.reachability import Obstacle
from task_layer.pddl.planning.errors import PlannerFailedError
from task_layer.pddl.planning.plan import Plan, continued_plan
from task_layer.pddl.planning.planner import Planner, PlannerAnswer


class Replanner:
    """Keeps a plan that reaches the goal from what is believed to hold.

    Args:
        context: what the parts of the execution share.
        planner: makes the plans.
    """

    def __init__(self, context: ExecutionContext, planner: Planner) -> None:
        self._planner = planner
        self._task = context.task
        self._clock = context.clock
        self._retry_delay = context.limits.retry_delay
        self._bridge = context.bridge
        self._belief = context.belief
        self._failures = context.failures
        self._log = context.log
        self._unsolved: tuple[State, frozenset[int], tuple[int, ...]] | None = None
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
        unfeasible = [name for name, bit in self._task.feasibility.items() if bit & missing.positive]
        if unfeasible:
            return f"{', '.join(unfeasible)} unfeasible"
        return f"{step.operator.name} needs {', '.join(self._task.literals_of(missing))}"

    def excluded(self) -> frozenset[int]:
        """The operators, by index, that cannot be used now."""
        suspended = self._failures.suspended(self._clock.now())
        unfeasible = self._bridge.excluded()
        if not suspended:
            return unfeasible
        return unfeasible | {operator.index for operator in self._task.operators if operator.name in suspended}

    def next_plan(self, reason: str, running: Sequence[Operator]) -> tuple[Plan, bool] | None:
        """A new plan, if there is one.

        What runs is kept if there is a plan that goes on from its end: then it is the plan's beginning. As long as
        nothing has changed since there was no plan, the planner is not asked again.

        Returns:
            the plan, and whether it begins with what runs; or None.
        """
        state, excluded = self._belief.expected(), self.excluded()
        key = (state, excluded, tuple(operator.index for operator in running))
        if key == self._unsolved and self._clock.now() < self._ask_again:
            return None
        try:
            found = self._found(state, excluded, running)
        except PlannerFailedError as error:
            self._none(str(error), key, self._retry_delay, reason, 0.0)
            return None
        answer, kept = found
        if answer.plan is None:
            why = self._planner.why_none(state, excluded, self._obstacles())
            self._none(str(why), key, float("inf"), reason, answer.cost_s)
            return None
        self.made += 1
        self._unsolved = None
        self._record(reason, answer.plan.names, len(running) if kept else 0, "", answer.cached, answer.cost_s)
        return answer.plan, kept

    def _found(self, state: State, excluded: frozenset[int], running: Sequence[Operator]) -> tuple[PlannerAnswer, bool]:
        """The planner's answer, and whether it keeps what runs."""
        spent = 0.0
        after = self._after(state, running)
        if running and after is not None:
            answer = self._planner.plan(after, excluded)
            if answer.plan is not None:
                return replace(answer, plan=continued_plan(running, answer.plan)), True
            spent = answer.cost_s
        answer = self._planner.plan(state, excluded)
        return replace(answer, cost_s=answer.cost_s + spent), not running

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
        for step, times in self._failures.suspended(self._clock.now()).items():
            same = frozenset(operator.index for operator in self._task.operators if operator.name == step)
            found[f"{step} (failed {times} {'time' if times == 1 else 'times'})"] = Obstacle(operators=same)
        return found

    def _none(
        self, why: str, key: tuple[State, frozenset[int], tuple[int, ...]], delay: float, reason: str, cost_s: float
    ) -> None:
        self.why_none = why
        self._unsolved = key
        self._ask_again = self._clock.now() + delay
        self._record(reason, (), 0, why, False, cost_s)

    def _record(self, reason: str, steps: tuple[str, ...], kept: int, why: str, cached: bool, cost_s: float) -> None:
        engine = self._planner.engine
        self._log.add_plan(PlanRecord(self._clock.now(), reason, steps, kept, why, cached, engine, cost_s))
