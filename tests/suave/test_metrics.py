"""Metric definitions on scripted runs with known answers."""

from __future__ import annotations

import numpy as np
import pytest

from rosa_core import SimulationClock
from rosa_core.clock import Stopwatch
from suave import monitors
from suave.metrics import MissionMetrics
from suave.mission_config import MissionConfig
from suave.robot import SuaveRobot


@pytest.fixture
def robot() -> SuaveRobot:
    """A robot whose mission has begun, in water where one sees 3.75 m, and that nobody manages."""
    config = MissionConfig(water_visibility_min=3.75, water_visibility_max=3.75, thruster_events=())
    robot = SuaveRobot(SimulationClock(), config, np.random.default_rng(0), with_battery=True)
    robot.metrics = MissionMetrics(robot, Stopwatch())  # type: ignore[attr-defined]
    robot.arm()
    robot.set_guided()
    return robot


def publish(robot: SuaveRobot, array: monitors.DiagnosticArray) -> None:
    for subscriber in robot.on_diagnostics:
        subscriber(array)


def delays(robot: SuaveRobot, name: str) -> list[float]:
    return [reaction.delay_s for reaction in robot.metrics.times.reactions[name]]  # type: ignore[attr-defined]


def test_u1_is_from_the_diagnostic_to_the_recovery_node_active(robot: SuaveRobot) -> None:
    robot.clock.advance_to(10.0)
    publish(robot, monitors.thruster(10.0, 1, works=False))
    robot.clock.advance_to(12.0)
    robot.activate("f_maintain_motion_node")
    robot.clock.advance_to(13.0)
    assert delays(robot, "U1") == pytest.approx([2.003])


def test_u2_is_from_the_first_wrong_altitude_to_the_expected_one(robot: SuaveRobot) -> None:
    robot.activate("f_generate_search_path_node")
    robot.set_parameters("f_generate_search_path_node", {"spiral_altitude": 2.0})
    robot.clock.advance_to(1.5)  # at 1.0 s the first visibility of 3.75 m asks for 3.0 m
    robot.set_parameters("f_generate_search_path_node", {"spiral_altitude": 1.0})  # wrong, and no end of it
    robot.clock.advance_to(4.2)
    robot.set_parameters("f_generate_search_path_node", {"spiral_altitude": 3.0})
    robot.clock.advance_to(6.0)
    assert delays(robot, "U2") == pytest.approx([3.203])


def test_u2_does_not_count_while_the_battery_is_low_or_nothing_is_searched(robot: SuaveRobot) -> None:
    robot.clock.advance_to(3.5)
    assert delays(robot, "U2") == []
    robot.clock.advance_to(160.0)
    robot.activate("f_generate_search_path_node")
    robot.clock.advance_to(165.0)
    robot.set_parameters("f_generate_search_path_node", {"spiral_altitude": 3.0})
    robot.clock.advance_to(170.0)
    assert delays(robot, "U2") == []


def test_u3_is_from_the_first_low_level_to_the_recharge_node_active(robot: SuaveRobot) -> None:
    robot.clock.advance_to(153.0)  # below 0.25 since the diagnostic of 151 s
    robot.activate("generate_recharge_path_node")
    robot.clock.advance_to(154.0)
    assert delays(robot, "U3") == pytest.approx([2.003])


def test_a_pipeline_that_is_not_found_was_searched_for_all_the_time(robot: SuaveRobot) -> None:
    robot.clock.advance_to(300.0)
    summary = robot.metrics.summary()  # type: ignore[attr-defined]
    assert summary["search_time_s"] == 300.0
    assert summary["pipeline_found"] is False
    assert summary["distance_inspected_m"] == 0.0


def test_the_exemplars_distance_begins_anew_with_every_stint_and_the_total_does_not(robot: SuaveRobot) -> None:
    def follow(seconds: float) -> None:
        robot.activate("f_follow_pipeline_node")
        robot.clock.advance_to(robot.clock.now() + seconds)
        robot.deactivate("f_follow_pipeline_node")
        robot.clock.advance_to(robot.clock.now() + 1.0)

    follow(40.0)
    first = robot.follow.distance
    assert first > 4.0
    follow(30.0)
    summary = robot.metrics.summary()  # type: ignore[attr-defined]
    assert 0 < summary["distance_inspected_m"] < first
    assert summary["distance_inspected_total_m"] == pytest.approx(first + summary["distance_inspected_m"])
