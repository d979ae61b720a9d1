"""Metric definitions on scripted runs with known answers."""

from __future__ import annotations

import numpy as np
import pytest

from rosa_core import SimulationClock
from rosa_core.clock import Stopwatch
from uav_example import nodes
from uav_example.metrics import MissionMetrics
from uav_example.robot import UavRobot
from uav_example.world.parameters import WorldParameters
from uav_example.world.world import World


class Flight:
    """A robot that nobody manages, and its metrics."""

    def __init__(self, **parameters: object) -> None:
        world = WorldParameters(**parameters)  # type: ignore[arg-type]
        self.robot = UavRobot(World(SimulationClock(), world, np.random.default_rng(0)))
        self.metrics = MissionMetrics(self.robot, Stopwatch())

    def at(self, when: float, *activate: str, deactivate: tuple[str, ...] = ()) -> None:
        """Let time pass, then call these nodes."""
        self.robot.clock.advance_to(when)
        for name in deactivate:
            self.robot.deactivate(name)
        for name in activate:
            self.robot.activate(name)

    def delays(self, name: str) -> list[float]:
        return [reaction.delay_s for reaction in self.metrics.times.reactions[name]]


def test_u1_is_from_the_first_level_too_low_to_search_to_the_home_path() -> None:
    flight = Flight(samples=0, initial_charge=0.3, drain_search=0.01)  # 0.24 at 6 s, and published then
    flight.at(0.0, nodes.SEARCH_PATH)
    flight.at(10.0, nodes.HOME_PATH, deactivate=(nodes.SEARCH_PATH,))
    flight.at(20.0)
    assert flight.delays("U1") == pytest.approx([4.003])


def test_u1_does_not_count_when_nothing_is_searched() -> None:
    flight = Flight(initial_charge=0.2)
    flight.at(5.0, nodes.HOME_PATH)
    flight.at(20.0)
    assert flight.delays("U1") == []


def test_u2_is_from_a_level_too_low_while_picking_up_to_the_landing() -> None:
    flight = Flight(initial_charge=0.55, drain_analyze=0.01, gripper_fails_after=1e6, sight=500.0)  # below 0.5 at 6 s
    flight.robot.world.look_for_samples()
    flight.at(0.0, nodes.PICK_PATH)
    flight.at(8.0, nodes.LAND_PATH, deactivate=(nodes.PICK_PATH,))
    flight.at(20.0, nodes.ANALYZE_PATH)
    flight.at(30.0)
    assert flight.delays("U2") == pytest.approx([2.003])


def test_u2_is_from_finding_a_sample_with_a_low_battery_to_the_analysis_on_site() -> None:
    flight = Flight(initial_charge=0.4, sight=500.0)
    flight.at(2.0)
    flight.robot.world.look_for_samples()
    flight.at(5.0, nodes.ANALYZE_PATH)
    flight.at(10.0)
    assert flight.delays("U2") == pytest.approx([3.003])


def test_u2_is_not_the_batterys_doing_when_the_gripper_has_failed() -> None:
    flight = Flight(initial_charge=0.4, sight=500.0, gripper_fails_after=0.1)
    flight.robot.world.use_gripper()
    flight.robot.world.look_for_samples()
    flight.at(5.0, nodes.ANALYZE_PATH)
    flight.at(10.0)
    assert flight.delays("U2") == []


def test_u3_is_from_the_grippers_failure_to_the_landing() -> None:
    flight = Flight(gripper_fails_after=0.05)
    flight.at(0.0, nodes.PICK_PATH)
    flight.at(3.0)
    flight.robot.world.use_gripper()
    flight.at(4.5, nodes.LAND_PATH, deactivate=(nodes.PICK_PATH,))
    flight.at(10.0)
    assert flight.delays("U3") == pytest.approx([1.503])
    assert flight.metrics.summary()["gripper_failed"] is True


def test_a_sample_that_is_analysed_all_the_same_needs_no_reaction() -> None:
    flight = Flight(initial_charge=0.51, gripper_fails_after=1e6, drain_analyze=0.001, sight=500.0)
    flight.robot.world.look_for_samples()
    flight.at(0.0, nodes.PICK_PATH, nodes.CONTROL_MOTION)
    flight.at(60.0, nodes.LAND_PATH, deactivate=(nodes.PICK_PATH,))
    flight.at(70.0)
    assert flight.delays("U2") == []
    summary = flight.metrics.summary()
    assert (summary["samples_found"], summary["samples_picked_up"], summary["adaptations"]) == (1, 1, 0)
    assert summary["energy_used"] == pytest.approx(0.06 + 0.002 * 10, abs=0.001)
