"""The missions, each uncertainty alone and all together."""

from __future__ import annotations

import math
from pathlib import Path
from statistics import fmean

import pytest

from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver
from suave.scenario import SUAVE_EXTENDED
from tests.suave.flights import BIG_BATTERY, CLEAR_WATER, NO_FAILURE, events_with, fly


@pytest.fixture(scope="module")
def default_run() -> RunRecord:
    """The extended mission as ``rosa run suave-extended`` flies it."""
    return SUAVE_EXTENDED.run(RunRequest(), SilentObserver())


def test_in_the_default_run_all_three_uncertainties_are_reacted_to(default_run: RunRecord) -> None:
    assert len(default_run.reactions["U1"]) == 1
    assert len(default_run.reactions["U2"]) >= 4
    assert len(default_run.reactions["U3"]) == 1
    assert default_run.reactions["U1"][0].cause_s == pytest.approx(35.0)
    assert default_run.reactions["U3"][0].cause_s == pytest.approx(151.0)


def test_in_the_default_run_the_thruster_is_recovered(default_run: RunRecord) -> None:
    (failed,) = events_with(default_run, "thruster 1 failed")
    assert failed.time_s == pytest.approx(35.0)
    for effect in (
        "fd_recover_motion_inactive unfeasible",
        "fd_recover_motion selected",
        "f_maintain_motion_node activated",
    ):
        assert effect in failed.text
    (recovered,) = events_with(default_run, "thruster 1 recovered")
    assert recovered.time_s == pytest.approx(45.0, abs=0.1)
    for effect in ("fd_recover_motion_inactive selected", "f_maintain_motion_node deactivated"):
        assert effect in recovered.text


def test_in_the_default_run_the_inspection_goes_on_where_it_had_stopped(default_run: RunRecord) -> None:
    metrics = default_run.metrics
    assert metrics["pipeline_found"]
    assert metrics["recharges"] == 1
    (found,) = events_with(default_run, "pipeline found")
    (low,) = events_with(default_run, "inspect_pipeline abandoned", "recharge requested")
    (charged,) = events_with(default_run, "battery recharged")
    assert found.time_s < low.time_s < charged.time_s
    last_stint, total = metrics["distance_inspected_m"], metrics["distance_inspected_total_m"]
    assert total > last_stint > 0
    # What was inspected before the interruption is not inspected again: the end of the path flown is as far along the
    # pipeline as the total says (the pipeline runs towards smaller x).
    columns = default_run.trajectory_columns
    end = dict(zip(columns, default_run.trajectory[-1], strict=True))
    assert math.dist((end["x_m"], end["y_m"]), (-15.0, 0.0)) == pytest.approx(total, abs=4.0)


def test_the_trajectory_shows_the_altitude_that_the_visibility_allows(default_run: RunRecord) -> None:
    """While searching and settled, the vehicle is at one of the three altitudes, low when one sees little."""
    rows = [dict(zip(default_run.trajectory_columns, row, strict=True)) for row in default_run.trajectory]
    low = [row["z_m"] for row in rows if 30 <= row["time_s"] <= 55]
    assert all(z == pytest.approx(-19.0, abs=0.5) for z in low)
    high = [row["z_m"] for row in rows if 76 <= row["time_s"] <= 90]
    assert all(z == pytest.approx(-17.0, abs=0.5) for z in high)


def test_u1_alone(tmp_path: Path) -> None:
    record = fly(tmp_path, **CLEAR_WATER, **BIG_BATTERY, thruster_events=["(3,failure,20)", "(5,failure,30)"])
    assert [r.cause_s for r in record.reactions["U1"]] == pytest.approx([20.0, 50.0])
    assert not record.reactions["U2"]
    assert not record.reactions["U3"]
    assert len(events_with(record, "recovered:", "fd_recover_motion_inactive feasible")) == 2


def test_several_failed_thrusters_are_recovered_one_after_the_other(tmp_path: Path) -> None:
    events = ["(1,failure,20)", "(2,failure,0)", "(6,failure,5)"]
    record = fly(tmp_path, **CLEAR_WATER, **BIG_BATTERY, thruster_events=events)
    recovered = [e for e in record.events if " recovered" in e.text]
    assert [e.time_s for e in recovered] == pytest.approx([30.0, 30.25, 30.5], abs=0.05)
    assert "fd_recover_motion_inactive feasible" in recovered[-1].text
    assert all("feasible" not in event.text for event in recovered[:-1])


