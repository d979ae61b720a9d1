"""The example of the ROSA paper's section 7.4.1, and what else may happen on the way."""

from __future__ import annotations

from pathlib import Path

import pytest

from agv_example.scenario import AGV
from rosa_simulation.run_record import RunRecord
from rosa_simulation.scenario import RunRequest, SilentObserver
from tests.agv_example.drives import drive, driven, events_with, routes, way

ROUND = ["C4", "C3", "C2"]


@pytest.fixture(scope="module", params=["bt", "pddl"])
def task_layer(request: pytest.FixtureRequest) -> str:
    """The mission is carried out as a behaviour tree and as a plan."""
    return str(request.param)


@pytest.fixture(scope="module")
def default_run(task_layer: str) -> RunRecord:
    """The mission as ``rosa run agv`` carries it out."""
    return AGV.run(RunRequest(task_layer=task_layer), SilentObserver())


# the example


def test_when_all_works_it_goes_directly_with_kinect_and_amcl(tmp_path: Path, task_layer: str) -> None:
    record = drive(tmp_path, task_layer=task_layer)
    assert [way(route) for route in routes(record)] == [[("C1", "kinect + amcl")]]
    assert record.ended_by == "all goals reached"
    assert record.metrics["distance_m"] == pytest.approx(20.0)
    assert not any(record.reactions.values())


def test_when_the_kinect_has_failed_it_goes_round_with_the_lidar(tmp_path: Path, task_layer: str) -> None:
    record = drive(tmp_path, task_layer=task_layer, events=[{"at": 0, "fails": "kinect"}])
    assert driven(record) == ROUND
    assert [way(route) for route in routes(record)] == [[(corridor, "lidar + amcl") for corridor in ROUND]]
    assert record.metrics["goals_reached"] == 1
    assert record.metrics["risk"] == 0.0


def test_when_the_kinect_fails_on_the_way_task_and_architecture_change_together(default_run: RunRecord) -> None:
    (failed,) = events_with(default_run, "kinect failed")
    for words in ("kinect + amcl unfeasible", "lidar + amcl selected", "route to B: back out of C1 (lidar + amcl"):
        assert words in failed.text
    first, second = routes(default_run)
    assert way(first) == [("C1", "kinect + amcl")]
    assert way(second) == [("C1", "lidar + amcl"), *((corridor, "lidar + amcl") for corridor in ROUND)]
    assert second["legs"][0]["back"]
    assert [leg["corridor"] for leg in second["before"]] == ["C1"], "what it would have been"
    assert driven(default_run) == ["C1", *ROUND]
    assert default_run.ended_by == "all goals reached"
    (reaction,) = default_run.reactions["component"]
    assert reaction.cause_s == failed.time_s
    assert reaction.delay_s == pytest.approx(0.5), "the lidar is started"
    assert reaction.compute_s > 0


def test_the_configuration_changes_from_corridor_to_corridor(default_run: RunRecord) -> None:
    """In C4 people walk: the speed there is at most 0.35 m/s, elsewhere it is the highest."""
    speeds = {leg["corridor"]: leg["configuration"].split(", ")[1] for leg in routes(default_run)[1]["legs"]}
    assert speeds["C4"] in ("safe speed", "normal speed")
    assert speeds["C3"] == speeds["C2"] == "high speed"
    plans = [f for e in default_run.events for f in e.facts if f["fact"] == "reconfiguration plan"]
    adapted = [plan["parameter_adaptations"] for plan in plans if plan["result"] == "completed"]
    assert [speeds["C4"]] in adapted
    assert ["high speed"] in adapted


def test_without_a_manager_the_robot_stands_where_the_kinect_failed(tmp_path: Path) -> None:
    record = drive(tmp_path, manager="none", events=[{"at": 10, "fails": "kinect"}], time_limit=100)
    assert events_with(record, "stands in C1 and cannot go on")
    assert record.metrics["goals_reached"] == 0
    assert record.ended_by == "time limit"
    assert record.completed
    assert not any(record.reactions.values())


def test_without_a_manager_and_without_trouble_it_arrives(tmp_path: Path) -> None:
    record = drive(tmp_path, manager="none")
    assert record.ended_by == "all goals reached"
    assert driven(record) == ["C1"]


# other trouble


def test_a_corridor_that_closes_ahead_is_gone_round(tmp_path: Path, task_layer: str) -> None:
    record = drive(tmp_path, task_layer=task_layer, events=[{"at": 10, "closes": "C1"}])
    assert driven(record) == ["C1", *ROUND]
    assert len(record.reactions["corridor"]) == 1
    assert record.ended_by == "all goals reached"


def test_a_corridor_that_closes_elsewhere_changes_nothing(tmp_path: Path, task_layer: str) -> None:
    record = drive(tmp_path, task_layer=task_layer, events=[{"at": 10, "closes": "C3"}])
    assert driven(record) == ["C1"]
    assert not any(record.reactions.values())
    assert len(routes(record)) == 1


def test_in_the_dark_the_camera_gets_the_lamp_and_only_there(tmp_path: Path, task_layer: str) -> None:
    broken = [{"at": 0, "fails": "kinect"}, {"at": 0, "fails": "lidar"}]
    record = drive(tmp_path, task_layer=task_layer, events=broken)
    assert way(routes(record)[-1]) == [
        ("C4", "camera + aruco"),
        ("C3", "camera + aruco + lamp"),
        ("C2", "camera + aruco"),
    ]
    assert record.ended_by == "all goals reached"
    activities = [(f["fact"], f.get("subject")) for e in record.events for f in e.facts]
    assert activities.count(("activated", "lamp")) == 1
    assert activities.index(("activated", "lamp")) < activities.index(("deactivated", "lamp"))
    assert activities.index(("arrived", "D")) < activities.index(("deactivated", "lamp"))


