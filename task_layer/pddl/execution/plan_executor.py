"""Carries out plans on the knowledge base, and has new ones made when the world makes the present one wrong."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Container, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from types import TracebackType

from rosa_core import Clock, KnowledgeBase, Result
from rosa_core.kb import Event, MonitoringData
from task_layer.action_requests import ActionRequests
from task_layer.pddl.execution.belief import Belief
from task_layer.pddl.execution.feasibility import FeasibilityBridge
from task_layer.pddl.execution.records import (
    ExecutionLimits,
    ExecutionStatus,
    Failures,
    OnRaise,
    PlanRecord,
    StepOutcome,
    StepRecord,
    log_raised,
)
from task_layer.pddl.execution.replanning import Replanner
from task_layer.pddl.execution.running_step import RunningStep, SkillSource, find_skills
from task_layer.pddl.execution.sensing import NO_SENSORS, SensedFacts, Sensor
from task_layer.pddl.grounding.ground_task import Operator
from task_layer.pddl.planning.plan import Plan
from task_layer.pddl.planning.planner import Planner
from task_layer.skill import Skill, SkillStatus
from task_layer.waking import WAKING, changes_feasibility

_NO_ACTIONS: Mapping[str, str] = {}
_DEFAULT_LIMITS = ExecutionLimits()


class PlanExecutor:
    """Performs a mission that is written in PDDL.

    It looks at the world when a status, an activity or a required action changes, when a sensed measure is measured,
    and at least every ``period`` seconds, so that skills get on. What is left of the plan is then checked against what
    holds; only if it no longer reaches the goal a new plan is made, which keeps what runs if it can. Steps are started
    when what they require at their start and throughout holds and their actions are feasible. A step ends when its
    skill does; it is stopped when something that it requires throughout no longer holds. All requests to the knowledge
    base of one look are one change of it.

    Args:
        planner: makes the plans; it is not closed with the executor.
        kb: the knowledge base.
        skills: for each action of the domain the skill that carries it out, or a function that makes the skill from the
            names of the step's objects.
        period: seconds between looks when nothing happens.
        clock: by default the knowledge base's.
        actions: actions of the knowledge base by the names of the domain's objects and actions, where they differ.
        sensors: how facts are sensed; see :class:`~task_layer.pddl.execution.sensing.SensedFacts`.
        limits: when to give up.
        around_tick: makes a context in which each look runs, for measuring what it costs.
        on_plan: hears of every plan, and of every time that there is none.
        on_step: hears when a step starts and ends.
        on_raise: hears of a step whose skill raised, or a fact whose sensor did, with its ``name``, and of the
            exception; by default it is logged. The step has failed then, the fact is not known; the mission goes on.

    Raises:
        InputError: if an action has no skill, or names do not fit together.
    """

    def __init__(
        self,
        planner: Planner,
        kb: KnowledgeBase,
        skills: Mapping[str, SkillSource],
        *,
        period: float = 0.1,
        clock: Clock | None = None,
        actions: Mapping[str, str] = _NO_ACTIONS,
        sensors: Mapping[str, Sensor] = NO_SENSORS,
        limits: ExecutionLimits = _DEFAULT_LIMITS,
        around_tick: Callable[[], AbstractContextManager[None]] = nullcontext,
        on_plan: Callable[[PlanRecord], None] | None = None,
        on_step: Callable[[StepRecord], None] | None = None,
        on_raise: OnRaise = log_raised,
    ) -> None:
        if not period > 0:
            raise ValueError(f"the period must be positive, not {period}")
        self.clock: Clock = clock or kb.clock
        self.period = period
        self.status = ExecutionStatus.RUNNING
        self.plan: Plan | None = None
        self.plans: list[PlanRecord] = []
        """Every plan that was made, and every time that there was none."""
        self.steps: list[StepRecord] = []
        """What became of the steps."""
        self.feedback = ""
        """Why it waits, or has failed."""
        self._kb = kb
        self._task = planner.task
        self._limits = limits
        self._skills = find_skills(self._task, skills)
        self._bridge = FeasibilityBridge(kb, self._task, actions)
        self._sensed = SensedFacts(self._task, sensors, kb, on_raise)
        self._belief = Belief(self._task, self._bridge, self._sensed, self.clock, limits.effect_delay)
        self._failures = Failures(limits)
        self._replanner = Replanner(
            planner, self._bridge, self._belief, self._failures, limits, self.clock, self._tell_plan
        )
        self._requests = ActionRequests(kb)
        self._around_tick = around_tick
        self._on_plan, self._on_step, self._on_raise = on_plan, on_step, on_raise
        self._running: dict[int, RunningStep] = {}
        self._ended: set[int] = set()
        self._news: list[str] = []
        self._waiting_since: float | None = None
        self._wake = threading.Event()
        self._interrupted = False
        events = (*WAKING, MonitoringData) if self._sensed.measures else WAKING
        self._unsubscribe = kb.subscribe(self._on_event, events)

    def wake(self) -> None:
        """Look soon: something happened that is not in the knowledge base. Any thread may call this."""
        self._wake.set()

    def tick(self) -> ExecutionStatus:
        """Look once, and do what is to be done; the requests made meanwhile are written at the end."""
        with self._around_tick(), self._requests.together():
            self._advance()
        return self.status

    def run(self, *, timeout: float = math.inf, until: Callable[[], bool] | None = None) -> ExecutionStatus:
        """Go on until the goal is reached, it gives up, ``until()`` is true, or ``timeout`` seconds are over.

        Whatever is then still running is interrupted.

        Returns:
            how far it got; RUNNING or WAITING if it was stopped before it was done.
        """
        deadline = self.clock.now() + timeout
        self._interrupted = False
        try:
            while True:
                self._wake.clear()
                self.tick()
                left = deadline - self.clock.now()
                if self._is_over or self._interrupted or left <= 0 or (until is not None and until()):
                    return self.status
                self.clock.wait(self._wake, min(self.period, left))
        finally:
            with self._requests.together():
                self._interrupt_all("the mission is over")

    def interrupt(self) -> None:
        """Let :meth:`run` stop after the present look. Any thread may call this."""
        self._interrupted = True
        self._wake.set()

    def close(self) -> None:
        """Listen to the knowledge base no longer."""
        self._unsubscribe()

    def __enter__(self) -> PlanExecutor:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    # -- one look --

    @property
    def _is_over(self) -> bool:
        return self.status in (ExecutionStatus.SUCCESS, ExecutionStatus.FAILURE)

    def _advance(self) -> None:
        if self._is_over:
            return
        self._take_disappointments()
        attended = list(self._running)
        required: Container[str] | None = {action.action for action in self._kb.required_actions()}
        while True:
            progress = self._attend(attended, required)
            # What is requested in this look is not written before its end.
            required = None
            if self._task.is_goal(self._belief.now()):
                self.status = ExecutionStatus.RUNNING if self._running else ExecutionStatus.SUCCESS
                return
            plan = self._good_plan()
            if plan is None:
                self._wait_for_plan()
                return
            self._waiting_since = None
            self.status = ExecutionStatus.RUNNING
            attended = self._start_ready(plan)
            if not attended and not progress:
                return

    def _take_disappointments(self) -> None:
        for operator, bit in self._belief.missed_effects():
            (fact,) = self._task.facts_in(bit)
            self._failures.add(operator.name, self.clock.now())
            self._news.append(f"{fact} did not become as {operator.name} should have made it")

    def _attend(self, indices: Sequence[int], required: Container[str] | None) -> bool:
        """See how far running steps have got; whether one of them is over. ``required`` is None if not known."""
        before = len(self._running)
        for index in indices:
            step = self._running[index]
            violated_condition = None if step.trouble else self._violated_condition(step, required)
            if violated_condition is not None:
                self._stop(index, StepOutcome.INTERRUPTED, violated_condition)
                continue
            status = SkillStatus.FAILURE if step.trouble else step.update()
            if status is SkillStatus.SUCCESS:
                self._complete(index)
            elif status is SkillStatus.FAILURE:
                self._stop(index, StepOutcome.FAILED, step.trouble or "its skill failed")
            elif self.clock.now() - step.started >= self._limits.step_timeout:
                self._stop(index, StepOutcome.FAILED, f"it took longer than {self._limits.step_timeout:g} s")
        return len(self._running) < before

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
        step = self._running[index]
        missing = step.operator.at_end.missing(self._belief.now())
        if missing.facts:
            self._stop(index, StepOutcome.FAILED, f"at its end it needs {', '.join(self._task.literals_of(missing))}")
            return
        del self._running[index]
        step.end()
        for action in step.actions:
            self._requests.finish(action, Result.COMPLETED)
        self._ended.add(index)
        if self._belief.take_effect(step.operator, step.operator.end_effects):
            self._failures.reset(step.operator.name)
        self._tell_step(step.operator, StepOutcome.COMPLETED)

    def _stop(self, index: int, outcome: StepOutcome, reason: str) -> None:
        step = self._running.pop(index)
        step.end()
        failed = outcome is StepOutcome.FAILED
        for action in step.actions:
            if failed:
                self._requests.finish(action, Result.FAILED)
            else:
                self._requests.cancel(action)
        if failed:
            self._failures.add(step.operator.name, self.clock.now())
        self._news.append(f"{step.operator.name} {outcome}: {reason}")
        self._tell_step(step.operator, outcome, reason)

    def _interrupt_all(self, reason: str) -> None:
        for index in list(self._running):
            self._stop(index, StepOutcome.INTERRUPTED, reason)

    # -- plans --

    def _good_plan(self) -> Plan | None:
        """The present plan if it still reaches the goal, or else a new one, if there is one."""
        reason = "the mission begins"
        if self.plan is not None:
            flaw = self._replanner.flaw(self.plan, self._ended, self._running.keys())
            if flaw is None:
                self._news.clear()
                return self.plan
            reason = "; ".join(self._news) or flaw
        elif self._news:
            reason = "; ".join(self._news)
        elif self.plans:
            reason = "there was no plan before"
        running = list(self._running.values())
        found = self._replanner.next_plan(reason, [step.operator for step in running])
        if found is None:
            return None
        plan, kept = found
        if self._replanner.made > self._limits.replans + 1:
            self._give_up(f"{self._limits.replans} new plans were made, and none reached the goal")
            return None
        if not kept:
            self._interrupt_all("the new plan has no use for it")
        self._running = dict(enumerate(running)) if kept else {}
        self._ended = set()
        self._news.clear()
        self.plan = plan
        return plan

    def _wait_for_plan(self) -> None:
        if self._is_over:
            return
        if self._running:
            self.status = ExecutionStatus.RUNNING
            return
        self.plan = None
        self.status = ExecutionStatus.WAITING
        self.feedback = self._replanner.why_none
        now = self.clock.now()
        if self._waiting_since is None:
            self._waiting_since = now
        if now - self._waiting_since >= self._limits.patience:
            self._give_up(f"no plan for {self._limits.patience:g} s: {self.feedback}")

    def _give_up(self, reason: str) -> None:
        self.status = ExecutionStatus.FAILURE
        self.feedback = reason
        self._interrupt_all(reason)

    def _start_ready(self, plan: Plan) -> list[int]:
        """Start every step whose turn it is and whose requirements hold; which ones these were."""
        started = []
        for index, step in enumerate(plan.steps):
            if index in self._ended or index in self._running:
                continue
            if not plan.after_starts[index] <= self._ended | self._running.keys():
                continue
            if plan.after_ends[index] <= self._ended and self._can_start(step.operator):
                self._start(index, step.operator)
                started.append(index)
        return started

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
        step = RunningStep(
            operator=operator,
            source=self._skills[operator.action],
            actions=self._bridge.actions(operator),
            started=self.clock.now(),
            on_raise=self._on_raise,
        )
        self._running[index] = step
        for action in step.actions:
            self._requests.request(action, refused=partial(self._refused, step))
        self._belief.take_effect(operator, operator.start_effects)
        self._tell_step(operator, StepOutcome.STARTED)
        if not operator.over_all.holds(self._belief.expected()):
            step.trouble = "its start makes untrue what it needs throughout"
        step.begin()

    def _refused(self, step: RunningStep, reason: str) -> None:
        """The knowledge base refused a request when it was written, after the step had begun."""
        step.trouble = reason
        self._wake.set()

    # -- what happens --

    def _on_event(self, event: Event) -> None:
        if isinstance(event, MonitoringData):
            if any(measurement.measure in self._sensed.measures for measurement in event.measurements):
                self._wake.set()
            return
        if not self._requests.committing or changes_feasibility(event):
            self._wake.set()

    def _tell_plan(self, record: PlanRecord) -> None:
        self.plans.append(record)
        if self._on_plan is not None:
            self._on_plan(record)

    def _tell_step(self, operator: Operator, outcome: StepOutcome, reason: str = "") -> None:
        record = StepRecord(self.clock.now(), operator.name, outcome, reason)
        self.steps.append(record)
        if self._on_step is not None:
            self._on_step(record)
