"""The missions as PDDL plans: the same flight with the same skills."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rosa_core import InputError
from rosa_simulation.managers.rosa_pddl import load_mission_task
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver
from suave.missions import EXTENDED_MISSION, PLAIN_MISSION
from suave.scenario import SUAVE, SUAVE_EXTENDED
from suave.skills import SearchPipeline
from task_layer.skill import SkillStatus
from tests.suave.flights import events_with
from tests.suave.test_determinism import record
from tests.task_layer.pddl.kit import SUAVE_DOMAIN, SUAVE_PROBLEM, names

SENSED = ("robot_started", "pipeline_found", "pipeline_inspected")


@pytest.fixture(scope="module")
def planned() -> RunRecord:
    """The extended mission as ``rosa run suave-extended --task-layer pddl`` flies it."""
    return SUAVE_EXTENDED.run(RunRequest(task_layer="pddl"), SilentObserver())


def test_the_plan_flies_the_mission_that_the_tree_flies(planned: RunRecord) -> None:
    tree = SUAVE_EXTENDED.run(RunRequest(), SilentObserver())
    timed = "mean_reaction_time_s"
    assert {k: v for k, v in planned.metrics.items() if k != timed} == pytest.approx(
        {k: v for k, v in tree.metrics.items() if k != timed}
    )
    for name, reactions in tree.reactions.items():
        assert [r.delay_s for r in planned.reactions[name]] == pytest.approx([r.delay_s for r in reactions])


def test_a_low_battery_is_replanned_for_and_every_plan_is_recorded(planned: RunRecord) -> None:
    assert [names(plan.steps) for plan in planned.plans] == [
        ["start_robot", "search_pipeline", "inspect_pipeline"],
        ["recharge", "inspect_pipeline"],
    ]
    assert [plan.time_s for plan in planned.plans] == [0.0, 151.0]
    assert "inspect_pipeline is unfeasible: battery_level 0.245" in planned.plans[1].reason
    assert all(plan.cost_s > 0 for plan in planned.plans)
    (low,) = events_with(planned, "battery 0.24", "plan: recharge, inspect_pipeline", "recharge requested")
    assert low.time_s == pytest.approx(151.0)


def test_a_skill_that_raises_is_in_the_record_and_the_mission_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_self: SearchPipeline) -> SkillStatus:
        raise OSError("no sonar")

    monkeypatch.setattr(SearchPipeline, "update", broken)
    record = SUAVE.run(RunRequest(task_layer="pddl", time_limit=100.0), SilentObserver())
    raised = [fact for event in record.events for fact in event.facts if fact["fact"] == "raised"]
    assert {fact["who"] for fact in raised} == {"(search_pipeline search_pipeline p1 bluerov)"}
    assert "Traceback" in raised[0]["traceback"]
    assert "its skill raised OSError: no sonar" in record.plans[1].no_plan + record.plans[1].reason
    assert "failed 3 times" in record.ended_by
    assert not record.completed


def test_the_plain_mission_needs_one_plan() -> None:
    record = SUAVE.run(RunRequest(task_layer="pddl", time_limit=150.0), SilentObserver())
    assert [names(plan.steps) for plan in record.plans] == [["start_robot", "search_pipeline", "inspect_pipeline"]]
    assert record.metrics["pipeline_found"]


def test_files_of_ones_own_are_flown_unchanged(tmp_path: Path) -> None:
    """Another spelling, another style of actions: plain instead of durative, and no word on feasibility."""
    domain, problem = tmp_path / "d.pddl", tmp_path / "p.pddl"
    domain.write_text(
        """(define (domain DIVE) (:requirements :strips) (:predicates (Begun) (Pipeline_Found) (surveyed))
        (:action Start-Robot :parameters () :effect (Begun))
        (:action Search-Pipeline :parameters () :precondition (Begun) :effect (Pipeline_Found))
        (:action Inspect-Pipeline :parameters () :precondition (Pipeline_Found) :effect (surveyed)))""",
        encoding="utf-8",
    )
    problem.write_text("(define (problem p) (:domain dive) (:init) (:goal (surveyed)))", encoding="utf-8")
    request = RunRequest(task_layer="pddl", time_limit=160.0, domain=domain, problem=problem)
    record = SUAVE_EXTENDED.run(request, SilentObserver())
    assert names(record.plans[0].steps) == ["Start-Robot", "Search-Pipeline", "Inspect-Pipeline"]
    assert record.metrics["pipeline_found"]
    # At 151 s nothing of it is feasible; it cannot recharge, and waits.
    assert record.plans[-1].time_s == pytest.approx(151.0)
    assert "inspect_pipeline (unfeasible)" in record.plans[-1].no_plan


def test_the_files_of_the_mission_are_as_users_have_them() -> None:
    assert "(:functions )" in SUAVE_DOMAIN
    assert "action_feasible" not in SUAVE_PROBLEM
    assert len(load_mission_task(EXTENDED_MISSION, SENSED).operators) == 4
    assert len(load_mission_task(PLAIN_MISSION, SENSED).operators) == 3


def test_a_mission_without_any_plan_breaks_off(tmp_path: Path) -> None:
    problem = tmp_path / "p.pddl"
    problem.write_text(
        SUAVE_PROBLEM.replace("(search_pipeline_action search_pipeline)", "").replace("(recharge_action recharge)", ""),
        encoding="utf-8",
    )
    record = SUAVE_EXTENDED.run(RunRequest(task_layer="pddl", problem=problem), SilentObserver())
    assert not record.completed
    assert record.ended_by.startswith(
        "no plan for 60 s: (pipeline_found p1), (pipeline_inspected p1) cannot be reached"
    )


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        (RunRequest(domain=Path("d.pddl")), "add --task-layer pddl"),
        (RunRequest(task_layer="pddl", manager="none"), "fly plans with --manager rosa"),
        (RunRequest(task_layer="pddl", problem=Path("no.pddl")), "no.pddl: cannot read it"),
    ],
)
def test_what_does_not_fit_together_is_refused(request_: RunRequest, words: str) -> None:
    with pytest.raises(InputError, match=words):
        SUAVE_EXTENDED.run(request_, SilentObserver())


@pytest.mark.slow
def test_two_runs_leave_identical_records_and_costs_are_kept_apart(tmp_path: Path) -> None:
    first = record(tmp_path / "a", 7, "1", task_layer="pddl")
    assert record(tmp_path / "b", 7, "2", task_layer="pddl") == first
    run = json.loads(first["run.json"])
    assert [set(plan) for plan in run["plans"]] == [
        {"time_s", "reason", "steps", "kept", "no_plan", "cached", "engine"} for _ in run["plans"]
    ]
    assert run["versions"]["up-pyperplan"]
    wall_clock = json.loads((tmp_path / "a" / "wall_clock.json").read_text(encoding="utf-8"))
    assert len(wall_clock["planning_s"]) == len(run["plans"]) >= 2
