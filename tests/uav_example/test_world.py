"""The world: where the aircraft flies, what it uses up, what it finds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_core import SimulationClock
from uav_example import nodes
from uav_example.robot import UavRobot
from uav_example.world.aircraft import Aircraft, Battery
from uav_example.world.area import Analysis, scatter_samples, search_path
from uav_example.world.parameters import WorldParameters
from uav_example.world.world import World

COORDINATE = st.floats(-500.0, 500.0)


def robot(**parameters: object) -> UavRobot:
    world = WorldParameters(**parameters)  # type: ignore[arg-type]
    return UavRobot(World(SimulationClock(), world, np.random.default_rng(0)))


def run(robot: UavRobot, *names: str, seconds: float) -> None:
    """Have only these nodes active for so long."""
    for name, node in robot.nodes.items():
        if name in names:
            robot.activate(name)
        elif node.active:
            robot.deactivate(name)
    robot.clock.advance_to(robot.clock.now() + seconds)


@given(start=st.tuples(COORDINATE, COORDINATE, COORDINATE), end=st.tuples(COORDINATE, COORDINATE, COORDINATE))
def test_the_aircraft_gets_where_it_is_sent_in_the_time_that_its_speeds_take(start, end) -> None:
    aircraft = Aircraft(start, speed=8.0, climb_speed=3.0)
    aircraft.target = end
    level, climb = math.dist(start[:2], end[:2]), abs(start[2] - end[2])
    steps = math.ceil(max(level / 0.8, climb / 0.3))
    for _ in range(steps + 1):
        before = aircraft.position
        aircraft.step(0.1)
        assert math.dist(before[:2], aircraft.position[:2]) <= 0.8 + 1e-9
        assert abs(before[2] - aircraft.position[2]) <= 0.3 + 1e-9
    assert aircraft.position == end
    assert aircraft.at_target


def test_without_a_target_it_hovers() -> None:
    aircraft = Aircraft((1.0, 2.0, 3.0), 8.0, 3.0)
    aircraft.step(10.0)
    assert aircraft.position == (1.0, 2.0, 3.0)
    assert not aircraft.at_target


@given(st.lists(st.floats(0.0, 0.5), max_size=20))
def test_a_battery_gives_no_more_than_it_has(drains: list[float]) -> None:
    battery = Battery(1.0)
    for drain in drains:
        battery.drain(drain)
        assert 0.0 <= battery.level <= 1.0
    assert battery.level + battery.used == pytest.approx(1.0)
    battery.charge(2.0)
    assert battery.full


@given(
    width=st.floats(5.0, 400.0),
    depth=st.floats(5.0, 400.0),
    spacing=st.floats(5.0, 24.0),
    place=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)),
)
def test_whatever_lies_in_the_area_is_near_the_search_path(width, depth, spacing, place) -> None:
    """No place is further from the path than half a lane and half the distance of its points."""
    path = search_path(WorldParameters(width=width, depth=depth, lane_spacing=spacing))
    where = (place[0] * width, place[1] * depth)
    assert min(math.dist(where, point) for point in path) <= math.hypot(spacing / 1.3, 7.6)


def test_samples_lie_in_the_area_and_follow_the_seed() -> None:
    parameters = WorldParameters(samples=50)
    samples = scatter_samples(parameters, np.random.default_rng(3))
    assert [sample.number for sample in samples] == list(range(1, 51))
    assert all(0 <= s.x <= parameters.width and 0 <= s.y <= parameters.depth for s in samples)
    assert samples == scatter_samples(parameters, np.random.default_rng(3))
    assert samples != scatter_samples(parameters, np.random.default_rng(4))


def test_a_search_goes_on_where_it_was_interrupted() -> None:
    uav = robot(samples=0)
    run(uav, nodes.SEARCH_PATH, nodes.CONTROL_MOTION, seconds=40.0)
    share, x = uav.search.share, uav.world.aircraft.position[0]
    run(uav, nodes.HOME_PATH, nodes.CONTROL_MOTION, seconds=60.0)
    assert uav.world.aircraft.position == (0.0, 0.0, 2.0)
    assert uav.search.share == share
    run(uav, nodes.SEARCH_PATH, nodes.CONTROL_MOTION, seconds=30.0)
    assert uav.search.share > share
    assert x != 0.0


def test_nothing_moves_without_the_motion_node() -> None:
    uav = robot()
    run(uav, nodes.SEARCH_PATH, seconds=20.0)
    assert uav.world.aircraft.position == (0.0, 0.0, 2.0)


def test_the_camera_sees_nothing_past_an_unfolded_gripper() -> None:
    uav = robot()
    uav.world.waiting = uav.world.samples[0]
    uav.world.gripper.folded = False
    run(uav, nodes.ANALYZE_PATH, nodes.CONTROL_MOTION, seconds=120.0)
    assert uav.world.analyses == {}
    uav.world.gripper.folded = True
    uav.clock.advance_to(uav.clock.now() + 12.5)
    assert list(uav.world.analyses.values()) == [Analysis.IN_SITU]


def test_a_gripper_that_has_failed_folds_only_by_its_spring() -> None:
    uav = robot(gripper_fails_after=0.5)
    uav.world.waiting = uav.world.samples[0]
    run(uav, nodes.PICK_PATH, nodes.CONTROL_MOTION, seconds=60.0)
    assert not uav.world.gripper.works
    assert not uav.world.gripper.folded
    run(uav, nodes.LAND_PATH, nodes.FOLD_GRIPPER, nodes.CONTROL_MOTION, seconds=30.0)
    assert uav.world.aircraft.landed
    assert not uav.world.gripper.folded
    run(uav, nodes.LAND_PATH, nodes.RELEASE_SPRING, nodes.CONTROL_MOTION, seconds=9.0)
    assert uav.world.gripper.folded


def test_the_gripper_is_folded_only_on_the_ground() -> None:
    uav = robot()
    uav.world.gripper.folded = False
    run(uav, nodes.FOLD_GRIPPER, seconds=30.0)
    assert not uav.world.gripper.folded


def test_each_action_drains_the_battery_at_its_own_rate() -> None:
    p = WorldParameters()
    for node, rate in (
        (nodes.SEARCH_PATH, p.drain_search),
        (nodes.PICK_PATH, p.drain_analyze),
        (nodes.ANALYZE_PATH, p.drain_analyze_in_situ),
        (nodes.LAND_PATH, p.drain_land_fold),
    ):
        uav = robot()
        run(uav, node, seconds=1.0)
        before = uav.world.battery.level
        uav.clock.advance_to(uav.clock.now() + 10.0)
        assert before - uav.world.battery.level == pytest.approx(10.0 * rate)


def test_an_aircraft_on_the_ground_uses_nothing() -> None:
    uav = robot()
    uav.world.aircraft.position = (5.0, 5.0, 0.0)
    uav.clock.advance_to(50.0)
    assert uav.world.battery.level == 1.0


def test_a_node_that_is_not_there_cannot_be_called() -> None:
    uav = robot(spring=False)
    assert uav.activate(nodes.RELEASE_SPRING) is False
    assert uav.set_parameters("gripper", {}) is False


def test_the_nearest_of_several_samples_is_found_first_and_one_at_a_time() -> None:
    world = World(SimulationClock(), WorldParameters(samples=30, sight=500.0), np.random.default_rng(1))
    world.look_for_samples()
    world.look_for_samples()
    assert world.found == [min(world.samples, key=lambda s: math.hypot(s.x, s.y))]
