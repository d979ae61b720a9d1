"""Random small missions under random changes of feasibility, beside a naive idea of what they should do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeBase, SimulationClock
from task_layer.pddl import ExecutionLimits, ExecutionStatus, PlanExecutor, Planner, StepOutcome, StepRecord
from task_layer.pddl.planning.planner import without_redundant
from task_layer.skill import SkillStatus
from tests.task_layer.pddl.kit import (
    EMPTY,
    Act,
    Literals,
    Scripted,
    World,
    knowledge,
    reachable,
    set_feasible,
    small_task,
)

FACTS = ("p", "q", "r", "s")
PERIOD = 0.5
QUIET = settings(deadline=None, max_examples=20, suppress_health_check=[HealthCheck.too_slow])


@st.composite
def literals(draw: Callable[..., Any], most: int) -> Literals:
    chosen = draw(st.lists(st.tuples(st.sampled_from(FACTS), st.booleans()), max_size=most, unique_by=lambda c: c[0]))
    return frozenset(f for f, value in chosen if value), frozenset(f for f, value in chosen if not value)


@st.composite
def acts(draw: Callable[..., Any]) -> list[Act]:
    return [
        Act(
            f"a{number}",
            at_start=draw(literals(2)),
            over_all=draw(st.one_of(st.just(EMPTY), literals(1))),
            at_end=draw(st.one_of(st.just(EMPTY), literals(1))),
            start_effect=draw(st.one_of(st.just(EMPTY), literals(1))),
            end_effect=draw(literals(2)),
        )
        for number in range(draw(st.integers(1, 5)))
    ]


class Mission:
    """An executor on a random domain, and beside it the naive world, which checks every start."""

    def __init__(self, chosen: list[Act], initial: set[str], goal: Literals, *, parallel: bool = False) -> None:
        self.acts = {act.name: act for act in chosen}
        self.goal = goal
        self.world = World(set(initial))
        self.clock = SimulationClock()
        self.kb: KnowledgeBase = knowledge(self.acts, self.clock)
        task = small_task(chosen, initial, goal, FACTS)
        self.skills = {name: Scripted(2, on_start=self.checks(act)) for name, act in self.acts.items()}
        self.executor = PlanExecutor(
            Planner(task, parallel=parallel),
            self.kb,
            self.skills,
            period=PERIOD,
            limits=ExecutionLimits(patience=20.0, replans=1000),
            on_step=self.on_step,
        )

    def checks(self, act: Act) -> Callable[[], None]:
        def check() -> None:
            assert self.kb.is_action_feasible(act.name), f"{act.name} was started although it is unfeasible"
            assert self.world.can_start(act), f"{act.name} was started in {self.world.facts}"
            self.world.apply(act.start_effect)

        return check

    def on_step(self, record: StepRecord) -> None:
        if record.outcome is StepOutcome.COMPLETED:
            act = self.acts[record.step.strip("()")]
            assert self.world.holds(act.over_all)
            assert self.world.holds(act.at_end)
            self.world.apply(act.end_effect)

    def feasible_acts(self) -> list[Act]:
        return [act for act in self.acts.values() if self.kb.is_action_feasible(act.name)]


@QUIET
@given(acts(), st.sets(st.sampled_from(FACTS)), literals(2), st.data())
def test_the_goal_is_reached_exactly_if_a_plan_exists(
    chosen: list[Act], initial: set[str], goal: Literals, data: st.DataObject
) -> None:
    mission = Mission(chosen, initial, goal)
    for name in mission.acts:
        set_feasible(mission.kb, name, data.draw(st.booleans(), name))
    wanted = reachable(mission.feasible_acts(), mission.world, goal)
    ended = mission.executor.run(timeout=100.0)
    assert ended is (ExecutionStatus.SUCCESS if wanted else ExecutionStatus.FAILURE)
    assert mission.world.holds(goal) or not wanted
    assert mission.kb.required_actions() == []


@QUIET
@given(
    acts(),
    st.sets(st.sampled_from(FACTS)),
    literals(2),
    st.lists(st.tuples(st.integers(0, 40), st.integers(0, 4), st.booleans()), max_size=12),
    st.booleans(),
)
def test_whatever_becomes_unfeasible_nothing_starts_without_its_requirements(
    chosen: list[Act],
    initial: set[str],
    goal: Literals,
    changes: list[tuple[int, int, bool]],
    parallel: bool,
) -> None:
    """Every start is checked by the skill; and at the end there is the goal, or no way to it."""
    mission = Mission(chosen, initial, goal, parallel=parallel)
    for quarter, number, feasible in changes:
        name = f"a{number % len(chosen)}"
        # Between the periods, in the middle of steps.
        mission.clock.call_at(quarter / 4 + 0.1, lambda n=name, f=feasible: set_feasible(mission.kb, n, f))
    ended = mission.executor.run(timeout=100.0)
    if ended is ExecutionStatus.SUCCESS:
        assert mission.world.holds(goal)
    else:
        assert not reachable(mission.feasible_acts(), mission.world, goal)


@QUIET
@given(
    acts(),
    st.sets(st.sampled_from(FACTS)),
    literals(2),
    st.lists(st.sampled_from([SkillStatus.SUCCESS, SkillStatus.FAILURE]), max_size=8),
)
def test_failing_skills_do_not_make_it_start_what_it_may_not_or_go_on_for_ever(
    chosen: list[Act], initial: set[str], goal: Literals, outcomes: list[SkillStatus]
) -> None:
    mission = Mission(chosen, initial, goal)
    for skill in mission.skills.values():
        skill.outcomes.extend(outcomes)
    ended = mission.executor.run(timeout=1000.0)
    assert ended in (ExecutionStatus.SUCCESS, ExecutionStatus.FAILURE)
    for skill in mission.skills.values():
        assert skill.calls.count("start") == skill.calls.count("stop")


@QUIET
@given(acts(), st.sets(st.sampled_from(FACTS)), literals(2))
def test_a_plan_works_in_the_naive_world_and_has_no_redundant_step(
    chosen: list[Act], initial: set[str], goal: Literals
) -> None:
    task = small_task(chosen, initial, goal, FACTS)
    state = task.initial | sum(task.feasibility.values())
    planned = Planner(task).plan(state)
    by_name = {act.name: act for act in chosen}
    assert (planned.plan is not None) is reachable(chosen, World(set(initial)), goal)
    if planned.plan is None:
        return
    world: World | None = World(set(initial))
    for step in planned.plan.steps:
        assert world is not None
        world = world.after(by_name[step.operator.action])
    assert world is not None
    assert world.holds(goal)
    operators = [step.operator for step in planned.plan.steps]
    assert without_redundant(task, operators, state) == operators
