"""The random manager: when it changes modes, and that it does so at random."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_simulation.run_record import RunRecord
from tests.suave.flights import CLEAR_WATER, fly

SEARCH, FOLLOW = "f_generate_search_path_node", "f_follow_pipeline_node"


def changes(record: RunRecord, node: str) -> list[tuple[float, str]]:
    """When a node was changed, and how."""
    return [
        (event.time_s, fact["fact"]) for event in record.events for fact in event.facts if fact.get("subject") == node
    ]


def flown(tmp_path: Path, seed: int, **parameters: object) -> RunRecord:
    return fly(tmp_path, extended=False, manager="random", seed=seed, **CLEAR_WATER, **parameters)


def test_modes_change_when_an_action_begins_and_then_once_a_period(tmp_path: Path) -> None:
    record = flown(tmp_path, 1, adaptation_period=7.0)
    times = sorted({time for time, _ in changes(record, SEARCH)})
    (phase,) = {round(time % 7.0, 3) for time in times if time > 0 and time < record.metrics["search_time_s"]}
    assert 0.0 <= phase < 7.0
    assert len(times) > 3


def test_while_inspecting_the_function_of_inspecting_is_changed(tmp_path: Path) -> None:
    records = [flown(tmp_path, seed, adaptation_period=5.0) for seed in range(4)]
    found = [record for record in records if record.metrics["pipeline_found"]]
    assert found
    for record in found:
        after = record.metrics["search_time_s"]
        assert all(time <= after for time, _ in changes(record, SEARCH))
        assert all(time >= after for time, _ in changes(record, FOLLOW))
    kinds = {change for record in found for _, change in changes(record, FOLLOW)}
    assert {"activated", "deactivated"} <= kinds


def test_thrusters_are_not_recovered(tmp_path: Path) -> None:
    assert not changes(flown(tmp_path, 1), "f_maintain_motion_node")


def test_the_seed_decides(tmp_path: Path) -> None:
    first, again, other = (changes(flown(tmp_path, seed), SEARCH) for seed in (3, 3, 4))
    assert first == again != other


@pytest.mark.parametrize("seed", range(3))
def test_every_altitude_is_one_of_the_modes(tmp_path: Path, seed: int) -> None:
    record = flown(tmp_path, seed, adaptation_period=2.0, time_limit=60)
    changes = [event.text for event in record.events if "altitude" in event.text]
    assert changes
    assert all(any(f"altitude {a}" in text or f"-> {a}" in text for a in ("1.0", "2.0", "3.0")) for text in changes)