def test_when_the_light_goes_out_around_the_robot_it_takes_the_lamp(tmp_path: Path, task_layer: str) -> None:
    events = [{"at": 0, "fails": "kinect"}, {"at": 0, "fails": "lidar"}, {"at": 20, "dims": "C4", "light": 0.1}]
    record = drive(tmp_path, task_layer=task_layer, events=events)
    (dimmed,) = events_with(record, "the light in C4 changes")
    assert "C4 (camera + aruco + lamp" in dimmed.text
    assert record.ended_by == "all goals reached"
    assert [reaction.cause_s for reaction in record.reactions["corridor"]] == [20.0]


def test_with_no_sensor_left_it_waits_until_one_works_again(tmp_path: Path, task_layer: str) -> None:
    events = [{"at": 5, "fails": name} for name in ("kinect", "lidar", "camera")]
    record = drive(tmp_path, task_layer=task_layer, events=[*events, {"at": 50, "works": "kinect"}])
    assert events_with(record, "navigate unfeasible", "navigate abandoned")
    (again,) = events_with(record, "kinect works again")
    assert "navigate feasible" in again.text
    assert "navigate requested" in again.text
    assert record.ended_by == "all goals reached"
    assert driven(record) == ["C1"]
    assert record.duration_s > 50


def test_with_no_way_left_it_waits_until_one_opens(tmp_path: Path, task_layer: str) -> None:
    events = [{"at": 0, "closes": "C1"}, {"at": 0, "closes": "C2"}, {"at": 30, "opens": "C2"}]
    record = drive(tmp_path, task_layer=task_layer, events=events)
    assert events_with(record, "no way to B")
    assert driven(record) == ROUND
    assert record.ended_by == "all goals reached"
    stuck = drive(tmp_path, task_layer=task_layer, events=events[:2], time_limit=60)
    assert stuck.ended_by == "time limit"
    assert len(events_with(stuck, "no way to B")) == 1, "waiting is not reported"


def test_several_goals_are_driven_to_in_turn(tmp_path: Path, task_layer: str) -> None:
    record = drive(tmp_path, task_layer=task_layer, goals=["B", "C", "A"])
    assert record.metrics["goals_reached"] == record.metrics["goals"] == 3
    reached = [f["subject"] for e in record.events for f in e.facts if f["fact"] == "goal reached"]
    assert reached == ["B", "C", "A"]
    assert [route["goal"] for route in routes(record)] == ["B", "C", "A"]


def test_what_the_route_is_to_be_best_in_decides_on_it(tmp_path: Path, task_layer: str) -> None:
    assert driven(drive(tmp_path, task_layer=task_layer, minimise="risk")) == ROUND
    assert driven(drive(tmp_path, task_layer=task_layer, minimise=["risk", "time"])) == ROUND
    assert driven(drive(tmp_path, task_layer=task_layer, minimise={"energy": 1.0, "risk": 0.001})) == ["C1"]
    assert driven(drive(tmp_path, task_layer=task_layer, minimise={"energy": 0.001, "risk": 1000.0})) == ROUND


def test_a_battery_that_does_not_last_for_the_best_route_makes_it_choose_a_frugal_one(
    tmp_path: Path, task_layer: str
) -> None:
    assert driven(drive(tmp_path, task_layer=task_layer, minimise="risk", battery=150)) == ["C1"]
    stays = drive(tmp_path, task_layer=task_layer, battery=50, time_limit=30)
    assert events_with(stays, "no way to B")
    assert stays.metrics["distance_m"] == 0.0


def test_what_is_planned_is_what_happens(tmp_path: Path, task_layer: str) -> None:
    """Time, energy and risk of the route are those that are met with, to a step of the simulation a corridor."""
    record = drive(tmp_path, task_layer=task_layer, minimise="risk", goals=["B"])
    (route,) = routes(record)
    metrics = record.metrics
    assert metrics["energy"] == pytest.approx(sum(leg["energy"] for leg in route["legs"]), rel=0.02)
    assert metrics["time_s"] == pytest.approx(sum(leg["time_s"] for leg in route["legs"]), abs=0.4)
    directly = drive(tmp_path, task_layer=task_layer)
    assert directly.metrics["risk"] == pytest.approx(routes(directly)[0]["legs"][0]["risk"], abs=1e-6)


def test_collisions_come_as_often_as_the_risk_says(tmp_path: Path) -> None:
    """A corridor of 200 obstacles, driven with a safety of 2.75: 200 / 4**2.75 = 4.4 collisions are expected."""
    inline = {"places": {"A": [0, 0], "B": [9, 0]}, "corridors": {"C1": {"between": ["A", "B"], "obstacles": 200}}}
    several = [drive(tmp_path, map=inline, seed=seed, minimise="time").metrics for seed in range(60)]
    mean = sum(metrics["collisions"] for metrics in several) / len(several)
    assert several[0]["risk"] == pytest.approx(200 * 0.25**2.75, abs=1e-6)
    assert mean == pytest.approx(several[0]["risk"], abs=4 * (several[0]["risk"] / 60) ** 0.5)
    assert len({metrics["collisions"] for metrics in several}) > 3


def test_the_seed_draws_when_and_what_fails(tmp_path: Path) -> None:
    event = {"at": [1, 25], "fails": ["kinect", "amcl"]}
    drawn = {
        (disturbance["time"], disturbance["subject"])
        for seed in range(8)
        for disturbance in drive(tmp_path, events=[event], seed=seed).inputs["happenings"]
    }
    assert len(drawn) == 8
    assert {subject for _, subject in drawn} == {"kinect", "amcl"}
    assert all(1 <= time <= 25 for time, _ in drawn)
