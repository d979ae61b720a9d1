"""Carries out a mission in PDDL on the knowledge base."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext

from rosa_core import Clock, KnowledgeBase
from task_layer.action_requests import ActionRequests
from task_layer.mission_part import OnRaise, log_raised
from task_layer.mission_runner import MissionRunner
from task_layer.pddl.execution.belief import Belief
from task_layer.pddl.execution.context import ExecutionContext
from task_layer.pddl.execution.feasibility import FeasibilityBridge
from task_layer.pddl.execution.limits import ExecutionLimits, Failures
from task_layer.pddl.execution.plan_following import PlanFollowing
from task_layer.pddl.execution.records import ExecutionLog, ExecutionStatus, PlanRecord, StepRecord
from task_layer.pddl.execution.replanning import Replanner
from task_layer.pddl.execution.running_step import SkillSource, find_skills
from task_layer.pddl.execution.sensing import NO_SENSORS, SensedFacts, Sensor
from task_layer.pddl.execution.step_execution import StepExecution
from task_layer.pddl.planning.plan import Plan
from task_layer.pddl.planning.planner import Planner

_NO_ACTIONS: Mapping[str, str] = {}
_DEFAULT_LIMITS = ExecutionLimits()


class PlanExecutor(MissionRunner[ExecutionStatus]):
    """Performs a mission that is written in PDDL.

    When it is ticked, and what the knowledge base sees of a tick, is the same for trees and plans: see
    :class:`~task_layer.mission_runner.MissionRunner`; it is also ticked when a sensed measure is measured. What is left
    of the plan is then checked against what holds; only if it no longer reaches the goal a new plan is made, which
    keeps what runs if it can. Steps are started when what they require at their start and throughout holds and their
    actions are feasible. A step ends when its skill does; it is stopped when something that it requires throughout no
    longer holds.

    Args:
        planner: makes the plans; it is not closed with the executor.
        kb: the knowledge base.
        skills: for each action of the domain the skill that carries it out, or a function that makes the skill from the
            names of the step's objects.
        period: seconds between ticks when nothing happens.
        clock: by default the knowledge base's.
        actions: actions of the knowledge base by the names of the domain's objects and actions, where they differ.
        sensors: how facts are sensed; see :class:`~task_layer.pddl.execution.sensing.SensedFacts`.
        limits: when to give up.
        around_tick: makes a context in which each tick runs, for measuring what ticks cost.
        on_plan: hears of every plan, and of every time that there is none.
        on_step: hears when a step starts and ends.
        on_raise: hears of a step whose skill raised, or a fact whose sensor did, with its ``name``, and of the
            exception; by default it is logged. The step has failed then, the fact is not known; the mission goes on.

    Raises:
        InputError: if an action has no skill, or names do not fit together.
        UnknownElementError: if the knowledge base has no such sensed measure.
        ValueError: if the period is not positive.

    Example:
        >>> from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
        >>> from task_layer.pddl import Planner, parse_task
        >>> from task_layer.skill import WaitUntil
        >>> task = parse_task(
        ...     "(define (domain d) (:predicates (there)) (:action go :parameters () :effect (there)))",
        ...     "(define (problem p) (:domain d) (:init) (:goal (there)))",
        ... )
        >>> kb = KnowledgeBase(KnowledgeModel(), clock=SimulationClock())
        >>> with Planner(task) as planner, PlanExecutor(planner, kb, {"go": WaitUntil(lambda: True)}) as executor:
        ...     print(executor.run(timeout=10.0), executor.plans[0])
        ExecutionStatus.SUCCESS plan (go) (the mission begins)
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
        task, time = planner.task, clock or kb.clock
        sources = find_skills(task, skills)
        bridge = FeasibilityBridge(kb, task, actions)
        sensed = SensedFacts(task, sensors, kb, on_raise)
        belief = Belief(task, bridge, sensed, time, limits.effect_delay)
        self._log = ExecutionLog(on_plan, on_step)
        context = ExecutionContext(task, kb, time, limits, bridge, belief, Failures(limits), self._log)
        requests = ActionRequests(kb)
        steps = StepExecution(context, sources, requests, on_raise)
        self._following = PlanFollowing(context, steps, Replanner(context, planner))
        super().__init__(
            self._following,
            kb,
            requests,
            period=period,
            clock=time,
            around_tick=around_tick,
            measures=sensed.measures,
        )

    @property
    def status(self) -> ExecutionStatus:
        """How far the mission has got."""
        return self._following.status

    @property
    def feedback(self) -> str:
        """Why it waits, or has failed."""
        return self._following.feedback

    @property
    def plan(self) -> Plan | None:
        """The present plan; None if there is none."""
        return self._following.plan

    @property
    def plans(self) -> list[PlanRecord]:
        """Every plan that was made, and every time that there was none, oldest first."""
        return self._log.plans

    @property
    def steps(self) -> list[StepRecord]:
        """What became of the steps, oldest first."""
        return self._log.steps
