"""Domains and problems as people have them, and what is said of those that are wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_core import InputError
from task_layer.pddl import GroundTask, Planner, load_task, parse_task
from task_layer.pddl.grounding import grounder as grounding
from tests.task_layer.pddl.kit import SUAVE_DOMAIN, SUAVE_PROBLEM, names, suave_problem

LAMP = """
(define (domain lamp)
  (:requirements :adl :typing)
  (:types room lamp - object)
  (:constants hall - room)
  (:predicates (in ?l - lamp ?r - room) (lit ?r - room) (broken ?l - lamp) (ready) (at ?r - room))
  (:action go :parameters (?from ?to - room)
    :precondition (and (at ?from) (not (= ?from ?to)))
    :effect (and (at ?to) (not (at ?from))))
  (:action switch :parameters (?l - lamp ?r - room)
    :precondition (and (at ?r) (in ?l ?r) (not (broken ?l)))
    :effect (and (lit ?r) (when (forall (?x - room) (lit ?x)) (ready))))
  (:action finish :parameters ()
    :precondition (and (forall (?x - room) (lit ?x)) (or (at hall) (ready)))
    :effect (ready)))
"""
LAMP_PROBLEM = """
(define (problem two-rooms) (:domain lamp)
  (:objects kitchen - room L1 L.2 - lamp)
  (:init (at kitchen) (in L1 hall) (in L.2 kitchen))
  (:goal (and (ready) (exists (?r - room) (lit ?r)))))
