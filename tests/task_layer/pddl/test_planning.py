"""Which plans there are, why there is none, and what becomes of planners that fail."""

from __future__ import annotations

import subprocess
import sys
from itertools import product

import pytest

from rosa_core import InputError
from task_layer.pddl import GroundTask, Operator, Planner, PlannerFailedError, parse_task
from task_layer.pddl.grounding.ground_task import Condition, Effect
from task_layer.pddl.grounding.reachability import Obstacle
from task_layer.pddl.planning.engines import planners
from task_layer.pddl.planning.plan import parallel_plan, sequential_plan, timed_plan
from task_layer.pddl.planning.propositional import outcomes_of
from tests.task_layer.pddl.kit import SUAVE_DOMAIN, names, suave_problem

ALL = ("search_pipeline", "inspect_pipeline", "recharge")


@pytest.mark.parametrize(
    ("feasible", "expected"),
    [
        (ALL, ["start_robot", "search_pipeline", "inspect_pipeline"]),
        (("search_pipeline", "inspect_pipeline"), ["start_robot", "search_pipeline", "inspect_pipeline"]),
        (("recharge",), ["start_robot", "recharge", "search_pipeline", "inspect_pipeline"]),
        (("search_pipeline", "recharge"), None),
        ((), None),
    ],
)
@pytest.mark.parametrize("started", [False, True])
def test_the_plans_for_each_feasible_set(feasible: tuple[str, ...], expected: list[str] | None, started: bool) -> None:
    planned = Planner(parse_task(SUAVE_DOMAIN, suave_problem(*feasible, started=started))).plan()
    if feasible == ("search_pipeline", "recharge"):
        assert planned.plan is not None
        assert len(planned.plan) == 4 - started
    elif expected is None:
        assert planned.plan is None
    else:
        assert planned.plan is not None
        assert names(planned.plan.names) == expected[started:]


def engines() -> list[str]:
    return [name for name in planners() if name not in ("pyperplan-opt", "fast-downward-opt")]


@pytest.mark.parametrize("engine", engines())
def test_every_engine_that_is_installed_plans_the_mission(engine: str) -> None:
    task = parse_task(SUAVE_DOMAIN, suave_problem("recharge"))
    with Planner(task, engine=engine) as planner:
        plan = planner.plan().plan
    assert plan is not None
    assert names(plan.names) == ["start_robot", "recharge", "search_pipeline", "inspect_pipeline"]
    assert plan.reaches_goal(task.initial)


def test_fast_downward_is_among_what_is_tested() -> None:
    assert "fast-downward" in engines()


def test_without_a_plan_it_is_said_which_goals_and_which_obstacles(suave_task: GroundTask) -> None:
    obstacles = {name: Obstacle(facts=bit) for name, bit in suave_task.feasibility.items()}
    no_plan = Planner(suave_task).plan(0, obstacles=obstacles).no_plan
    assert no_plan is not None
    assert no_plan.goals == ("(pipeline_found p1)", "(pipeline_inspected p1)")
    assert no_plan.obstacles == ("recharge",)
    assert str(no_plan).endswith("cannot be reached: in the way is recharge")
    # Without recharging it takes both.
    del obstacles["recharge"]
    no_plan = Planner(suave_task).plan(0, obstacles=obstacles).no_plan
    assert no_plan is not None
    assert no_plan.obstacles == ("search_pipeline", "inspect_pipeline")


def test_what_nothing_makes_true_is_named() -> None:
    """The inspection asks for a map that no action draws."""
    domain = SUAVE_DOMAIN.replace("(action_feasible ?a - action)", "(action_feasible ?a - action) (mapped)")
    domain = domain.replace("(over all (pipeline_found ?p))", "(over all (pipeline_found ?p)) (at start (mapped))")
    task = parse_task(domain, suave_problem(*ALL), sensed=["mapped"])
    no_plan = Planner(task).plan().no_plan
    assert no_plan is not None
    assert no_plan.goals == ("(pipeline_inspected p1)",)
    assert no_plan.never == ("(mapped)",)


def test_goals_that_exclude_each_other_are_no_plan_either() -> None:
    domain = """(define (domain d) (:requirements :strips) (:predicates (here) (there) (free))
      (:action stay :parameters () :precondition (free) :effect (and (here) (not (free))))
      (:action go :parameters () :precondition (free) :effect (and (there) (not (free)))))"""
    task = parse_task(domain, "(define (problem p) (:domain d) (:init (free)) (:goal (and (here) (there))))")
    no_plan = Planner(task).plan().no_plan
    assert str(no_plan) == "each goal can be reached, but not all of them together"