def test_a_thruster_that_recovers_by_itself_needs_no_recovery_node(tmp_path: Path) -> None:
    events = ["(1,failure,20)", "(1,recovery,4)"]
    record = fly(tmp_path, **CLEAR_WATER, **BIG_BATTERY, thruster_events=events)
    (recovered,) = events_with(record, "thruster 1 recovered")
    assert recovered.time_s == pytest.approx(24.0)
    assert "f_maintain_motion_node deactivated" in recovered.text


def test_u2_alone(tmp_path: Path) -> None:
    record = fly(tmp_path, **NO_FAILURE, **BIG_BATTERY)
    assert len(record.reactions["U2"]) >= 4
    assert not record.reactions["U1"]
    assert not record.reactions["U3"]
    changes = [event.text.partition(": ")[2] for event in events_with(record, "visibility", "altitude")]
    assert changes[:4] == ["altitude 3.0 -> 2.0", "altitude 2.0 -> 1.0", "altitude 1.0 -> 2.0", "altitude 2.0 -> 3.0"]


def test_u3_alone(tmp_path: Path) -> None:
    record = fly(tmp_path, **CLEAR_WATER, **NO_FAILURE)
    assert not record.reactions["U1"]
    assert not record.reactions["U2"]
    assert record.metrics["recharges"] == len(record.reactions["U3"]) == 1
    assert record.reactions["U3"][0].cause_s == pytest.approx(151.0)
    for event in events_with(record, "recharge requested"):
        assert "search_pipeline unfeasible, inspect_pipeline unfeasible" in event.text


def test_nothing_goes_wrong_and_nothing_is_adapted(tmp_path: Path) -> None:
    record = fly(tmp_path, **CLEAR_WATER, **NO_FAILURE, **BIG_BATTERY)
    assert not any(record.reactions.values())
    assert record.metrics["pipeline_found"]


def test_a_mission_ends_early_when_the_pipeline_is_inspected(tmp_path: Path) -> None:
    record = fly(tmp_path, **CLEAR_WATER, **NO_FAILURE, **BIG_BATTERY, time_limit=900)
    assert record.ended_by == "pipeline inspected"
    assert record.duration_s < 900
    length = 2 * 42.6
    assert record.metrics["distance_inspected_m"] == pytest.approx(length, abs=0.5)
    assert record.completed


def test_reaction_times_are_the_services_delay_and_a_little_computing(default_run: RunRecord) -> None:
    for reactions in default_run.reactions.values():
        for reaction in reactions:
            assert reaction.delay_s == pytest.approx(0.003)
            assert reaction.compute_s > 0
            assert reaction.total_s == reaction.delay_s + reaction.compute_s


def test_without_a_manager_nothing_adapts(tmp_path: Path) -> None:
    record = fly(tmp_path, manager="none")
    assert not any(record.reactions.values())
    assert not events_with(record, "recovered")
    assert not events_with(record, "recharge requested")
    assert events_with(record, "the battery is empty")
    rows = [dict(zip(record.trajectory_columns, row, strict=True)) for row in record.trajectory]
    searching = [row["z_m"] for row in rows if 30 <= row["time_s"] <= 100]
    assert all(z == pytest.approx(-19.0, abs=0.5) for z in searching)


def test_without_a_manager_the_altitude_is_the_one_configured(tmp_path: Path) -> None:
    record = fly(tmp_path, manager="none", **BIG_BATTERY, f_generate_search_path_mode="fd_spiral_high", time_limit=40)
    assert record.trajectory[-1][3] == pytest.approx(-17.0, abs=0.5)


@pytest.mark.slow
def test_rosa_finds_the_pipeline_sooner_and_inspects_more_than_no_manager(tmp_path: Path) -> None:
    """The order and the effect of the ROSA paper's table 6, with seeds that nothing was fitted to."""

    def means(manager: str) -> tuple[float, float]:
        flown = [fly(tmp_path, extended=False, manager=manager, seed=seed).metrics for seed in range(5000, 5030)]
        return fmean(m["search_time_s"] for m in flown), fmean(m["distance_inspected_m"] for m in flown)

    search, distance = means("rosa")
    search_unmanaged, distance_unmanaged = means("none")
    assert search < 0.8 * search_unmanaged
    assert distance > 1.3 * distance_unmanaged
