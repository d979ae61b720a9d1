"""The simulated AGV: what moves it, what stops it, what it draws."""

from __future__ import annotations

import math

import numpy as np
import pytest

from agv_example.corridors import CorridorMap
from agv_example.drive_configurations import drive_options
from agv_example.planning.costs import StartUp
from agv_example.planning.route import Position
from agv_example.world import AgvRobot
from agv_example.world.motion import Collisions
from rosa_core.clock import SimulationClock
from rosa_simulation.robot_event import RobotEvent
from tests.agv_example.maps import agv_kb, paper_corridors


class Driven:
    """A robot at A, what it reported and what its monitors published."""

    def __init__(self, corridors: CorridorMap | None = None, *, battery: float = 1000.0) -> None:
        self.clock = SimulationClock()
        self.robot = AgvRobot(
            self.clock,
            corridors or paper_corridors(),
            "A",
            battery=battery,
            truth=drive_options(agv_kb(), (0.0, 0.2, 1.0)),
            start_up=StartUp(0.5, 0.5),
            rng=np.random.default_rng(0),
        )
        self.events: list[RobotEvent] = []
        self.published: list[tuple[str, str]] = []
        self.robot.on_event.append(self.events.append)
        self.robot.on_diagnostics.append(
            lambda array: self.published.extend((p["key"], p["value"]) for s in array["status"] for p in s["values"])
        )
        self.robot.depart(1000.0)

    def start(self, *components: str, speed: float = 0.5) -> None:
        for component in (*components, "move_base"):
            assert self.robot.activate(component)
        assert self.robot.set_parameters("move_base", {"move_speed": speed})

    def reported(self) -> list[tuple[str, str]]:
        return [(event.kind.value, event.subject) for event in self.events]


def test_it_drives_once_its_components_are_ready_and_arrives() -> None:
    one = Driven()
    one.start("lidar", "amcl", speed=0.68)
    one.robot.drive("C4", "C")
    one.clock.advance_to(1.5)
    assert one.robot.distance == pytest.approx(0.0)
    one.clock.advance_to(1.5 + 5.0 / 0.68)
    assert one.robot.coordinates == pytest.approx((0.0, 5.0), abs=0.1)
    one.clock.advance_to(1.7 + 10.0 / 0.68)
    assert one.robot.at == Position("C")
    assert ("arrived", "C") in one.reported()
    assert one.robot.energy == pytest.approx(3 * 0.5 + 3.75 * 10.0 / 0.68)


def test_it_turns_round_in_a_corridor() -> None:
    one = Driven()
    one.start("kinect", "amcl", speed=0.68)
    one.robot.drive("C1", "B")
    one.clock.advance_to(10.0)
    there = one.robot.at.travelled
    assert there == pytest.approx(8.5 * 0.68, abs=0.1)
    one.robot.drive("C1", "A")
    one.clock.advance_to(30.0)
    assert one.robot.at == Position("A")
    assert one.robot.distance == pytest.approx(2 * there)


@pytest.mark.parametrize(
    ("components", "moves"), [(("lidar",), False), (("camera", "amcl"), False), (("lidar", "mrpt"), True)]
)
def test_it_moves_only_if_it_knows_where_it_is(components: tuple[str, ...], moves: bool) -> None:
    one = Driven()
    one.start(*components, speed=0.24)
    one.robot.drive("C4", "C")
    one.clock.advance_to(10.0)
    assert (one.robot.distance > 0) == moves
    assert (("stranded", "C4") in one.reported()) != moves


def test_a_component_that_breaks_strands_it_and_its_return_sets_it_going() -> None:
    one = Driven()
    one.start("kinect", "mrpt", speed=0.35)
    one.robot.drive("C4", "C")
    one.clock.advance_to(5.0)
    one.robot.fail("kinect")
    at = one.robot.at.travelled
    one.clock.advance_to(15.0)
    assert one.robot.at.travelled == at
    assert not one.robot.activate("kinect")
    one.robot.recover("kinect")
    one.clock.advance_to(60.0)
    assert one.robot.at == Position("C")
    assert [pair for pair in one.published if pair[0] == "kinect"] == [("kinect", "FALSE"), ("kinect", "RECOVERED")]


def test_in_the_dark_the_camera_sees_with_the_lamp_only() -> None:
    one = Driven()
    one.start("camera", "aruco", speed=0.35)
    one.robot.dim("C4", 0.2)
    one.robot.drive("C4", "C")
    assert one.published[-1] == ("light", "0.2")
    one.clock.advance_to(10.0)
    assert one.robot.distance == 0.0
    one.robot.activate("lamp")
    one.clock.advance_to(50.0)
    assert one.robot.at == Position("C")


def test_a_corridor_that_closes_can_only_be_left_by_the_way_in() -> None:
    one = Driven()
    one.start("lidar", "amcl", speed=0.35)
    one.robot.drive("C4", "C")
    one.clock.advance_to(10.0)
    one.robot.close("C4")
    at = one.robot.at.travelled
    one.clock.advance_to(20.0)
    assert one.robot.at.travelled == at
    one.robot.drive("C4", "A")
    one.clock.advance_to(40.0)
    assert one.robot.at == Position("A")


def test_an_empty_battery_ends_every_drive() -> None:
    one = Driven(battery=20.0)
    one.start("lidar", "amcl", speed=0.68)
    one.robot.drive("C4", "C")
    one.clock.advance_to(100.0)
    assert one.robot.energy == pytest.approx(20.0)
    assert one.reported().count(("battery empty", "")) == 1
    assert one.robot.battery_level == 0.0
    assert ("battery_level", "0.0") in one.published
    assert one.robot.distance < 10.0


def test_who_is_not_accurate_enough_hits_every_obstacle() -> None:
    one = Driven(paper_corridors(obstacles=50))
    one.start("lidar", "mrpt", speed=0.68)
    one.robot.drive("C1", "B")
    one.clock.advance_to(60.0)
    assert one.robot.at == Position("B")
    assert one.robot.collisions.risk == pytest.approx(50.0)
    assert one.robot.collisions.number == pytest.approx(50, abs=4 * math.sqrt(50))
    assert one.reported().count(("collision", "C1")) == one.robot.collisions.number


def test_collisions_add_up_from_however_small_risks() -> None:
    fine, coarse = (Collisions(np.random.default_rng(3)) for _ in range(2))
    for _ in range(1000):
        fine.add(0.01)
    assert fine.number == coarse.add(10.0) > 3


@pytest.mark.parametrize(("corridor", "end"), [("C2", "B"), ("C1", "C"), ("C1", "Z")])
def test_it_cannot_drive_where_it_is_not(corridor: str, end: str) -> None:
    with pytest.raises(ValueError, match="cannot drive"):
        Driven().robot.drive(corridor, end)


def test_calls_that_make_no_sense_fail() -> None:
    robot = Driven().robot
    assert not robot.activate("sonar")
    assert not robot.deactivate("sonar")
    for speed in (0, -1.0, "fast", True, None):
        assert not robot.set_parameters("move_base", {} if speed is None else {"move_speed": speed})
