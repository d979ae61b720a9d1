"""The three adaptation scenarios of the ROSA paper, section 7.4.2, as a behaviour tree and as a plan."""

from __future__ import annotations

import pytest

from rosa_simulation.run_record import RunRecord
from tests.uav_example.flights import SOUND_GRIPPER, STEADY_BATTERY, actions, events_with, fly

pytestmark = pytest.mark.parametrize("task_layer", ["bt", "pddl"])


def after(record: RunRecord, words: str) -> list[str]:
    """The actions that were requested from the first event with these words."""
    (first, *_) = events_with(record, words)
    return [
        name
        for event in record.events
        if event.time_s >= first.time_s
        for fact in event.facts
        if fact["fact"] == "actions"
        for name in fact["requested"]
    ]


def test_battery_too_low_to_search_so_it_returns_and_recharges_and_searches_on(task_layer: str) -> None:
    """Scenario 1. (The paper's text names A2 here, its model and the sense of it A4: return to base.)"""
    record = fly(task_layer=task_layer, samples=0, drain_search=0.01)
    assert after(record, "search unfeasible")[:2] == ["return_base", "search"]
    (low, *_) = events_with(record, "battery", "search unfeasible")
    assert "search abandoned, return_base requested" in low.text
    assert record.reactions["U1"][0].cause_s == low.time_s
    assert record.metrics["recharges"] == 2
    assert record.metrics["area_searched"] == 1.0
    assert record.ended_by == "mission done"


def test_battery_too_low_to_pick_up_so_it_analyses_on_site(task_layer: str) -> None:
    """Scenario 2, found with a battery that is low already: nothing was begun, so nothing is folded."""
    record = fly(task_layer=task_layer, **SOUND_GRIPPER, **STEADY_BATTERY, initial_charge=0.4)
    first, *_ = events_with(record, "found")
    assert "analyze_in_situ requested" in first.text
    assert ("analyze", "requested") not in actions(record)
    assert record.metrics["samples_in_situ"] == record.metrics["samples"] == 6
    assert len(record.reactions["U2"]) == 6
    assert [name for name, what in actions(record) if name == "land_fold" and what == "requested"] == ["land_fold"]


def test_battery_getting_too_low_while_picking_up_so_it_lands_and_folds_and_analyses_on_site(task_layer: str) -> None:
    """Scenario 2, while the analysis is under way."""
    record = fly(
        task_layer=task_layer, **{**SOUND_GRIPPER, **STEADY_BATTERY, "drain_analyze": 0.01}, initial_charge=0.6
    )
    assert after(record, "analyze abandoned")[:2] == ["land_fold", "analyze_in_situ"]
    (low,) = events_with(record, "analyze abandoned")
    assert low.text.startswith("battery")
    assert "fd_fold_gripper selected" in low.text
    assert record.reactions["U2"][0].cause_s == pytest.approx(low.time_s)
    assert record.metrics["samples_in_situ"] == 6


def test_the_gripper_fails_while_picking_up_so_it_lands_and_folds_and_analyses_on_site(task_layer: str) -> None:
    """Scenario 3: with the gripper failed, the spring folds it."""
    record = fly(task_layer=task_layer, **STEADY_BATTERY, gripper_fails_after=30.0)
    (failed,) = events_with(record, "the gripper failed")
    assert "analyze abandoned, land_fold requested" in failed.text
    assert "fd_fold_gripper_by_spring selected" in failed.text
    assert after(record, "the gripper failed")[:2] == ["land_fold", "analyze_in_situ"]
    assert [reaction.cause_s for reaction in record.reactions["U3"]] == pytest.approx([failed.time_s])
    assert record.metrics["samples_picked_up"] == 1
    assert record.metrics["samples_in_situ"] == 5
    assert record.ended_by == "mission done"


@pytest.mark.parametrize("seed", range(4))
def test_an_interrupted_analysis_is_never_followed_by_one_on_site_without_folding(task_layer: str, seed: int) -> None:
    record = fly(task_layer=task_layer, seed=seed, samples=10)
    unfolded = False
    for name, what in actions(record):
        if (name, what) == ("analyze", "abandoned"):
            unfolded = True
        elif (name, what) == ("land_fold", "completed"):
            unfolded = False
        elif (name, what) == ("analyze_in_situ", "requested"):
            assert not unfolded
    metrics = record.metrics
    assert metrics["samples_picked_up"] + metrics["samples_in_situ"] == metrics["samples_found"] == 10


def test_without_a_spring_a_failed_gripper_is_the_end_of_it(task_layer: str) -> None:
    """What the base model says, and what happens then: neither analysis can be done, and the sample stays."""
    record = fly(task_layer=task_layer, **STEADY_BATTERY, gripper_fails_after=5.0, spring=False, time_limit=200.0)
    (failed,) = events_with(record, "the gripper failed")
    assert "land_fold unfeasible" in failed.text
    assert ("analyze_in_situ", "requested") not in actions(record)
    assert record.metrics["samples_found"] == 1
    assert record.metrics["samples_in_situ"] == 0
    assert record.ended_by != "mission done"
    if task_layer == "pddl":
        assert not record.completed
        assert "land_fold" in record.ended_by
