"""Planning: optimal against brute force, well founded, and what becomes of running units."""

from __future__ import annotations

import itertools
import math
import random

import pytest

from benchmarks.stream_libraries import random_library, structured_library
from rosa_streams.costs import DeclaredCosts, Objective, update_cost
from rosa_streams.environment import Change, Environment, Port, Target, Transformation, Unit, update
from rosa_streams.planning import PlanStatus, UnitNames, pareto_front, plan, problem_of
from rosa_streams.planning.exact import lower_bound, optimal_choice
from rosa_streams.planning.immediate import immediate_choice, settle, value
from rosa_streams.planning.paper_search import paper_search
from rosa_streams.planning.problem import Problem
from rosa_streams.tags import Ontology, parse_tag
from rosa_streams.validity import ViolationKind, is_valid, violations


def best_by_brute_force(problem: Problem) -> float:
    best = math.inf
    numbers = range(len(problem.options))
    for size in range(len(problem.options) + 1):
        for chosen in itertools.combinations(numbers, size):
            if problem.is_solution(chosen):
                best = min(best, value(problem, frozenset(chosen)))
    return best


def small_problems(count: int, weight: float = 0.0) -> list[Problem]:
    objective = Objective(horizon=10, quality_weight=weight)
    problems = []
    for seed in range(count):
        problem = problem_of(random_library(9, seed, kinds=5), DeclaredCosts(), objective)
        problems.append(problem)
    return problems


@pytest.mark.parametrize("weight", [0.0, 2.0])
def test_the_exact_plan_costs_what_the_best_of_all_subsets_costs(weight: float) -> None:
    solved = 0
    for problem in small_problems(120, weight):
        best = best_by_brute_force(problem)
        optimum = optimal_choice(problem)
        assert optimum.proven
        assert (optimum.chosen is None) == (best == math.inf)
        if optimum.chosen is not None:
            assert problem.is_solution(optimum.chosen)
            assert value(problem, optimum.chosen) == pytest.approx(best)
            assert lower_bound(problem) <= best + 1e-9
            solved += bool(problem.goals)
    assert solved > 20


def test_the_immediate_plan_is_a_solution_whenever_there_is_one_and_settles_trees_at_their_least_cost() -> None:
    for problem in small_problems(120):
        chosen = immediate_choice(problem)
        assert (chosen is None) == bool(problem.unsatisfiable_goals())
        if chosen is not None:
            assert problem.is_solution(chosen)
        trees = settle(problem).costs
        assert set(trees) == set(problem.derivable())
        for number, cost in trees.items():
            option = problem.options[number]
            fed = [
                sorted(trees[each] for each in problem.providers[need] if each in trees and each != number)[:count]
                for need, count in option.needs
            ]
            assert cost <= option.cost + sum(map(sum, fed)) + 1e-9 or cost == pytest.approx(option.cost)


def test_the_papers_search_finds_the_cheapest_tree_and_shares_common_parts_afterwards() -> None:
    compared = 0
    for problem in small_problems(120):
        if any(count > 1 for option in problem.options for _, count in option.needs):
            continue
        if any(option.cost == 0 for option in problem.options):
            continue  # A loop that costs nothing has no end in the printed algorithm: there the time-out ends it.
        outcome = paper_search(problem, timeout=20, most_nodes=3_000)
        if not outcome.exhausted:
            continue
        assert (outcome.chosen is None) == bool(problem.unsatisfiable_goals())
        if outcome.chosen is None:
            continue
        assert set(problem.derivable(outcome.chosen)) >= set(outcome.chosen)
        optimum = optimal_choice(problem)
        assert optimum.chosen is not None
        assert problem.cost(outcome.chosen) >= problem.cost(optimum.chosen) - 1e-9
        settled = settle(problem)
        trees = sum(settled.costs[settled.providers[goal][0]] for goal in problem.goals)
        assert problem.cost(outcome.chosen) <= trees + 1e-9
        compared += 1
    assert compared > 20


def test_the_papers_search_ends_at_its_time_out_where_loops_cost_nothing() -> None:
    library = [
        Transformation("a", "a", (_in("B"),), (_out("A"),), labor=0.0),
        Transformation("b", "b", (_in("A"),), (_out("B"),), labor=0.0),
    ]
    environment = _environment(library, "A")
    ticks = itertools.count()
    outcome = paper_search(problem_of(environment, DeclaredCosts()), timeout=500, now=lambda: float(next(ticks)))
    assert outcome.chosen is None
    assert not outcome.exhausted


