"""Helpers that fly missions with chosen uncertainties."""

from __future__ import annotations

from rosa_simulation.run_record import MissionEvent, RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver
from uav_example.scenario import UAV

SOUND_GRIPPER = {"gripper_fails_after": 1e6}
STEADY_BATTERY = dict.fromkeys(
    ("drain_hover", "drain_search", "drain_analyze", "drain_analyze_in_situ", "drain_land_fold"), 0.0
)


def fly(*, manager: str = "rosa", task_layer: str = "bt", seed: int = 0, **parameters: object) -> RunRecord:
    """Fly a mission whose world has these parameters."""
    request = RunRequest(manager=manager, task_layer=task_layer, seed=seed, parameters=parameters)
    return UAV.run(request, SilentObserver())


def events_with(record: RunRecord, *words: str) -> list[MissionEvent]:
    """The events whose text has all the words."""
    return [event for event in record.events if all(word in event.text for word in words)]


def actions(record: RunRecord) -> list[tuple[str, str]]:
    """What was requested and how it ended, in order: ``(action, requested | completed | abandoned | failed)``."""
    found: list[tuple[str, str]] = []
    for event in record.events:
        for fact in event.facts:
            if fact["fact"] == "actions":
                found += [(name, result) for name, result in fact["ended"]]
                found += [(name, "requested") for name in fact["requested"]]
    return found
