"""What the planner chooses when a required action has a preference or a utility: the AGV of the ROSA paper."""

from __future__ import annotations

import logging
from importlib.resources import files
from pathlib import Path

import pytest

from rosa_core import InvalidValueError, KnowledgeBase, KnowledgeModel, SimulationClock, UnknownElementError
from rosa_core.mape import ConfigurationPlanner
from rosa_core.model.effort import count_effort
from rosa_core.model.utility import Limit, Utility
from tests.rosa_core.sample_models import knowledge_model

MODELS = Path(str(files("agv_example.models")))
AGV = MODELS / "agv.yaml"
AGV_MOVE = MODELS / "agv_move.yaml"


def planned(kb: KnowledgeBase) -> KnowledgeBase:
    """With a planner that is woken by the events that concern it."""
    kb.subscribe(ConfigurationPlanner(kb).on_event, ConfigurationPlanner.EVENTS)
    return kb


@pytest.fixture
def agv() -> KnowledgeBase:
    return planned(KnowledgeBase(KnowledgeModel.load(AGV, AGV_MOVE), SimulationClock()))


def settle(kb: KnowledgeBase) -> None:
    """The pending plan is carried out."""
    plan = kb.pending_reconfiguration_plan()
    if plan is not None:
        with kb.transaction():
            for component in plan.deactivate:
                kb.set_component_active(component, False)
            for component in plan.activate:
                kb.set_component_active(component, True)
            kb.set_reconfiguration_result(plan, "completed")


def chosen(kb: KnowledgeBase) -> tuple[str | None, str | None]:
    return kb.selected_function_design("localization"), kb.selected_component_configuration("move_base")


def test_the_agv_counts_as_in_the_papers_table_7() -> None:
    effort = count_effort(KnowledgeModel.load(AGV))
    assert (effort.entities, effort.relations, effort.total) == (18, 36, 54)


@pytest.mark.parametrize(
    ("utility", "best"),
    [
        (Utility({"safety": 1}), ("kinect + amcl", "safe speed")),
        (Utility({"accuracy": 1}), ("kinect + amcl", "safe speed")),
        (Utility({"energy": 1}), ("camera + aruco + lamp", "high speed")),
        (Utility({"energy": -1}), ("kinect + amcl", "safe speed")),
        (Utility({"safety": 1}, (("energy", ">=", 2.75),)), ("camera + aruco + lamp", "safe speed")),
        (Utility({"safety": -1}), ("lidar + mrpt", "high speed")),
    ],
    ids=str,
)
def test_the_estimations_decide_on_designs_and_configurations_together(
    agv: KnowledgeBase, utility: Utility, best: tuple[str, str]
) -> None:
    agv.request_action("navigate", utility=utility)
    assert chosen(agv) == best


def test_a_preference_is_the_utility_with_weight_1(agv: KnowledgeBase) -> None:
    required = agv.request_action("navigate", preference="safety")
    assert required.decided_by == Utility.preferring("safety") == Utility({"safety": 1.0})
    assert chosen(agv) == ("kinect + amcl", "safe speed")


def test_without_either_priorities_decide(agv: KnowledgeBase) -> None:
    assert agv.request_action("navigate").decided_by is None
    assert chosen(agv) == ("lidar + amcl", "safe speed")


def test_a_preference_and_a_utility_exclude_each_other(agv: KnowledgeBase) -> None:
    with pytest.raises(InvalidValueError, match="preference or a utility"):
        agv.request_action("navigate", preference="safety", utility=Utility({"energy": -1}))
    assert agv.required_actions() == []


@pytest.mark.parametrize("utility", [Utility({"safty": 1}), Utility({}, (("safty", ">", 1),))])
def test_unknown_measures_are_refused(agv: KnowledgeBase, utility: Utility) -> None:
    with pytest.raises(UnknownElementError, match="did you mean 'safety'"):
        agv.request_action("navigate", utility=utility)
    with pytest.raises(UnknownElementError, match="did you mean 'safety'"):
        agv.configurations("navigate", utility)
    assert agv.required_actions() == []


def test_an_ended_action_remembers_what_decided(agv: KnowledgeBase) -> None:
    utility = Utility({"energy": -1})
    agv.request_action("navigate", utility=utility)
    ended = agv.finish_action("navigate")
    assert ended is not None
    assert (ended.utility, ended.result) == (utility, "completed")


def test_when_the_kinect_fails_the_next_best_is_chosen(agv: KnowledgeBase) -> None:
    agv.request_action("navigate", preference="safety")
    settle(agv)
    agv.set_component_failure("kinect")
    assert chosen(agv) == ("lidar + amcl", "safe speed")
    settle(agv)
    agv.clear_component_failure("kinect")
    assert chosen(agv) == ("lidar + amcl", "safe speed"), "what is solved stays, unless it always improves"


