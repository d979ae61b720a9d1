"""The mission as a plan: the problem made from the map, and domains and problems of one's own."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import pytest

from agv_example.corridors import Corridor, CorridorMap, Place
from agv_example.missions import MISSION
from agv_example.missions.mission_config import MissionConfig, default_mission, load_mission
from agv_example.missions.problem import mission_problem
from agv_example.scenario import AGV
from rosa_core import InputError
from rosa_simulation.managers.rosa_pddl import load_mission_task
from rosa_simulation.scenario import RunRequest, SilentObserver
from tests.agv_example.drives import drive, driven

OWN_DOMAIN = """
(define (domain waypoints)
  (:requirements :strips :typing)
  (:types waypoint action)
  (:predicates (robot_at ?r - action ?w - waypoint) (connected ?x ?y - waypoint) (action_feasible ?a - action))
  (:action navigate :parameters (?a - action ?x ?y - waypoint)
    :precondition (and (action_feasible ?a) (robot_at ?a ?x) (connected ?x ?y))
    :effect (and (not (robot_at ?a ?x)) (robot_at ?a ?y))))
"""
OWN_PROBLEM = """
(define (problem patrol) (:domain waypoints)
  (:objects navigate - action A C D - waypoint)
  (:init (robot_at navigate A) (connected A C) (connected C D))
  (:goal (robot_at navigate D)))
"""


def test_the_problem_file_is_the_one_made_from_the_default_map() -> None:
    file = files("agv_example.missions").joinpath("agv_problem.pddl")
    assert file.read_text(encoding="utf-8") == mission_problem(load_mission(default_mission())).text


def test_the_plan_says_corridor_by_corridor_how_to_go(tmp_path: Path) -> None:
    record = drive(tmp_path, task_layer="pddl", events=[{"at": 0, "fails": "kinect"}])
    (plan,) = record.plans
    assert plan.steps == (
        "(navigate navigate agv1 departure stop1 C4 A C)",
        "(navigate navigate agv1 departure stop1 C3 C D)",
        "(navigate navigate agv1 departure stop1 C2 D B)",
        "(arrive agv1 departure stop1 B)",
    )


def test_a_corridor_that_closes_makes_a_new_plan_of_all_stops(tmp_path: Path) -> None:
    events = [{"at": 10, "closes": "C1"}]
    record = drive(tmp_path, task_layer="pddl", goals=["B", "C"], events=events, time_limit=600)
    first, second = record.plans
    assert [step.split()[-3:] for step in first.steps if "navigate " in step] == [
        ["C1", "A", "B)"],
        ["C2", "B", "D)"],
        ["C3", "D", "C)"],
    ]
    assert "best_way" in second.reason
    assert [step.split()[-3] for step in second.steps if "navigate " in step] == ["C4", "C3", "C2", "C2", "C3"]
    assert record.ended_by == "all goals reached"


def test_tree_and_plan_achieve_the_same(tmp_path: Path) -> None:
    mission = Path(__file__).parents[2] / "examples" / "agv_warehouse.yaml"
    tree, plan = (
        AGV.run(RunRequest(task_layer=layer, mission_config=mission), SilentObserver()).metrics
        for layer in ("bt", "pddl")
    )
    timed = {"mean_reaction_time_s"}
    assert {k: v for k, v in plan.items() if k not in timed} == {k: v for k, v in tree.items() if k not in timed}


def test_names_that_pddl_cannot_have_are_given_others() -> None:
    places = (Place("Gate 1", 0, 0), Place("gate-1", 5, 0), Place("7", 5, 5))
    ways = (Corridor("7", "Gate 1", "gate-1", 5.0), Corridor("Navigate", "gate-1", "7", 5.0, one_way=True))
    config = MissionConfig(CorridorMap(places, ways), "Gate 1", ("7",))
    problem = mission_problem(config)
    task = load_mission_task(MISSION, ("robot_at", "best_way"), lambda: problem.text)
    assert set(problem.places.values()) == {"Gate 1", "gate-1", "7"}
    assert set(problem.corridors.values()) == {"7", "Navigate"}
    drives = [operator for operator in task.operators if operator.action == "navigate"]
    assert len(drives) == 3, "one way, and two ways"
    named = {tuple(problem.place(name) for name in operator.arguments[-2:]) for operator in drives}
    assert named == {("Gate 1", "gate-1"), ("gate-1", "Gate 1"), ("gate-1", "7")}


def test_a_domain_of_ones_own_need_not_ask_for_the_best_way(tmp_path: Path) -> None:
    domain, problem = tmp_path / "domain.pddl", tmp_path / "problem.pddl"
    domain.write_text(OWN_DOMAIN, encoding="utf-8")
    problem.write_text(OWN_PROBLEM, encoding="utf-8")
    request = RunRequest(task_layer="pddl", domain=domain, problem=problem)
    record = AGV.run(request, SilentObserver())
    assert driven(record) == ["C4", "C3"]
    assert record.ended_by == "mission done"
    assert record.metrics["goals_reached"] == 0, "none of the mission file's goals"


def test_a_file_that_is_no_domain_is_refused(tmp_path: Path) -> None:
    domain = tmp_path / "domain.pddl"
    domain.write_text("(define (domain agv)", encoding="utf-8")
    with pytest.raises(InputError, match=r"domain\.pddl:1"):
        AGV.run(RunRequest(task_layer="pddl", domain=domain), SilentObserver())