def test_the_cheapest_tree_is_not_the_cheapest_plan_where_parts_could_be_shared() -> None:
    """Two inputs fed from one source at 10 are better than two sources at 6 each, but trees do not show it."""
    library = [
        Transformation("one", "one", (), (_out("A", "a"), _out("B", "b")), labor=10.0),
        Transformation("a", "a", (), (_out("A"),), labor=6.0),
        Transformation("b", "b", (), (_out("B"),), labor=6.0),
        Transformation("join", "join", (_in("A", "a"), _in("B", "b")), (_out("C"),), labor=1.0),
    ]
    environment = _environment(library, "C")
    costs = {search: plan(environment, search=search).cost for search in ("paper", "exact")}
    assert costs == {"paper": 13.0, "exact": 11.0}
    assert plan(environment).status is PlanStatus.OPTIMAL
    assert plan(environment).bound == 11.0


@pytest.mark.parametrize("seed", range(30))
def test_whatever_is_lost_the_plan_leaves_a_valid_environment_at_the_cost_that_it_names(seed: int) -> None:
    rng = random.Random(seed)
    environment = structured_library(60, seed, layers=4, branching=3, targets=3)
    names = UnitNames()
    objective = Objective(horizon=5)
    if problem_of(environment, DeclaredCosts(), objective).unsatisfiable_goals():
        pytest.skip("this library does not reach its targets")
    for _ in range(6):
        for search in ("fast", "exact"):
            found = plan(environment, objective=objective, search=search, names=names.copy())
            after = update(environment, found.change)
            assert is_valid(after), violations(after)
            assert after.graph() == {unit.cid: unit for unit in found.units}
            assert found.cost == pytest.approx(update_cost(environment, found.change, DeclaredCosts(), 5))
            assert found.bound is not None
            assert found.bound <= found.cost + 1e-9
        environment = after
        for unit in found.units:
            names.note(unit.cid)
        assert not plan(environment, objective=objective).change, "nothing to do once it is optimal"
        lost = rng.sample(sorted(environment.graph()), min(2, len(environment.units)))
        environment = update(environment, Change(units_removed=frozenset(environment.graph()[cid] for cid in lost)))
        assert not is_valid(environment)


def test_a_loop_that_feeds_itself_is_valid_by_definition_9_and_refused_with_the_reason() -> None:
    """The smallest one: a filter that asks for what it gives."""
    filter_ = Transformation("smooth", "smooth", (_in("Position"),), (_out("Position"),))
    feeding_itself = Unit.of("smooth.1", "smooth", {"in": "/p"}, {"out": "/p"})
    environment = Environment(
        frozenset({feeding_itself}),
        frozenset({filter_}),
        frozenset({Target("q", parse_tag("Position"), "/p")}),
    )
    assert is_valid(environment, well_founded=False)
    (violation,) = violations(environment)
    assert violation.kind is ViolationKind.UNGROUNDED
    assert "smooth.1 -> smooth.1" in violation.reason
    for search in ("paper", "fast", "exact"):
        found = plan(environment, search=search)
        assert found.status is PlanStatus.NONE
        assert found.why is not None
        assert "smooth.1 would feed itself" in found.why
        assert "register a transformation that gives Position" in found.why


def test_a_loop_is_cut_from_the_integer_program_when_only_a_source_can_break_it() -> None:
    """Two filters at no cost feed each other; the source that starts them is expensive and needed."""
    library = [
        Transformation("a", "a", (_in("B"),), (_out("A"),), labor=0.0),
        Transformation("b", "b", (_in("A"),), (_out("B"),), labor=0.0),
        Transformation("source", "source", (), (_out("A"),), labor=50.0),
        Transformation("end", "end", (_in("A", "a"), _in("B", "b")), (_out("C"),), labor=1.0),
    ]
    found = plan(_environment(library, "C"))
    assert (found.status, found.cost) == (PlanStatus.OPTIMAL, 51.0)
    assert {unit.tid for unit in found.units} == {"source", "b", "end"}


def test_the_horizon_decides_between_a_unit_that_runs_and_a_thriftier_new_one() -> None:
    library = [
        Transformation("thirsty", "thirsty", (), (_out("A"),), labor=1.0, upkeep=1.0),
        Transformation("thrifty", "thrifty", (), (_out("A"),), labor=30.0, upkeep=0.1),
    ]
    running = Unit.of("thirsty.1", "thirsty", {}, {"out": "/r0"})
    environment = update(_environment(library, "A"), Change(units_added=frozenset({running})))
    assert [unit.cid for unit in plan(environment, objective=Objective(horizon=10)).units] == ["thirsty.1"]
    assert [unit.cid for unit in plan(environment, objective=Objective(horizon=100)).units] == ["thrifty.1"]


