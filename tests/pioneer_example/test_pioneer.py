"""The Pioneer: its worlds, its program in blocks, its reflexes, and missions under every manager."""

from __future__ import annotations

import dataclasses
import math
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pioneer_example.blocks import (
    AvoidCollision,
    AvoidObstacleModel,
    GoToOrigin,
    GoToOriginPlanner,
    PassOrientation,
    PassPosition,
    PassRange,
    PioneerP3DXModel,
    TurnToOrigin,
    pioneer_blocks,
)
from pioneer_example.drawing import draw_run
from pioneer_example.parameters import PARAMETERS
from pioneer_example.ranging import stopping_distance
from pioneer_example.reflexes import pioneer_reflexes
from pioneer_example.robot import PioneerRobot
from pioneer_example.scenario import PIONEER
from pioneer_example.world.arena import EXPLORER, RADIUS, draw_arena
from pioneer_example.world.arena import PIONEER as ROBOT
from pioneer_example.world.backend import Backend
from pioneer_example.world.geometry import Circle, Rectangle
from pioneer_example.world.kinematic_backend import KinematicBackend
from pioneer_example.world.mujoco_backend import MujocoBackend
from pioneer_example.world.sonar_ring import SONARS, free_ahead
from rosa_core import SimulationClock
from rosa_reflexes.rocs import EventRunner, PublishedLoop, decomposition
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver

DEFAULTS = {name: parameter.default for name, parameter in PARAMETERS.items()}
BACKENDS = (MujocoBackend, KinematicBackend)


def run(manager: str, seed: int = 1, task_layer: str = "bt", **parameters: Any) -> RunRecord:
    request = RunRequest(manager=manager, seed=seed, task_layer=task_layer, parameters=parameters)
    return PIONEER.run(request, SilentObserver())


def robot_on(backend: type[MujocoBackend | KinematicBackend], seed: int = 0) -> PioneerRobot:
    arena = draw_arena(np.random.default_rng(seed))
    return PioneerRobot(SimulationClock(), arena, backend(arena), DEFAULTS, np.random.default_rng(seed))


# -- worlds --


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(-math.pi, math.pi))
def test_a_ray_ends_at_the_edge(x: float, y: float, angle: float) -> None:
    cos, sin = math.cos(angle), math.sin(angle)
    for shape in (Rectangle(0.5, -0.2, 0.4, 0.3), Circle(0.5, -0.2, 0.4)):
        along = shape.ray(x, y, cos, sin)
        if shape.distance(x, y) > 1e-6 and math.isfinite(along):
            assert shape.distance(x + along * cos, y + along * sin) < 1e-6
            assert along >= shape.distance(x, y) - 1e-9


@pytest.mark.parametrize("seed", range(5))
def test_both_worlds_hear_the_same(seed: int) -> None:
    arena = draw_arena(np.random.default_rng(seed))
    heard = [backend(arena).ranges(name) for backend in BACKENDS for name in (ROBOT, EXPLORER)]
    assert heard[0] == pytest.approx(heard[2], abs=1e-6)
    assert heard[1] == pytest.approx(heard[3], abs=1e-6)


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_robot_turns_on_the_spot_drives_straight_and_is_stopped_by_a_wall(backend: type[Any]) -> None:
    arena = draw_arena(np.random.default_rng(0))
    world: Backend = backend(dataclasses.replace(arena, starts={**arena.starts, ROBOT: (1.0, 2.4, 0.0)}))
    for _ in range(100):
        world.step(0.02, {ROBOT: (-0.1, 0.1)})
    x, y, heading = world.pose(ROBOT)
    assert (x, y) == pytest.approx((1.0, 2.4), abs=0.01)
    assert heading == pytest.approx(2.0 * 0.2 / 0.33, rel=0.15)
    assert not world.touches(ROBOT)
    touched = False
    for _ in range(400):
        world.step(0.02, {ROBOT: (0.3, 0.3)})
        touched = touched or world.touches(ROBOT)
    assert touched
    assert world.pose(ROBOT)[1] < 3.2 - 0.05 - RADIUS + 0.02