def test_a_goal_that_holds_needs_no_step_and_one_that_can_never_hold_has_no_plan() -> None:
    domain = """(define (domain d) (:requirements :strips) (:predicates (here) (there) (fixed))
      (:action go :parameters () :effect (there)))"""
    problem = "(define (problem p) (:domain d) (:init (there)) (:goal GOAL))"
    reached = Planner(parse_task(domain, problem.replace("GOAL", "(there)"))).plan()
    assert reached.plan is not None
    assert len(reached.plan) == 0
    never = Planner(parse_task(domain, problem.replace("GOAL", "(fixed)"))).plan()
    assert str(never.no_plan) == "the goal cannot be reached"


def test_plans_are_remembered_by_state_and_by_what_may_be_used(suave_task: GroundTask) -> None:
    state = suave_task.mask(["(robot_started bluerov)", *(f"(action_feasible {name})" for name in ALL)])
    planner = Planner(suave_task, remembered=2)
    first, second = planner.plan(state), planner.plan(state)
    assert (first.cached, second.cached) == (False, True)
    assert first.plan is second.plan
    assert planner.plan(state, excluded=[1]).plan is None
    assert planner.plan(0).plan is None
    assert not planner.plan(state).cached  # forgotten: only two are remembered


def test_operators_that_are_excluded_are_not_used() -> None:
    task = parse_task(SUAVE_DOMAIN, suave_problem(*ALL, targets=2))
    planner = Planner(task)
    search = next(operator for operator in task.operators if operator.action == "search_pipeline")
    assert planner.plan(excluded=[search.index]).plan is None
    plan = planner.plan().plan
    assert plan is not None
    assert search in [step.operator for step in plan.steps]


@pytest.mark.parametrize("targets", [5, 20])
def test_many_targets_are_planned_without_redundant_steps(targets: int) -> None:
    plan = Planner(parse_task(SUAVE_DOMAIN, suave_problem("recharge", targets=targets))).plan().plan
    assert plan is not None
    assert len(plan) == 2 + 2 * targets


@pytest.mark.slow
def test_the_same_plan_is_made_in_every_process() -> None:
    code = (
        "from tests.task_layer.pddl.kit import *; from task_layer.pddl import Planner, parse_task;"
        "print(Planner(parse_task(SUAVE_DOMAIN, suave_problem('recharge', targets=6))).plan().plan.names)"
    )
    printed = {
        subprocess.run(
            [sys.executable, "-c", code], env={"PYTHONHASHSEED": seed}, capture_output=True, text=True, check=True
        ).stdout
        for seed in ("1", "2")
    }
    assert len(printed) == 1


def test_in_a_process_of_its_own_the_plan_is_the_same_and_time_is_bounded(suave_task: GroundTask) -> None:
    state = suave_task.mask(["(action_feasible recharge)"])
    with Planner(suave_task, timeout=30.0) as planner:
        plan = planner.plan(state).plan
        assert plan is not None
        assert plan.names == Planner(suave_task).plan(state).plan.names  # type: ignore[union-attr]
        assert planner.plan(0).plan is None


@pytest.mark.slow
def test_a_planner_that_takes_too_long_is_stopped_and_can_be_asked_again() -> None:
    """No time at all is too little for any engine."""
    task = parse_task(SUAVE_DOMAIN, suave_problem("recharge", targets=30))
    with Planner(task, timeout=1e-6) as planner:
        for _ in range(2):
            with pytest.raises(PlannerFailedError, match="found no plan within 1e-06 s"):
                planner.plan()


@pytest.mark.slow
def test_a_planner_whose_process_dies_is_told_apart_from_no_plan(suave_task: GroundTask) -> None:
    state = suave_task.mask(["(action_feasible recharge)"])
    with Planner(suave_task, timeout=30.0) as planner:
        process = planner._solver._process  # type: ignore[attr-defined]
        process.kill()
        process.wait()
        with pytest.raises(PlannerFailedError, match="exit code -9"):
            planner.plan(state)
        assert planner.plan(state).plan is not None  # by a new process


def test_an_engine_that_raises_has_failed(suave_task: GroundTask, monkeypatch: pytest.MonkeyPatch) -> None:
    planner = Planner(suave_task)

    def crash(*_: object, **__: object) -> None:
        raise ZeroDivisionError("inside the engine")

    for engine in planner._solver._engines:  # type: ignore[attr-defined]
        monkeypatch.setattr(engine, "solve", crash)
    with pytest.raises(PlannerFailedError, match="pyperplan failed: ZeroDivisionError inside the engine"):
        planner.plan(suave_task.mask(["(action_feasible recharge)"]))


def test_an_engine_that_is_not_there_or_cannot_is_bad_input(suave_task: GroundTask) -> None:
    with pytest.raises(InputError, match="did you mean 'pyperplan'"):
        Planner(suave_task, engine="pyperplna")
    with pytest.raises(InputError, match="there is no engine 'lpg'"):
        Planner(suave_task, engine="lpg", timeout=20.0)
    with pytest.raises(ValueError, match="must be positive"):
        Planner(suave_task, timeout=0.0)