def test_a_plan_beyond_max_cost_is_refused_with_the_reason() -> None:
    environment = _environment([Transformation("a", "a", (), (_out("A"),), labor=7.0)], "A")
    assert plan(environment, objective=Objective(max_cost=7)).status is PlanStatus.OPTIMAL
    refused = plan(environment, objective=Objective(max_cost=6.9))
    assert refused.status is PlanStatus.NONE
    assert refused.why == "the cheapest plan costs 7, and MAX_COST is 6.9"


def test_a_fusion_wants_two_different_streams() -> None:
    fuse = Transformation("fuse", "fuse", (_in("A", "first"), _in("A", "second")), (_out("Fused"),), labor=1.0)
    one = Transformation("one", "one", (), (_out("A"),), labor=1.0)
    two = Transformation("two", "two", (), (_out("A"),), labor=5.0)
    alone = plan(_environment([fuse, one], "Fused"))
    assert alone.status is PlanStatus.NONE
    assert alone.why is not None
    assert "fuse wants 2 different streams of A" in alone.why
    for search in ("paper", "fast", "exact"):
        found = plan(_environment([fuse, one, two], "Fused"), search=search)
        assert {unit.tid for unit in found.units} == {"fuse", "one", "two"}


def test_two_targets_may_be_served_by_one_unit_each_on_its_own_channel() -> None:
    library = [Transformation("a", "a", (), (_out("A"),), labor=7.0)]
    environment = _environment(library, "A", "A")
    found = plan(environment)
    assert [unit.channels() for unit in found.units] == [("/r0", "/r1")]
    assert is_valid(update(environment, found.change))


def test_quality_is_traded_against_cost_along_the_front() -> None:
    library = [
        Transformation(name, name, (), (_out("A"),), labor=labor, quality=quality)
        for name, labor, quality in (("cheap", 1.0, 0.0), ("fair", 3.0, 4.0), ("dear", 9.0, 6.0), ("poor", 8.0, 1.0))
    ]
    front = pareto_front(_environment(library, "A"))
    assert [(found.cost, found.quality) for found in front] == [(1.0, 0.0), (3.0, 4.0), (9.0, 6.0)]


def test_a_deadline_gives_the_best_plan_so_far_with_its_bound() -> None:
    environment = structured_library(400, 1)
    now = iter(itertools.chain([0.0], itertools.repeat(100.0)))
    optimum = optimal_choice(problem_of(environment, DeclaredCosts()), deadline=1.0, now=lambda: next(now))
    assert optimum.chosen is not None
    assert not optimum.proven
    assert optimum.bound <= value(problem_of(environment, DeclaredCosts()), optimum.chosen)


def test_why_names_what_is_missing_at_the_bottom_and_the_smallest_remedy() -> None:
    library = [
        Transformation("locate", "locate", (_in("PixelPos", "ball"), _in("Pose", "pose")), (_out("Position"),)),
        Transformation("detect", "detect", (_in("Image", "image"),), (_out("PixelPos"),)),
        Transformation("camera", "camera", (), (_out("Image ⊓ ∃hasSource.piff"),)),
    ]
    found = plan(_environment(library, "Position"))
    assert found.why is not None
    lines = found.why.splitlines()
    assert lines[0] == "q0 cannot be satisfied: it asks for Position"
    assert "locate would give it and lacks its input pose:" in found.why
    assert "no transformation gives Pose" in found.why
    assert "to help: register a transformation that gives Pose" in found.why


@pytest.mark.slow
def test_larger_libraries_are_solved_and_no_cheaper_choice_is_found_by_the_other_searches() -> None:
    solved = 0
    for seed in range(12):
        problem = problem_of(structured_library(120, seed, layers=5), DeclaredCosts())
        optimum = optimal_choice(problem, deadline=60)
        immediate = immediate_choice(problem)
        if optimum.chosen is None or immediate is None:
            continue
        solved += optimum.proven
        assert problem.cost(optimum.chosen) <= problem.cost(immediate) + 1e-9
        outcome = paper_search(problem, timeout=2, most_nodes=100_000)
        if outcome.chosen is not None:
            assert problem.cost(optimum.chosen) <= problem.cost(outcome.chosen) + 1e-9
    assert solved > 5


def _in(tag: str, name: str = "in") -> Port:
    return Port(name, parse_tag(tag))


def _out(tag: str, name: str = "out") -> Port:
    return Port(name, parse_tag(tag))


def _environment(library: list[Transformation], *wanted: str) -> Environment:
    goal = [Target(f"q{number}", parse_tag(tag), f"/r{number}") for number, tag in enumerate(wanted)]
    return Environment(frozenset(), frozenset(library), frozenset(goal), Ontology())
