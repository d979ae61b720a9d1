"""How path and configuration meet the knowledge base."""

from __future__ import annotations

import pytest

from agv_example.drive_configurations import DriveOptions, answers, drive_options
from agv_example.missions.mission_config import default_mission, load_mission
from agv_example.models import model_files
from agv_example.planning import CoAdaptivePlanner, Objective
from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock, Status
from rosa_core.kb import Event
from rosa_core.model.effort import count_effort
from tests.agv_example.maps import AGV, AGV_MOVE, agv_kb


def names(options: DriveOptions, light: float) -> set[str]:
    return {options.configurations[number].designs[0] for number in options.in_light(light)}


def test_the_counted_model_has_18_entities_and_36_relations() -> None:
    effort = count_effort(KnowledgeModel.load(AGV))
    assert (effort.entities, effort.relations, effort.total) == (18, 36, 54)


def test_what_is_feasible_in_which_light_is_what_the_knowledge_base_says() -> None:
    options = drive_options(agv_kb(), (0.2, 1.0))
    assert len(options.configurations) == 18
    assert names(options, 1.0) - names(options, 0.2) == {"camera + aruco"}
    assert names(options, 0.89) == names(options, 0.0)
    assert names(options, 0.9) == names(options, 1.0)
    assert names(drive_options(agv_kb(["kinect", "amcl"]), (1.0,)), 1.0) == {
        "lidar + mrpt",
        "camera + aruco",
        "camera + aruco + lamp",
    }


def test_estimates_and_speed_come_from_the_knowledge_base() -> None:
    options = drive_options(agv_kb(), (1.0,))
    best = next(one for one in options.configurations if one.name == "kinect + amcl, safe speed")
    assert (best.energy, best.accuracy, best.safety, best.speed) == (1.5, 1.75, 3.75, 0.24)
    assert best.components == {"kinect", "amcl", "move_base"}
    assert best.settings == ("safe speed",)


def test_asking_what_would_be_in_another_light_changes_nothing_and_is_heard_of_by_nobody() -> None:
    kb = agv_kb()
    kb.add_measurement("light", 1.0)
    heard: list[Event] = []
    kb.subscribe(heard.append)
    revision = kb.revision
    drive_options(kb, (0.0, 0.5, 1.0))
    assert heard == []
    assert kb.revision == revision
    assert kb.measurement("light").value == 1.0  # type: ignore[union-attr]
    assert kb.status("function_design", "camera + aruco") is Status.FEASIBLE


def test_with_nothing_feasible_there_is_nothing_to_drive_with() -> None:
    options = drive_options(agv_kb(["move_base"]), (1.0,))
    assert options.configurations == ()
    assert answers(options.limits, 0.95) == (True,)


def test_published_draws_take_the_place_of_the_sums() -> None:
    config = load_mission(default_mission())
    draws = AGV.parent / "agv_published_draws.yaml"
    kb = KnowledgeBase(KnowledgeModel.load(AGV, AGV_MOVE, draws), SimulationClock())
    options = drive_options(kb, config.lights)
    energies = {one.designs[0]: (one.energy, one.accuracy) for one in options.configurations}
    assert energies == {
        "kinect + amcl": (17790, 1.0),
        "lidar + amcl": (19790, 0.7),
        "kinect + mrpt": (18942, 0.9),
        "lidar + mrpt": (20942, 0.6),
        "camera + aruco": (16963, 0.8),
        "camera + aruco + lamp": (26963, 0.8),
    }


def test_the_robot_is_ready_for_what_the_paper_says_before_any_route_is_planned() -> None:
    model = KnowledgeModel.load(*model_files())
    kb = KnowledgeBase(model, SimulationClock())
    best = next(iter(kb.configurations("navigate")))
    assert best.function_designs["localization"] == "kinect + amcl"
    kb.add_measurement("battery_level", 0.0)
    assert not kb.is_action_feasible("navigate")


@pytest.mark.parametrize("objective", ["energy", "time", "risk"])
def test_a_planner_without_configurations_finds_no_route(objective: str) -> None:
    corridors = load_mission(default_mission()).corridors
    options = drive_options(agv_kb(["amcl", "mrpt", "aruco"]), {c.light for c in corridors.corridors})
    planner = CoAdaptivePlanner(corridors, options)
    assert planner.route("A", "B", Objective.first(objective)) is None
    assert planner.pareto("A", "B") == []