def test_what_is_beside_the_robot_is_not_in_its_way() -> None:
    ahead = [0.5 if abs(angle) < 0.2 else 5.0 for angle in SONARS]
    beside = [0.2 if abs(abs(angle) - math.pi / 2) < 0.1 else 5.0 for angle in SONARS]
    free = free_ahead(ahead)
    assert free is not None
    assert 0.4 < free < 0.5
    free = free_ahead(beside)
    assert free is not None
    assert free > 4.0
    assert free_ahead([None] * 16) is None


# -- the paper's program --


def test_actions_decompose_as_in_table_1() -> None:
    model = PioneerP3DXModel(robot_on(KinematicBackend))
    assert {type(action).__name__: decomposition(action) for action in _macros(model)} == {
        "AvoidCollision": "TurnAngle; SetWheelSpeed",
        "GoToOrigin": "TurnToOrigin; SetWheelSpeed",
        "TurnToOrigin": "TurnAngle",
    }


def _macros(model: PioneerP3DXModel) -> list[AvoidCollision | GoToOrigin | TurnToOrigin]:
    return [AvoidCollision(model), GoToOrigin(model), TurnToOrigin(model)]


def test_the_blocks_are_those_of_figure_5() -> None:
    program = pioneer_blocks(robot_on(KinematicBackend))
    assert {type(one).__name__ for one in program.monitors} == {"RangeMonitor", "PositionMonitor", "OrientationMonitor"}
    assert {type(one) for one in program.analyzes} == {PassRange, PassPosition, PassOrientation}
    assert isinstance(program.plan, GoToOriginPlanner)
    assert isinstance(program.knowledge.robot, PioneerP3DXModel)
    assert [type(one) for one in program.knowledge.reactive] == [AvoidObstacleModel]
    assert len(program.knowledge.robot.sensors) == 18


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("runner", [EventRunner, PublishedLoop])
def test_the_same_program_runs_in_both_worlds_and_takes_both_routes(
    backend: type[Any], runner: type[EventRunner | PublishedLoop]
) -> None:
    robot = robot_on(backend, seed=3)
    robot.bypass_gate()
    robot.set_up()
    routes: set[bool] = set()
    robot.on_event.append(lambda _: routes.add(robot.is_reactive))
    robot.begin(60.0, "none", 0.0)
    before = robot.distance_to_origin
    runner(pioneer_blocks(robot), robot.clock).start()
    robot.clock.advance_to(25.0)
    assert routes == {True, False}
    assert robot.distance_to_origin < before


# -- reflexes --


def test_the_reflexes_hold_together_and_their_limits_follow_the_design() -> None:
    config = pioneer_reflexes()
    assert [reflex.name for reflex in config.reflexes] == [
        "ring faulty",
        "back off",
        "keep clear",
        "pass on the left",
        "pass on the right",
    ]
    robot = robot_on(KinematicBackend)
    robot.set_up()
    robot.clock.advance_to(0.1)
    assert robot.gate.readings["stop_distance"] == stopping_distance(0.4, 0.05)
    robot.deactivate("sonar_ring")
    robot.activate("lidar")
    robot.set_parameters("drive", {"speed": 0.2})
    robot.clock.advance_to(0.2)
    assert robot.gate.readings["stop_distance"] == stopping_distance(0.2, 0.2)


@settings(max_examples=25, deadline=None)
@given(
    st.integers(0, 10_000), st.lists(st.tuples(st.floats(-0.5, 0.7), st.floats(-0.5, 0.7)), min_size=10, max_size=10)
)
def test_whatever_deliberation_commands_forwards_the_robot_touches_nothing_that_stands_still(
    seed: int, commands: list[tuple[float, float]]
) -> None:
    """Held to the speed that the limits are made for; backwards nothing guards it."""
    arena = draw_arena(np.random.default_rng(seed))
    settings_ = {**DEFAULTS, "explorer_speed": 0.0}
    robot = PioneerRobot(SimulationClock(), arena, KinematicBackend(arena), settings_, np.random.default_rng(seed))
    robot.set_up()
    robot.begin(100.0, "none", 0.0)
    for left, right in commands:
        ahead, turn = min(abs(left + right) / 2.0, 0.4), (right - left) / 2.0
        for _ in range(10):
            robot.submit(ahead - turn, ahead + turn, robot.gate.epoch)
            robot.clock.advance_to(robot.clock.now() + 0.1)
    assert robot.collisions == 0
    assert robot.least_clearance > 0.02