"""


def said(domain: str, problem: str = SUAVE_PROBLEM) -> str:
    with pytest.raises(InputError) as refused:
        parse_task(domain, problem, domain_file="d.pddl", problem_file="p.pddl")
    assert all(problem.hint for problem in refused.value.problems)
    return str(refused.value)


def line_of(text: str, words: str) -> int:
    return next(number for number, line in enumerate(text.splitlines(), 1) if words in line)


def test_the_suave_files_are_read_as_they_are(suave_task: GroundTask) -> None:
    """Empty functions, objects named like actions, no word on feasibility, durative actions."""
    assert [operator.name for operator in suave_task.operators] == [
        "(start_robot bluerov)",
        "(search_pipeline search_pipeline p1 bluerov)",
        "(inspect_pipeline inspect_pipeline p1 bluerov)",
        "(recharge recharge search_pipeline inspect_pipeline bluerov)",
    ]
    assert set(suave_task.feasibility) == {"search_pipeline", "inspect_pipeline", "recharge"}
    assert suave_task.initial == 0
    search = suave_task.operators[1]
    assert set(suave_task.literals_of(search.over_all)) == {
        "(action_feasible search_pipeline)",
        "(robot_started bluerov)",
    }
    assert search.duration == 5.0


def test_files_are_read_and_named_in_errors(tmp_path: Path) -> None:
    domain, problem = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    domain.write_text("\ufeff" + SUAVE_DOMAIN, encoding="utf-8")
    problem.write_text(SUAVE_PROBLEM, encoding="utf-8")
    assert len(load_task(domain, problem).operators) == 4
    with pytest.raises(InputError, match=r"nothing.pddl: cannot read it"):
        load_task(domain, tmp_path / "nothing.pddl")
    domain.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not UTF-8"):
        load_task(domain, problem)


def test_case_hyphens_and_dots_are_kept_as_written_and_do_not_matter() -> None:
    domain = SUAVE_DOMAIN.upper().replace("SEARCH_PIPELINE", "Search-Pipeline.v2")
    problem = suave_problem("search_pipeline", "inspect_pipeline").replace("search_pipeline", "search-pipeline.V2")
    task = parse_task(domain, problem.replace("bluerov", "Blue.ROV-2"))
    plan = Planner(task).plan().plan
    assert plan is not None
    assert plan.names[:2] == ("(START_ROBOT Blue.ROV-2)", "(Search-Pipeline.v2 Search-Pipeline.v2 p1 Blue.ROV-2)")
    assert task.mask(["( pipeline_FOUND  P1 )"]) == 1 << task.facts.index("(PIPELINE_FOUND p1)")


def test_plain_actions_with_everything_of_adl_are_read() -> None:
    """Constants, equality, quantifiers, choices, negation, conditional effects, a predicate called 'at'."""
    task = parse_task(LAMP, LAMP_PROBLEM)
    plan = Planner(task).plan().plan
    assert plan is not None
    assert len(plan) == 4
    assert names(plan.names)[:3] == ["switch", "go", "switch"]
    assert plan.names[0] == "(switch L.2 kitchen)"


def test_sections_may_come_in_any_order() -> None:
    start = SUAVE_DOMAIN.index("(:predicates")
    end = SUAVE_DOMAIN.index("(:functions )")
    predicates = SUAVE_DOMAIN[start:end]
    moved = SUAVE_DOMAIN.replace(predicates, "").replace("(:functions )", f"(:functions )\n{predicates}")
    assert len(parse_task(moved, SUAVE_PROBLEM).operators) == 4
    begin, goal = SUAVE_PROBLEM.index("(:domain"), SUAVE_PROBLEM.index("(:goal")
    turned = f"{SUAVE_PROBLEM[:begin]}{SUAVE_PROBLEM[goal:].rstrip()[:-1]}{SUAVE_PROBLEM[begin:goal]})"
    assert len(parse_task(SUAVE_DOMAIN, turned).operators) == 4


def test_the_parts_of_an_action_may_come_in_any_order() -> None:
    domain = """
    (define (domain d) (:predicates (p) (q))
      (:action one :effect (p) :parameters ())
      (:durative-action two :effect (at end (q)) :condition (at start (p)) :duration (= ?duration 3) :parameters ()))"""
    plan = Planner(parse_task(domain, "(define (problem p) (:domain d) (:init) (:goal (q)))")).plan().plan
    assert plan is not None
    assert plan.names == ("(one)", "(two)")
    assert plan.duration == 3.0


def test_effects_on_all_objects_and_costs_with_a_metric_are_read() -> None:
    domain = """
    (define (domain d) (:requirements :adl :action-costs) (:predicates (wet ?x) (rain))
      (:functions (total-cost) - number)
      (:action pour :parameters () :precondition (rain)
        :effect (and (forall (?x) (wet ?x)) (forall (?x - object) (when (wet ?x) (not (rain))))
                     (increase (total-cost) 2))))"""
    problem = """
    (define (problem p) (:domain d) (:objects 1st _under a) (:init (rain) (= (total-cost) 0))
      (:goal (forall (?x) (wet ?x))) (:metric minimize (+ (* 2 (total-cost)) (total-time))))"""
    plan = Planner(parse_task(domain, problem)).plan().plan
    assert plan is not None
    (step,) = plan.steps
    assert set(plan.task.facts_in(step.operator.effects[0].add)) == {"(wet 1st)", "(wet _under)", "(wet a)"}


def test_line_ends_a_byte_order_mark_and_comments_do_not_matter(tmp_path: Path) -> None:
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_bytes(b"\xef\xbb\xbf; a (comment\r\n" + SUAVE_DOMAIN.upper().replace("\n", "\r\n").encode())
    problem.write_bytes(suave_problem("search_pipeline", "inspect_pipeline").replace("\n", "\r\n").encode())
    plan = Planner(load_task(domain, problem)).plan().plan
    assert plan is not None
    assert names(plan.names) == ["START_ROBOT", "SEARCH_PIPELINE", "INSPECT_PIPELINE"]


def test_reading_leaves_the_settings_of_unified_planning_alone(suave_task: GroundTask) -> None:
    from unified_planning.environment import get_environment

    assert get_environment().error_used_name


def test_at_start_and_at_end_effects_and_conditions_are_told_apart() -> None:
    domain = """
    (define (domain d) (:requirements :durative-actions :fluents) (:predicates (free) (busy) (done) (hot))
      (:functions (minutes) (total-cost))
      (:durative-action work :parameters () :duration (= ?duration (* 60 (minutes)))
        :condition (and (at start (free)) (over all (busy)) (at end (hot)))
        :effect (and (at start (not (free))) (at start (busy)) (at start (hot)) (at end (done)) (at end (not (busy)))
                     (at end (increase (total-cost) 1)))))"""
    problem = """
    (define (problem p) (:domain d) (:init (free) (= (minutes) 2) (= (total-cost) 0)) (:goal (done)))"""
    task = parse_task(domain, problem)
    (work,) = task.operators
    assert list(task.literals_of(work.at_start)) == ["(free)"]
    assert list(task.literals_of(work.over_all)) == ["(busy)"]
    assert list(task.literals_of(work.at_end)) == ["(hot)"]
    assert work.duration == 120.0
    # What it makes true itself it does not need before.
    assert list(task.literals_of(work.condition)) == ["(free)"]
    (effect,) = work.effects
    assert set(task.facts_in(effect.add)) == {"(hot)", "(done)"}
    assert set(task.facts_in(effect.delete)) == {"(free)", "(busy)"}


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("(:types pipeline robot action)", "(:types pipeline robot action", "'(define' is never closed"),
        ("(:functions )", "(:functions ))", "')' closes nothing"),
        ("(over all (pipeline_found ?p))", "(over all (pipline_found ?p))", "did you mean 'pipeline_found'?"),
        ("(over all (pipeline_found ?p))", "(over all (pipeline_found ?q))", "there is no variable '?q'"),
        ("(over all (pipeline_found ?p))", "(over all (pipeline_found ?p ?r))", "takes 1 arguments, not 2"),
        ("(over all (pipeline_found ?p))", "(over all (pipeline_found ?r))", "'?r' is of type robot"),
        ("(over all (pipeline_found ?p))", "(over most (pipeline_found ?p))", "times are: at start"),
        ("(pipeline_found ?p - pipeline)", "(pipeline_found ?p - pipe)", "type 'pipe', which is not declared"),
        (":negative-preconditions", ":object-fluents", "the requirement ':object-fluents' is not supported"),
        ("(:functions )", "(:derived (x) (y))", "derived predicates are not supported"),
        ("(:functions )", "(:functoins )", "did you mean ':functions'?"),
        (":duration (= ?duration 5)\n    :condition (and)", ":condition (and)", "has no duration"),
        (":parameters (?r - robot)", "", "has no parameters"),
        ("(at end (robot_started ?r))))", "(at end (robot_started nemo))))", "there is no object 'nemo'"),
        ("(define (domain suave)", "(define (problem suave)", "this is not a domain"),
        ("(domain suave)", "(domain suav)", "this domain is 'suav'"),
        ("?p - pipeline ?r", "?p - (either pipeline robot) ?r", "'either' is not supported"),
        ("pipeline robot action)", "pipeline - robot robot - pipeline action)", "'robot' is a kind of itself"),
        ("(:durative-action search_pipeline", "(:durative-action start_robot", "'start_robot' is declared twice"),
        ("(pipeline_found ?p - pipeline)", "(robot_started ?p - pipeline)", "'robot_started' is declared twice"),
        ("(:functions )", "(:predicates (sunk))", "two sections ':predicates'"),
        ("(:functions )", "functions", "a section is expected, not 'functions'"),
        ("(?r - robot)\n    :duration", "(?r - robot ?r - robot)\n    :duration", "'?r' is declared twice"),
        (":duration (= ?duration 5)", ":duration (= ?duration 5) :duration ()", "has ':duration' twice"),
        (":duration (= ?duration 5)", ":duration ()", "has no duration"),
        (":duration (= ?duration 5)", ":duration (= ?duration -5)", "the duration of 'start_robot' is -5 s"),
        (":duration (= ?duration 5)", ":duration (= ?duration 1e400)", "a number is too large"),
        (":duration (= ?duration 5)", ":duration (= ?duration nan)", "there is no object 'nan'"),
        (":duration (= ?duration 5)", ":cost 3 :duration (= ?duration 5)", "cannot have ':cost'"),
        ("(over all (pipeline_found ?p))", "(pipeline_found ?p)", "'(pipeline_found ...)' does not say when"),
        ("(at end (robot_started ?r))", "(robot_started ?r)", "'(robot_started ...)' does not say when"),
    ],
)
def test_what_is_wrong_with_a_domain_is_said_with_file_line_and_mend(old: str, new: str, words: str) -> None:
    assert old in SUAVE_DOMAIN
    message = said(SUAVE_DOMAIN.replace(old, new, 1))
    assert words in message
    assert "pddl:" in message
    if words.startswith(("did", "there", "takes", "'?r'", "times", "derived")) and "nemo" not in words:
        assert f"d.pddl:{line_of(SUAVE_DOMAIN, old.splitlines()[0])}:" in message


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("recharge - action", "recharge - acton", "did you mean 'action'?"),
        ("(recharge_action recharge)", "(recharge_action rechrge)", "did you mean 'recharge'?"),
        ("(recharge_action recharge)", "(recharge_action p1)", "'p1' is of type pipeline"),
        ("(:goal", "(:gaol", "there is no goal"),
        ("(:domain suave)", "", "it does not say of which domain it is"),
        ("(:init", "(:intit", "there is no initial state"),
        ("p1 - pipeline", "p1 p1 - pipeline", "'p1' is declared twice"),
        ("(:domain suave)", "(:domain lamp)", "the problem is of the domain 'lamp'"),
    ],
)
def test_what_is_wrong_with_a_problem_is_said_with_file_line_and_mend(old: str, new: str, words: str) -> None:
    message = said(SUAVE_DOMAIN, SUAVE_PROBLEM.replace(old, new, 1))
    assert words in message
    assert "p.pddl:" in message


def test_times_in_an_action_that_takes_none_are_refused() -> None:
    domain = "(define (domain d) (:predicates (p))\n(:action a :parameters () :effect (at start (p))))"
    message = said(domain, "(define (problem p) (:domain d) (:init) (:goal (p)))")
    assert message.startswith("d.pddl:2: an :action takes no time")


def test_all_problems_are_told_at_once() -> None:
    broken = SUAVE_DOMAIN.replace("(over all (pipeline_found ?p))", "(over all (lost ?p))").replace(
        "(at end (pipeline_inspected ?p))", "(at end (gone ?p))"
    )
    message = said(broken)
    assert "there is no predicate 'lost'" in message
    assert "there is no predicate 'gone'" in message


def test_what_only_the_reader_finds_is_still_told_with_the_file() -> None:
    message = said(SUAVE_DOMAIN.replace("(:functions )", "(:functions (place ?r - robot) - pipeline)"))
    assert message.startswith(f"d.pddl:{line_of(SUAVE_DOMAIN, '(:functions )')}: it cannot be read")
    message = said(SUAVE_DOMAIN, SUAVE_PROBLEM.replace("(:init", "(:init (forall (?r - robot) (robot_started ?r))"))
    assert message.startswith("p.pddl: it cannot be read")


def test_the_kinds_of_files_that_were_mixed_up_are_all_that_is_said() -> None:
    with pytest.raises(InputError) as refused:
        parse_task(SUAVE_PROBLEM, SUAVE_DOMAIN)
    found = [problem.what for problem in refused.value.problems]
    assert found == ["this is not a domain, but a problem", "this is not a problem, but a domain"]


def test_numbers_that_change_are_refused_in_conditions() -> None:
    domain = SUAVE_DOMAIN.replace("(:functions )", "(:functions (level))").replace(
        "(at end (action_feasible ?a1))", "(at end (increase (level) 1)) (at end (action_feasible ?a1))"
    )
    assert "numbers" not in str(parse_task(domain, SUAVE_PROBLEM))
    asked = domain.replace(
        "(over all (recharge_action ?a))", "(over all (recharge_action ?a)) (at start (< (level) 3))"
    )
    message = said(asked)
    assert "'level', a number that changes" in message
    assert f"d.pddl:{line_of(asked, '(:durative-action recharge')}" in message


def test_files_that_are_much_too_large_or_deep_are_refused() -> None:
    assert "nested more than" in said(SUAVE_DOMAIN.replace("(:functions )", "(" * 100_000))
    assert "more than" in said(" " * 5_000_001)


def test_too_many_ways_to_fill_in_parameters_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grounding, "MOST_OPERATORS", 100)
    many = " ".join(f"p{number}" for number in range(2, 60))
    message = said(SUAVE_DOMAIN, SUAVE_PROBLEM.replace("p1 - pipeline", f"p1 {many} - pipeline"))
    assert "more than 100 ways to fill in the parameters" in message


def test_a_choice_between_too_many_combinations_is_refused() -> None:
    facts = " ".join(f"(f{n})" for n in range(24))
    pairs = " ".join(f"(or (f{n}) (f{n + 1}))" for n in range(0, 24, 2))
    domain = f"""(define (domain d) (:requirements :adl) (:predicates {facts} (done))
      (:action a :parameters () :precondition (and {pairs}) :effect (done))
      (:action b :parameters () :precondition (done) :effect (and {facts})))"""
    problem = "(define (problem p) (:domain d) (:init) (:goal (done)))"
    assert "a choice between more than" in said(domain, problem)