def test_conditional_effects_are_compiled_into_all_their_outcomes() -> None:
    """In every state exactly one outcome can happen, and it does what the conditional effects do."""
    effects = (Effect(add=0b1000), Effect(add=0b10000, condition=Condition(0b11, 0b100)), Effect(0, 1, Condition(0b10)))
    operator = Operator(0, "a", (), Condition(), Condition(), Condition(), (), effects)
    outcomes = outcomes_of(operator)
    for state in range(8):
        after = {state & ~effect.delete | effect.add for condition, (effect,) in outcomes if condition.holds(state)}
        expected = state | 0b1000 | (0b10000 if state == 0b011 else 0)
        assert after == {expected & ~1 if state & 0b10 else expected}


def test_independent_steps_may_run_in_parallel() -> None:
    task = parse_task(SUAVE_DOMAIN, suave_problem(*ALL, targets=2))
    plan = Planner(task, parallel=True).plan().plan
    assert plan is not None
    by_name = {name: index for index, name in enumerate(plan.names)}
    searches = [index for name, index in by_name.items() if name.startswith("(search")]
    for index in searches:
        assert plan.after_ends[index] == {0}
    for name, index in by_name.items():
        if name.startswith("(inspect"):
            target = name.split()[2]
            assert by_name[f"(search_pipeline search_pipeline {target} bluerov)"] in plan.after_ends[index]
    assert plan.duration == 15.0


def test_every_order_that_a_plan_leaves_open_reaches_the_goal() -> None:
    task = parse_task(SUAVE_DOMAIN, suave_problem("recharge", targets=2))
    operators = [step.operator for step in Planner(task).plan().plan.steps]  # type: ignore[union-attr]
    plan = parallel_plan(task, operators)
    orders = [order for order in product(range(len(plan)), repeat=len(plan)) if len(set(order)) == len(plan)]
    allowed = [
        order
        for order in orders
        if all(set(plan.after_ends[index]) <= set(order[:place]) for place, index in enumerate(order))
    ]
    assert len(allowed) > 1
    for order in allowed:
        assert sequential_plan(task, [operators[index] for index in order]).reaches_goal(task.initial)


def test_what_is_left_of_a_plan_is_checked_from_where_it_is() -> None:
    task = parse_task(SUAVE_DOMAIN, suave_problem(*ALL))
    plan = Planner(task).plan().plan
    assert plan is not None
    started = task.initial | task.mask(["(robot_started bluerov)"])
    assert plan.reaches_goal(started, ended={0})
    assert not plan.reaches_goal(task.initial, ended={0})
    assert plan.reaches_goal(started, ended={0}, running={1})
    low = started & ~task.mask(["(action_feasible search_pipeline)"])
    assert not plan.reaches_goal(low, ended={0}, running={1})
    flaw = plan.first_flaw(low, ended={0})
    assert flaw is not None
    assert list(task.literals_of(flaw[1])) == ["(action_feasible search_pipeline)"]


MATCH = """
(define (domain match) (:requirements :durative-actions :negative-preconditions)
  (:predicates (unused) (light) (fixed) (burnt))
  (:durative-action burn :parameters () :duration (= ?duration 8) :condition (at start (unused))
    :effect (and (at start (not (unused))) (at start (light)) (at end (not (light))) (at end (burnt))))
  (:durative-action hint :parameters () :duration (= ?duration 3) :condition (over all (light))
    :effect (at end (fixed))))
"""


def test_steps_that_need_another_to_be_running_overlap() -> None:
    """The fuse can only be fixed by the light of a burning match; a plan in sequence does not exist."""
    task = parse_task(MATCH, "(define (problem p) (:domain match) (:init (unused)) (:goal (and (fixed) (burnt))))")
    burn, hint = task.operators
    plan = timed_plan(task, [(hint, 0.1), (burn, 0.0)])
    assert plan.names == ("(burn)", "(hint)")
    assert plan.reaches_goal(task.initial)
    assert plan.reaches_goal(task.mask(["(light)"]), running={0})
    assert not plan.reaches_goal(task.mask(["(light)"]), ended={0})
    assert not timed_plan(task, [(burn, 0.0), (hint, 6.0)]).reaches_goal(task.initial)  # it burns out too soon
    assert not timed_plan(task, [(burn, 4.0), (hint, 0.0)]).reaches_goal(task.initial)
    assert Planner(task).plan().plan is None


@pytest.mark.skipif("aries" not in planners(), reason="the extra 'aries' is not installed")
def test_a_temporal_engine_finds_such_a_plan() -> None:
    task = parse_task(MATCH, "(define (problem p) (:domain match) (:init (unused)) (:goal (and (fixed) (burnt))))")
    plan = Planner(task, engine="aries").plan().plan
    assert plan is not None
    assert plan.overlapping
    assert plan.names == ("(burn)", "(hint)")