# -- missions --


@pytest.mark.parametrize("manager", ["gate", "rosa"])
@pytest.mark.parametrize("seed", [1, 3, 7])
def test_with_the_gate_the_origin_is_reached_and_nothing_is_touched(manager: str, seed: int) -> None:
    metrics = run(manager, seed).metrics
    assert metrics["reached_goal"]
    assert metrics["collisions"] == 0
    assert metrics["least_clearance_m"] > 0.1


def test_the_published_design_is_slower_and_hits_things() -> None:
    rocs, gate = run("rocs", 3).metrics, run("gate", 3).metrics
    assert rocs["collisions"] > 0
    assert rocs["time_s"] > gate["time_s"]


def test_without_reflexes_it_runs_into_the_box_and_without_a_plan_it_gets_nowhere() -> None:
    assert run("deliberative", 3).metrics["collisions"] > 0
    assert not run("reactive", 3, time_limit=40.0).metrics["reached_goal"]


@pytest.mark.parametrize("fault", ["silent", "stuck", "nan"])
def test_a_faulty_sonar_ring_stops_the_robot_and_says_why(fault: str) -> None:
    record = run("gate", sonar_fault=fault, sonar_fault_at=3.0, time_limit=10.0)
    said = [event.text for event in record.events if "'ring faulty' takes the command" in event.text]
    assert said
    assert {"silent": "is silent", "stuck": "is stuck", "nan": "is not a number"}[fault] in said[0]
    assert "'ring faulty' commands left 0, right 0 since" in record.events[-1].text
    assert [row[1:3] for row in record.trajectory[-10:]] == [pytest.approx(record.trajectory[-1][1:3], abs=1e-3)] * 10
    assert record.metrics["collisions"] == 0


@pytest.mark.parametrize("fault", ["silent", "stuck", "nan"])
@pytest.mark.parametrize("task_layer", ["bt", "pddl"])
def test_rosa_goes_on_with_the_lidar_and_more_slowly(fault: str, task_layer: str) -> None:
    record = run("rosa", task_layer=task_layer, sonar_fault=fault, sonar_fault_at=3.0)
    assert record.metrics["reached_goal"]
    assert record.metrics["collisions"] == 0
    selected = [fact for event in record.events for fact in event.facts if fact["fact"] == "selected"]
    assert "lidar design" in {name for fact in selected for name in fact["function_designs"]}
    assert "slow" in {name for fact in selected for name in fact["component_configurations"]}
    (reaction,) = record.reactions["sonar"]
    assert reaction.delay_s < 1.5


def test_the_skill_pauses_and_stale_commands_are_refused() -> None:
    record = run("gate")
    assert record.metrics["refused_commands"] > 0
    assert record.metrics["refused_commands"] <= 3 * record.metrics["preemptions"]


def test_a_run_is_the_same_when_it_is_run_again() -> None:
    for manager in PIONEER.managers:
        one, other = (run(manager, 5, time_limit=15.0) for _ in range(2))
        assert (one.events, one.trajectory, one.inputs) == (other.events, other.trajectory, other.inputs)


def test_figure_4_has_both_routes_dots_and_squares() -> None:
    record = run("gate", 3)
    root = ET.fromstring(draw_run(record))
    tags = [element.tag.rpartition("}")[2] for element in root.iter()]
    strokes = {e.get("stroke") for e in root.iter() if e.tag.endswith("polyline")}
    assert strokes == {"#1f6fb4", "#d9541e"}
    assert tags.count("title") == record.metrics["route_switches"]
    assert tags.count("circle") > 20
