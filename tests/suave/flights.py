"""Helpers that fly missions with chosen uncertainties."""

from __future__ import annotations

from pathlib import Path

import yaml

from rosa_simulation.run_record import MissionEvent, RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver
from rosa_simulation.system_modes import SystemModes, load_system_modes
from suave.managers.modes import mode_control
from suave.mission_config import MissionConfig
from suave.scenario import SUAVE, SUAVE_EXTENDED

CLEAR_WATER = {"water_visibility_min": 3.75, "water_visibility_max": 3.75}
NO_FAILURE: dict[str, object] = {"thruster_events": []}
BIG_BATTERY = {"discharge_time": 100_000}


def suave_modes(*, extended: bool) -> SystemModes:
    """The system modes of the plain or the extended mission."""
    return load_system_modes(mode_control(MissionConfig(), extended=extended).modes_file)


def fly(
    tmp_path: Path, *, extended: bool = True, manager: str = "rosa", seed: int = 0, **parameters: object
) -> RunRecord:
    """Fly a mission whose configuration has these parameters."""
    config = tmp_path / "mission.yaml"
    config.write_text(yaml.safe_dump({"/mission_node": {"ros__parameters": parameters}}), encoding="utf-8")
    scenario = SUAVE_EXTENDED if extended else SUAVE
    return scenario.run(RunRequest(manager=manager, seed=seed, mission_config=config), SilentObserver())


def events_with(record: RunRecord, *words: str) -> list[MissionEvent]:
    """The events whose text has all the words."""
    return [event for event in record.events if all(word in event.text for word in words)]
