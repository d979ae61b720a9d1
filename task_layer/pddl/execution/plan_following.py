"""Follows a plan, and has a new one made when the world makes the present one wrong."""

from __future__ import annotations

import math
from collections.abc import Container, Sequence

from task_layer.pddl.execution.context import ExecutionContext
from task_layer.pddl.execution.records import ExecutionStatus
from task_layer.pddl.execution.replanning import Replanner
from task_layer.pddl.execution.step_execution import StepExecution
from task_layer.pddl.planning.plan import Plan


class PlanFollowing:
    """The strategy of a mission in PDDL, for a :class:`~task_layer.mission_runner.MissionRunner`.

    Args:
        context: what the parts of the execution share.
        steps: carries out the steps.
        replanner: makes the plans.
    """

    most_in_a_row = math.inf
    """How many attempts there are is limited otherwise: by ``limits``."""

    def __init__(self, context: ExecutionContext, steps: StepExecution, replanner: Replanner) -> None:
        self.status = ExecutionStatus.RUNNING
        self.plan: Plan | None = None
        self.feedback = ""
        self._context = context
        self._limits = context.limits
        self._steps = steps
        self._replanner = replanner
        self._waiting_since: float | None = None

    @property
    def is_over(self) -> bool:
        """Whether the goal is reached, or it has given up."""
        return self.status.is_over

    def tick(self) -> None:
        """See how far all steps have got, and start those whose turn it is."""
        if not self.is_over:
            self._note_missed_effects()
            self._advance(
                list(self._steps.running), {required.action for required in self._context.kb.required_actions()}
            )

    def follow_up(self) -> None:
        """See how far the steps have got whose requests were answered in this tick."""
        if not self.is_over:
            self._advance(self._steps.just_begun, None)

    def gets_on(self) -> bool:
        """A plan asks for another tick only when a step has ended."""
        return True

    def settle(self) -> None:
        """There is nothing that it has tried in vain: as long as nothing changes, the planner is not asked again."""

    def halt(self) -> None:
        """Interrupt whatever runs; the plan stays."""
        self._steps.interrupt_all("the mission is over")

    def close(self) -> None:
        """There is nothing to let go of."""

    def _advance(self, followed: Sequence[int], required: Container[str] | None) -> None:
        """Follow some steps and start others, as long as some begin: those that request nothing do so at once."""
        while True:
            self._steps.follow(followed, required)
            # What is requested in this tick is not written before its end.
            required = None
            if self._context.task.is_goal(self._context.belief.now()):
                self.status = ExecutionStatus.RUNNING if self._steps.running else ExecutionStatus.SUCCESS
                return
            plan = self._good_plan()
            if plan is None:
                self._wait_for_plan()
                return
            self._waiting_since = None
            self.status = ExecutionStatus.RUNNING
            self._steps.start_ready(plan)
            followed = self._steps.just_begun
            if not followed:
                return

    def _note_missed_effects(self) -> None:
        for operator, fact in self._context.belief.missed_effects():
            self._context.failures.add(operator.name, self._context.clock.now())
            self._steps.deviations.append(f"{fact} did not become as {operator.name} should have made it")

    def _good_plan(self) -> Plan | None:
        """The present plan if it still reaches the goal, or else a new one, if there is one."""
        flaw = None
        if self.plan is not None:
            flaw = self._replanner.flaw(self.plan, self._steps.ended, self._steps.running)
            if flaw is None:
                self._steps.deviations.clear()
                return self.plan
        found = self._replanner.next_plan(self._why_new(flaw), self._steps.operators)
        if found is None:
            return None
        if self._replanner.made > self._limits.replans + 1:
            self._give_up(f"{self._limits.replans} new plans were made, and none reached the goal")
            return None
        self.plan, kept = found
        self._steps.begin_plan(kept=kept)
        return self.plan

    def _why_new(self, flaw: str | None) -> str:
        """Why a new plan is wanted: what went wrong if something has, or else what is wrong with the present one."""
        if self._steps.deviations:
            return "; ".join(self._steps.deviations)
        return flaw or ("there was no plan before" if self._context.log.plans else "the mission begins")

    def _wait_for_plan(self) -> None:
        if self.is_over:
            return
        if self._steps.running:
            self.status = ExecutionStatus.RUNNING
            return
        self.plan = None
        self.status = ExecutionStatus.WAITING
        self.feedback = self._replanner.why_none
        now = self._context.clock.now()
        if self._waiting_since is None:
            self._waiting_since = now
        if now - self._waiting_since >= self._limits.patience:
            self._give_up(f"no plan for {self._limits.patience:g} s: {self.feedback}")

    def _give_up(self, reason: str) -> None:
        self.status = ExecutionStatus.FAILURE
        self.feedback = reason
        self._steps.interrupt_all(reason)
