"""Metacontrol: its reasoning as functions, and on the mission."""

from __future__ import annotations

from pathlib import Path

import pytest

from rosa_simulation.managers.metacontrol import REASONING_PERIOD, Metacontroller, ObjectiveStatus, analyse, best_design
from rosa_simulation.system_modes import ModeManager, Situation
from suave import monitors
from suave.managers.modes import DESIGNS, mode_control
from suave.mission_config import MissionConfig
from tests.suave.flights import CLEAR_WATER, NO_FAILURE, events_with, fly, suave_modes
from tests.suave.managers.test_mode_manager import Port

CONTROL = mode_control(MissionConfig(), extended=False)
BY_MODE = {design.mode: design for design in DESIGNS}
SEARCH = [design for design in DESIGNS if design.function == "f_generate_search_path"]
MOTION = [design for design in DESIGNS if design.function == "f_maintain_motion"]


def situation(visibility: float | None = None, *failed: str) -> Situation:
    now = Situation()
    if visibility is not None:
        now.update(monitors.water_visibility(1.0, visibility))
    now.failed.update(failed)
    return now


@pytest.mark.parametrize(
    ("visibility", "mode"),
    [(None, "fd_spiral_high"), (3.25, "fd_spiral_high"), (3.2, "fd_spiral_medium"), (1.25, "fd_spiral_low")],
)
def test_the_best_design_is_the_one_of_highest_performance_that_works(visibility: float | None, mode: str) -> None:
    best = best_design(SEARCH, situation(visibility))
    assert best is not None
    assert best.mode == mode


def test_in_too_murky_water_no_design_works() -> None:
    assert best_design(SEARCH, situation(1.2)) is None


@pytest.mark.parametrize(
    ("mode", "now", "status"),
    [
        (None, situation(3.75), ObjectiveStatus.UNGROUNDED),
        ("fd_spiral_high", situation(3.0), ObjectiveStatus.QUALITY_ERROR),
        ("fd_spiral_medium", situation(3.5), ObjectiveStatus.IMPROVABLE),
        ("fd_spiral_medium", situation(3.0), ObjectiveStatus.SOLVED),
        ("fd_all_thrusters", situation(None, "c_thruster_4"), ObjectiveStatus.COMPONENT_ERROR),
        ("fd_recover_thrusters", situation(None, "c_thruster_4"), ObjectiveStatus.SOLVED),
        ("fd_recover_thrusters", situation(), ObjectiveStatus.IMPROVABLE),
    ],
)
def test_the_status_of_an_objective(mode: str | None, now: Situation, status: ObjectiveStatus) -> None:
    designs = MOTION if mode is not None and "thrusters" in mode else SEARCH
    assert analyse(None if mode is None else BY_MODE[mode], designs, now) is status


@pytest.fixture
def modes() -> ModeManager:
    return ModeManager(suave_modes(extended=False), Port())


def test_an_objective_is_solved_by_the_next_cycle_and_given_up_by_the_one_after_it_ends(modes: ModeManager) -> None:
    controller = Metacontroller(CONTROL, situation(3.75), modes)
    controller.add_objectives(["f_generate_search_path"])
    assert modes.mode("f_generate_search_path") is None
    controller.reason()
    assert modes.mode("f_generate_search_path") == "fd_spiral_high"
    controller.remove_objectives(["f_generate_search_path"])
    controller.reason()
    assert modes.mode("f_generate_search_path") == "fd_unground"


def test_an_objective_of_two_actions_outlasts_the_first(modes: ModeManager) -> None:
    controller = Metacontroller(CONTROL, situation(None, "c_thruster_1"), modes)
    controller.add_objectives(["f_maintain_motion"])
    controller.reason()
    controller.add_objectives(["f_maintain_motion"])
    controller.remove_objectives(["f_maintain_motion"])
    controller.reason()
    assert modes.mode("f_maintain_motion") == "fd_recover_thrusters"


def test_a_design_that_cannot_be_realised_is_tried_again(modes: ModeManager) -> None:
    port: Port = modes._system  # type: ignore[assignment]
    port.broken = {"f_generate_search_path_node"}
    controller = Metacontroller(CONTROL, situation(3.75), modes)
    controller.add_objectives(["f_generate_search_path"])
    controller.reason()
    port.broken = set()
    controller.reason()
    assert modes.mode("f_generate_search_path") == "fd_spiral_high"


def test_on_the_mission_it_adapts_to_thrusters_and_visibility_within_a_cycle(tmp_path: Path) -> None:
    record = fly(tmp_path, extended=False, manager="metacontrol")
    delays = [reaction.delay_s for name in ("U1", "U2") for reaction in record.reactions[name]]
    assert len(record.reactions["U1"]) == 1
    assert len(record.reactions["U2"]) >= 3
    assert all(0.0 < delay <= REASONING_PERIOD + 0.003 for delay in delays)
    assert events_with(record, "f_maintain_motion_node deactivated")
    (found,) = events_with(record, "pipeline found")
    (following,) = events_with(record, "f_follow_pipeline_node activated")
    assert 0.0 <= following.time_s - found.time_s <= REASONING_PERIOD


def test_nothing_to_adapt_and_the_highest_altitude_stays(tmp_path: Path) -> None:
    record = fly(tmp_path, extended=False, manager="metacontrol", **CLEAR_WATER, **NO_FAILURE)
    (only,) = events_with(record, "altitude")
    assert only.text == "altitude 3.0, f_generate_search_path_node activated"
