"""Starts the steps of a plan whose turn it is, follows them, and ends them."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Set

from rosa_core import Result
from task_layer.action_requests import ActionRequests
from task_layer.mission_part import OnRaise
from task_layer.pddl.execution.context import ExecutionContext
from task_layer.pddl.execution.records import StepOutcome, StepRecord
from task_layer.pddl.execution.running_step import RunningStep, SkillSource
from task_layer.pddl.grounding.ground_task import Operator
from task_layer.pddl.planning.plan import Plan
from task_layer.skill import Skill, SkillStatus

_RESULTS = {
    StepOutcome.COMPLETED: Result.COMPLETED,
    StepOutcome.FAILED: Result.FAILED,
    StepOutcome.INTERRUPTED: Result.ABANDONED,
}


class StepExecution:
    """The steps of the present plan that run and that have ended, by their places in the plan.

    Args:
        context: what the parts of the execution share.
        skills: for each action of the domain what carries it out.
        requests: the way to the knowledge base.
        on_raise: hears of what skills raise.
    """

    def __init__(
        self,
        context: ExecutionContext,
        skills: Mapping[str, SkillSource],
        requests: ActionRequests,
        on_raise: OnRaise,
    ) -> None:
        self._task = context.task
        self._clock = context.clock
        self._bridge = context.bridge
        self._belief = context.belief
        self._failures = context.failures
        self._step_timeout = context.limits.step_timeout
        self._log = context.log
        self._skills = skills
        self._requests = requests
        self._on_raise = on_raise
        self._running: dict[int, RunningStep] = {}
        self.ended: set[int] = set()
        self.deviations: list[str] = []
        """In what way steps have not gone as planned, since this was last cleared."""

    @property
    def running(self) -> Set[int]:
        """The steps that have started and not ended."""
        return self._running.keys()

    @property
    def just_begun(self) -> list[int]:
        """The running steps that have begun, or failed to, and have not been followed since."""
        return [index for index, step in self._running.items() if step.just_begun]

    @property
    def operators(self) -> list[Operator]:
        """What runs."""
        return [step.operator for step in self._running.values()]

    def follow(self, indices: Iterable[int], required: Container[str] | None) -> None:
        """See how far running steps have got.

        Args:
            indices: which of them.
            required: the actions that the knowledge base has as required; None if it has not been asked.
        """
        for index in indices:
            step = self._running[index]
            violated_condition = None if step.trouble else self._violated_condition(step, required)
            if violated_condition is not None:
                self._stop(index, StepOutcome.INTERRUPTED, violated_condition)
                continue
            status = step.update()
            if status is SkillStatus.SUCCESS:
                self._complete(index)
            elif status is SkillStatus.FAILURE:
                self._stop(index, StepOutcome.FAILED, step.trouble or "its skill failed")
            elif self._clock.now() - step.started >= self._step_timeout:
                self._stop(index, StepOutcome.FAILED, f"it took longer than {self._step_timeout:g} s")

    def start_ready(self, plan: Plan) -> None:
        """Start every step whose turn it is and whose requirements hold."""
        for index, step in enumerate(plan.steps):
            if index in self.ended or index in self._running:
                continue
            if not plan.after_starts[index] <= self.ended | self._running.keys():
                continue
            if plan.after_ends[index] <= self.ended and self._can_start(step.operator):
                self._start(index, step.operator)

    def begin_plan(self, *, kept: bool) -> None:
        """Go over to another plan.

        Args:
            kept: whether it begins with what runs; what runs is interrupted otherwise.
        """
        if not kept:
            self.interrupt_all("the new plan has no use for it")
        self._running = dict(enumerate(self._running.values()))
        self.ended = set()
        self.deviations.clear()

    def interrupt_all(self, reason: str) -> None:
        """Stop whatever runs."""
        for index in list(self._running):
            self._stop(index, StepOutcome.INTERRUPTED, reason)

    def _violated_condition(self, step: RunningStep, required: Container[str] | None) -> str | None:
        """Why a running step may not go on: the world has changed, which is not the step's fault."""
        unfeasible = self._bridge.unfeasible_action(step.operator)
        if unfeasible is not None:
            return self._bridge.why(unfeasible)
        missing = step.operator.over_all.missing(self._belief.expected())
        if missing.facts:
            return f"it needs {', '.join(self._task.literals_of(missing))} throughout"
        if required is not None and any(action not in required for action in step.actions):
            step.trouble = "its action was ended in the knowledge base"
        return None

    def _complete(self, index: int) -> None:
        operator = self._running[index].operator
        missing = operator.at_end.missing(self._belief.now())
        if missing.facts:
            self._stop(index, StepOutcome.FAILED, f"at its end it needs {', '.join(self._task.literals_of(missing))}")
            return
        self._end(index, StepOutcome.COMPLETED)
        self.ended.add(index)
        if self._belief.take_effect(operator, operator.end_effects):
            self._failures.reset(operator.name)
        self._report(operator, StepOutcome.COMPLETED)

    def _stop(self, index: int, outcome: StepOutcome, reason: str) -> None:
        operator = self._end(index, outcome)
        if outcome is StepOutcome.FAILED:
            self._failures.add(operator.name, self._clock.now())
        self.deviations.append(f"{operator.name} {outcome}: {reason}")
        self._report(operator, outcome, reason)

    def _end(self, index: int, outcome: StepOutcome) -> Operator:
        step = self._running.pop(index)
        step.end(self._requests, _RESULTS[outcome])
        return step.operator

    def _can_start(self, operator: Operator) -> bool:
        if not operator.to_start.holds(self._belief.now()) or self._bridge.unfeasible_action(operator) is not None:
            return False
        source = self._skills[operator.action]
        needed = set(self._bridge.actions(operator))
        return not any(
            needed.intersection(other.actions) or (isinstance(source, Skill) and other.source is source)
            for other in self._running.values()
        )

    def _start(self, index: int, operator: Operator) -> None:
        source, actions = self._skills[operator.action], self._bridge.actions(operator)
        step = self._running[index] = RunningStep(operator, source, actions, self._clock.now(), self._on_raise)
        self._belief.take_effect(operator, operator.start_effects)
        self._report(operator, StepOutcome.STARTED)
        if not operator.over_all.holds(self._belief.expected()):
            step.fail("its start makes untrue what it needs throughout")
        else:
            step.start(self._requests)

    def _report(self, operator: Operator, outcome: StepOutcome, reason: str = "") -> None:
        self._log.add_step(StepRecord(self._clock.now(), operator.name, outcome, reason))