def test_limits_that_cannot_be_met_leave_it_to_priorities_and_are_told(
    agv: KnowledgeBase, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        agv.request_action("navigate", utility=Utility({"safety": 1}, (("energy", "<=", 1),)))
    assert chosen(agv) == ("lidar + amcl", "safe speed")
    assert "nothing feasible for 'navigate' meets energy <= 1: priorities decide" in caplog.text
    notes = agv.explain("action", "navigate").notes
    assert notes == ("no feasible configuration meets energy <= 1 (the least is 1.5); so priorities decide",)


def test_limits_that_are_met_need_no_note(agv: KnowledgeBase) -> None:
    agv.request_action("navigate", utility=Utility({"safety": 1}, (("energy", "<=", 3),)))
    assert agv.explain("action", "navigate").notes == ()


def test_all_configurations_come_best_first(agv: KnowledgeBase) -> None:
    utility = Utility({"safety": 1, "energy": -1}, (("accuracy", ">", 1.3),))
    listed = list(agv.configurations("navigate", utility))
    assert [one.utility for one in listed] == sorted((one.utility for one in listed), reverse=True)
    assert {one.function_designs["localization"] for one in listed} == {"kinect + amcl", "kinect + mrpt"}
    assert len(list(agv.configurations("navigate"))) == 18


def test_an_action_that_is_unfeasible_has_no_configurations(agv: KnowledgeBase) -> None:
    agv.set_component_failure("move_base")
    assert list(agv.configurations("navigate")) == []


TWO_ACTIONS = """
measures: {speed: , comfort: }
actions: {drive: {requires: [move, see]}, park: {requires: [move]}}
functions: {move: , see: {always_improve: true}}
components: {motor: , camera: , lidar: }
function_designs:
  by motor: {function: move, components: [motor]}
  by camera: {function: see, components: [camera, motor], estimations: [{measure: speed, value: 1}]}
  by lidar: {function: see, components: [lidar], estimations: [{measure: comfort, value: 1}]}
component_configurations:
  fast: {component: motor, priority: 2, estimations: [{measure: speed, value: 5}]}
  soft: {component: motor, priority: 3, estimations: [{measure: comfort, value: 5}]}
  usual: {component: motor, priority: 1}
"""


@pytest.fixture
def car() -> KnowledgeBase:
    return planned(KnowledgeBase(knowledge_model(TWO_ACTIONS), SimulationClock()))


def drives(kb: KnowledgeBase) -> tuple[str | None, str | None]:
    return kb.selected_component_configuration("motor"), kb.selected_function_design("see")


def test_of_two_actions_requested_together_the_first_utility_decides_on_what_they_share(car: KnowledgeBase) -> None:
    with car.transaction():
        car.request_action("park", preference="comfort")
        car.request_action("drive", preference="speed")
    assert drives(car) == ("soft", "by camera")


def test_an_action_without_utility_leaves_what_it_shares_to_the_one_that_has_one(car: KnowledgeBase) -> None:
    with car.transaction():
        car.request_action("park")
        car.request_action("drive", preference="speed")
    assert drives(car) == ("fast", "by camera")


def test_what_runs_for_another_action_is_kept(car: KnowledgeBase) -> None:
    car.request_action("park")
    settle(car)
    assert drives(car)[0] == "usual"
    car.request_action("drive", preference="speed")
    assert drives(car) == ("usual", "by camera")


def test_what_always_improves_is_decided_anew_when_something_better_is_feasible(car: KnowledgeBase) -> None:
    car.set_component_failure("camera")
    car.request_action("drive", preference="speed")
    settle(car)
    assert drives(car) == ("fast", "by lidar")
    car.clear_component_failure("camera")
    assert drives(car) == ("fast", "by camera")


def test_ties_leave_what_is_solved_as_it_is(car: KnowledgeBase) -> None:
    car.set_component_failure("camera")
    car.request_action("drive", utility=Utility())
    settle(car)
    car.clear_component_failure("camera")
    assert drives(car) == ("usual", "by lidar")


@pytest.mark.parametrize("text", ["energy<=3", " energy  <= 3.0 "])
def test_a_limit_is_read_as_it_is_written(text: str) -> None:
    assert str(Limit.parse(text)) == "energy <= 3"


@pytest.mark.parametrize("text", ["", "energy", "<= 3", "energy = 3", "energy <= x", "energy <= nan", "energy =< 3"])
def test_what_is_no_limit_is_refused(text: str) -> None:
    with pytest.raises(InvalidValueError, match="is not a limit"):
        Limit.parse(text)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), True, "1"])
def test_weights_and_limits_are_finite_numbers(value: float) -> None:
    with pytest.raises(InvalidValueError, match="finite number"):
        Utility({"energy": value})
    with pytest.raises(InvalidValueError, match="finite number"):
        Limit("energy", "<=", value)  # type: ignore[arg-type]
