"""Physics, geometry, water and battery."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np
import pytest

from rosa_core import SimulationClock
from rosa_simulation.lifecycle_node import LifecycleNode
from rosa_simulation.robot_event import NodeChange, RobotEvent
from suave.components.spiral_search import SpiralSearch
from suave.events import SuaveEvent
from suave.mission_config import MissionConfig
from suave.robot import SuaveRobot
from suave.world.environment import Battery, PipelineDetector, WaterVisibility, inspection_path
from suave.world.parameters import WorldParameters
from suave.world.vehicle import Vehicle

STILL = dataclasses.replace(WorldParameters(), start_spread=0.0, noise_horizontal=0.0, noise_vertical=0.0)


def vehicle() -> Vehicle:
    return Vehicle(STILL, np.random.default_rng(0))


def fly(body: Vehicle, seconds: float) -> None:
    for _ in range(round(seconds / STILL.control_period)):
        body.step()


def test_the_vehicle_is_neutrally_buoyant() -> None:
    body = vehicle()
    fly(body, 30.0)
    assert body.position == pytest.approx(STILL.start, abs=0.01)


def test_it_flies_to_a_setpoint_and_stays_there() -> None:
    body = vehicle()
    body.target = (-12.0, 4.0, -17.0)
    fly(body, 40.0)
    assert body.position == pytest.approx(body.target, abs=0.05)


def test_it_flies_at_most_at_its_speed_limits() -> None:
    body = vehicle()
    body.target = (100.0, 0.0, -18.5)
    fly(body, 20.0)
    before = body.position
    fly(body, 10.0)
    assert math.dist(before, body.position) / 10.0 == pytest.approx(1.0, abs=0.03)


def test_a_failed_thruster_slows_it_down_and_pushes_it_aside() -> None:
    healthy, limping = vehicle(), vehicle()
    limping.set_thruster(1, False)
    for body in (healthy, limping):
        body.target = (20.0, STILL.start[1], -18.5)
        fly(body, 20.0)
    assert limping.position[0] - STILL.start[0] < 0.8 * (healthy.position[0] - STILL.start[0])
    assert abs(limping.yaw) > math.radians(20) > abs(healthy.yaw)
    assert limping.failed_thrusters() == [1]


def test_without_power_it_does_not_get_anywhere() -> None:
    body = vehicle()
    body.powered = False
    body.target = (0.0, 0.0, -18.0)
    fly(body, 20.0)
    assert body.position == pytest.approx(STILL.start, abs=0.01)


def test_the_estimate_wanders_about_the_position_as_much_as_it_should() -> None:
    body = Vehicle(WorldParameters(), np.random.default_rng(1))
    errors = []
    for _ in range(20_000):
        body.step()
        errors.append([e - p for e, p in zip(body.estimate, body.position, strict=True)])
    spread = np.std(errors, axis=0)
    assert spread == pytest.approx([0.2, 0.2, 0.1], rel=0.25)


def test_visibility_follows_its_cosine_in_whole_seconds() -> None:
    water = WaterVisibility(1.25, 3.75, 80.0, 0.0)
    assert water.at(0.0) == 3.75
    assert water.at(40.0) == pytest.approx(1.25)
    assert water.at(20.9) == water.at(20.0) == pytest.approx(2.5)
    assert WaterVisibility(1.25, 3.75, 80.0, 20.0).at(0.0) == water.at(20.0)


@pytest.mark.parametrize(
    ("position", "visibility", "seen"),
    [
        ((-20.0, 1.2, -17.0), 3.0, True),  # 2.25 m up, sees 1.30 m aside
        ((-20.0, 1.4, -17.0), 3.0, False),
        ((-20.0, 0.0, -17.0), 2.2, False),  # too high for the water
        ((0.0, 0.0, -17.0), 3.0, False),  # beyond the end
    ],
)
def test_the_pipeline_is_seen_within_reach_and_visibility(
    position: tuple[float, float, float], visibility: float, seen: bool
) -> None:
    assert PipelineDetector().sees(position, visibility) is seen


def test_the_path_goes_along_the_whole_pipeline_and_back() -> None:
    path = inspection_path()
    assert path[0] == path[-1] == (-15.0, 0.0)
    assert path[len(path) // 2] == (-51.56, -15.14)
    assert sum(math.dist(a, b) for a, b in itertools.pairwise(path)) == pytest.approx(85.2, abs=0.1)


def test_the_battery_is_empty_after_its_discharge_time() -> None:
    battery = Battery(200.0, since=10.0)
    assert battery.level(10.0) == 1.0
    assert battery.level(160.0) == pytest.approx(0.25)
    assert battery.level(500.0) == 0.0
    battery.recharge(500.0)
    assert battery.level(500.0) == 1.0
    assert battery.charges == 1


def test_the_spiral_widens_by_what_is_seen_in_a_revolution() -> None:
    """Setpoints a second apart, 0.1 rad each: after a revolution the radius is 2 * altitude * tan(30 deg)."""
    clock, body = SimulationClock(), vehicle()
    node = SpiralSearch(clock, 0.0, lambda _node, _change: None, body, start=0.0)
    node.activate()
    clock.advance_to(0.5)
    for second in range(1, 64):
        if body.target is not None:
            body.estimate = body.target  # each setpoint is reached at once
        clock.advance_to(second + 0.5)
    assert body.target is not None
    x, y, z = STILL.start
    assert math.hypot(body.target[0] - x, body.target[1] - y) == pytest.approx(2 * math.tan(math.pi / 6), rel=0.03)
    assert body.target[2] == -19.0
    assert z == -18.5


def test_a_node_takes_effect_after_the_time_that_a_service_takes() -> None:
    clock = SimulationClock()
    changes: list[tuple[float, NodeChange]] = []
    node = LifecycleNode(clock, 0.003, lambda _node, change: changes.append((clock.now(), change)))
    node.activate()
    node.activate()
    clock.advance_to(1.0)
    node.deactivate()
    clock.advance_to(2.0)
    assert changes == [(0.003, NodeChange.ACTIVATED), (1.003, NodeChange.DEACTIVATED)]


def test_an_unknown_parameter_or_component_is_a_failed_call() -> None:
    robot = SuaveRobot(SimulationClock(), MissionConfig(), np.random.default_rng(0), with_battery=False)
    assert robot.activate("f_follow_pipeline_node") is False  # nothing runs before GUIDED
    robot.arm()
    robot.set_guided()
    assert robot.activate("no_such_node") is False
    with pytest.raises(KeyError, match="no parameter 'speed'"):
        robot.set_parameters("f_generate_search_path_node", {"speed": 1.0})
    with pytest.raises(TypeError, match="is a float, not 'high'"):
        robot.set_parameters("f_generate_search_path_node", {"spiral_altitude": "high"})


def test_guided_mode_needs_armed_thrusters_and_begins_the_mission_once() -> None:
    clock = SimulationClock()
    robot = SuaveRobot(clock, MissionConfig(), np.random.default_rng(0), with_battery=False)
    events: list[RobotEvent] = []
    robot.on_event.append(events.append)
    with pytest.raises(RuntimeError, match="arm the thrusters"):
        robot.set_guided()
    robot.arm()
    clock.advance_to(5.0)
    robot.set_guided()
    robot.set_guided()
    clock.advance_to(9.0)
    assert robot.mission_time() == 4.0
    assert [event.kind for event in events].count(SuaveEvent.GUIDED) == 1


def test_diagnostics_are_published_once_a_second_and_thrusters_when_they_fail() -> None:
    clock = SimulationClock()
    robot = SuaveRobot(clock, MissionConfig(), np.random.default_rng(0), with_battery=True)
    heard: list[tuple[float, str]] = []
    robot.on_diagnostics.append(
        lambda array: heard.append((array["header"]["stamp"], array["status"][0]["values"][0]["key"]))
    )
    robot.arm()
    robot.set_guided()
    clock.advance_to(40.5)
    keys = [key for _, key in heard]
    assert keys.count("water_visibility") == keys.count("battery_level") == 41
    assert [stamp for stamp, key in heard if key == "c_thruster_1"] == [35.0]
