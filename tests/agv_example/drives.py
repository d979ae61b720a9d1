"""Helpers that run missions of the AGV."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from agv_example.scenario import AGV
from rosa_simulation.run_record import MissionEvent, RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver

CROSSING: dict[str, Any] = {"map": "paper.yaml", "start": "A", "goals": ["B"], "minimise": "energy"}


def drive(tmp_path: Path, *, manager: str = "rosa", task_layer: str = "bt", seed: int = 0, **mission: Any) -> RunRecord:
    """Carry out the crossing from A to B on the paper's map, with these parts of the mission otherwise."""
    file = tmp_path / "mission.yaml"
    file.write_text(yaml.safe_dump({**CROSSING, **mission}), encoding="utf-8")
    request = RunRequest(manager=manager, task_layer=task_layer, seed=seed, mission_config=file)
    record = AGV.run(request, SilentObserver())
    assert events_with(record, "raised") == []
    return record


def routes(record: RunRecord) -> list[Mapping[str, Any]]:
    """The routes that were decided on, in order."""
    return [fact for event in record.events for fact in event.facts if fact["fact"] == "route"]


def way(route: Mapping[str, Any]) -> list[tuple[str, str]]:
    """The corridors of a route, each with the design that localises there."""
    return [(leg["corridor"], leg["configuration"].split(",")[0]) for leg in route["legs"]]


def driven(record: RunRecord) -> list[str]:
    """The corridors in which the robot set out, in order; setting out anew in the same one counts once."""
    found: list[str] = []
    for event in record.events:
        for fact in event.facts:
            if fact["fact"] == "driving" and found[-1:] != [fact["subject"]]:
                found.append(fact["subject"])
    return found


def events_with(record: RunRecord, *words: str) -> list[MissionEvent]:
    """The events whose text has all the words."""
    return [event for event in record.events if all(word in event.text for word in words)]
