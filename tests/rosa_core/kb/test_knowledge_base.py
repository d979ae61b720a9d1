"""The contract of each method of the knowledge base: what it answers, what it writes, what it refuses and how."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from rosa_core import (
    ElementKind,
    InvalidValueError,
    KnowledgeBase,
    KnowledgeModel,
    RequestRefusedError,
    Result,
    SimulationClock,
    Situation,
    Status,
    UnknownElementError,
)
from rosa_core.kb import Measurement, ReconfigurationPlan, RequiredAction
from rosa_core.model.elements import ComponentType
from tests.rosa_core.sample_models import KINDS, heard

# -- names --

BY_NAME: list[tuple[str, Callable[[KnowledgeBase, Any], object], str, str]] = [
    ("add_measurement", lambda kb, name: kb.add_measurement(name, 1.0), "batery", "battery"),
    ("measurement", lambda kb, name: kb.measurement(name), "winds", "wind"),
    ("set_component_failure", lambda kb, name: kb.set_component_failure(name), "rotor", "rotors"),
    ("clear_component_failure", lambda kb, name: kb.clear_component_failure(name), "Camera", "camera"),
    ("request_action", lambda kb, name: kb.request_action(name), "delivr", "deliver"),
    ("preference", lambda kb, name: kb.request_action("hover", name), "lihgt", "light"),
    ("cancel_action", lambda kb, name: kb.cancel_action(name), "hoover", "hover"),
    ("finish_action", lambda kb, name: kb.finish_action(name), "waiting", "wait"),
    ("is_action_feasible", lambda kb, name: kb.is_action_feasible(name), "delive", "deliver"),
    ("adaptable_components", lambda kb, name: kb.adaptable_components([name]), "fly fastt", "fly fast"),
    ("function designs", lambda kb, name: kb.selectable_function_designs(name), "seee", "see"),
    ("design priority", lambda kb, name: kb.function_design_priority(name), "fly gentle", "fly gently"),
    ("configurations", lambda kb, name: kb.selectable_component_configurations(name), "cameras", "camera"),
    ("configuration priority", lambda kb, name: kb.component_configuration_priority(name), "sharpe", "sharp"),
    ("selected design", lambda kb, name: kb.selected_function_design(name), "flyy", "fly"),
    ("selected configuration", lambda kb, name: kb.selected_component_configuration(name), "lidarr", "lidar"),
    ("select design", lambda kb, name: kb.select_configuration([name], []), "see by cam", "see by camera"),
    ("select configuration", lambda kb, name: kb.select_configuration([], [name]), "grainee", "grainy"),
    ("set active", lambda kb, name: kb.set_component_active(name, True), "damp", "damper"),
    ("is active", lambda kb, name: kb.is_component_active(name), "becon", "beacon"),
    ("component type", lambda kb, name: kb.component_type(name), "auto pilot", "autopilot"),
    ("configured component", lambda kb, name: kb.configured_component(name), "grain", "grainy"),
    ("parameters", lambda kb, name: kb.component_parameters(name), "sharpp", "sharp"),
    ("status", lambda kb, name: kb.status("function", name), "fliy", "fly"),
    ("explain", lambda kb, name: kb.explain("action", name), "hoverr", "hover"),
    ("suppose", lambda kb, name: kb.suppose(Situation(active_components=(name,))), "liddar", "lidar"),
]


@pytest.mark.parametrize(("_method", "call", "wrong", "right"), BY_NAME, ids=[row[0] for row in BY_NAME])
def test_an_unknown_name_is_refused_and_the_nearest_known_one_is_given(
    kb: KnowledgeBase, _method: str, call: Callable[[KnowledgeBase, Any], object], wrong: str, right: str
) -> None:
    with pytest.raises(UnknownElementError, match=f"did you mean '{right}'"):
        call(kb, wrong)


@pytest.mark.parametrize("name", [None, 7, ["rotors"], ""])
def test_what_is_no_name_at_all_is_unknown_too(kb: KnowledgeBase, name: Any) -> None:
    with pytest.raises(UnknownElementError):
        kb.set_component_failure(name)


@pytest.mark.parametrize("kind", ["measure", "constraint", "design", "", None, 3])
def test_only_kinds_that_have_a_status_can_be_asked_for_one(kb: KnowledgeBase, kind: Any) -> None:
    with pytest.raises(InvalidValueError, match="action, function, component, function_design"):
        kb.statuses(kind)


def test_statuses_of_a_kind_come_in_order_of_declaration(kb: KnowledgeBase) -> None:
    assert list(kb.statuses("component")) == ["rotors", "autopilot", "damper", "camera", "lidar", "beacon"]
    assert list(kb.statuses(ElementKind.ACTION)) == ["deliver", "hover", "wait"]


def test_before_anything_is_known_everything_is_feasible_and_no_constraint_is_evaluated(kb: KnowledgeBase) -> None:
    assert {status for kind in KINDS for status in kb.statuses(kind).values()} == {Status.FEASIBLE}
    assert {status for _, status in kb.constraints()} == {Status.NOT_EVALUATED}
    assert kb.revision == 0


# -- monitoring --


def test_there_is_no_measurement_before_the_first(kb: KnowledgeBase) -> None:
    assert kb.measurement("light") is None


def test_a_measurement_is_taken_now_unless_a_time_is_given(kb: KnowledgeBase, clock: SimulationClock) -> None:
    clock.advance_to(4.0)
    kb.add_measurement("light", 60)
    kb.add_measurement("wind", 3, time=2.5)
    assert kb.measurement("light") == Measurement("light", 60.0, 4.0)
    assert kb.measurement("wind") == Measurement("wind", 3.0, 2.5)


def test_an_older_measurement_is_remembered_but_does_not_count(kb: KnowledgeBase) -> None:
    kb.add_measurement("light", 60, time=10)
    kb.add_measurement("light", 1, time=9.9)
    assert kb.measurement("light") == Measurement("light", 60.0, 10.0)
    assert kb.status("component_configuration", "sharp") is Status.FEASIBLE
    assert kb.history("measurements") == (Measurement("light", 60.0, 10.0), Measurement("light", 1.0, 9.9))


def test_of_two_measurements_of_the_same_time_the_one_written_last_counts(kb: KnowledgeBase) -> None:
    kb.add_measurement("light", 60, time=10)
    kb.add_measurement("light", 1, time=10)
    assert kb.measurement("light") == Measurement("light", 1.0, 10.0)
    assert kb.status("component_configuration", "sharp") is Status.UNFEASIBLE


@pytest.mark.parametrize(
    "value",
    [float("nan"), float("inf"), -float("inf"), "7", "much", None, True, [1.0], 10**400, 10**5000],
    ids=["nan", "inf", "-inf", "digits", "word", "None", "bool", "list", "over float", "over printing"],
)
def test_a_measurement_that_is_not_a_finite_number_is_refused(kb: KnowledgeBase, value: Any) -> None:
    with pytest.raises(InvalidValueError, match="a measurement of light must be a finite number"):
        kb.add_measurement("light", value)
    with pytest.raises(InvalidValueError, match="the time of a measurement must be a finite number"):
        kb.add_measurement("light", 1.0, time="soon" if value is None else value)
    assert kb.measurement("light") is None


def test_a_failure_lasts_until_it_is_cleared(kb: KnowledgeBase) -> None:
    kb.set_component_failure("camera")
    assert kb.status("component", "camera") is Status.FAILURE
    kb.add_measurement("light", 60)
    assert kb.status("component", "camera") is Status.FAILURE
    kb.clear_component_failure("camera")
    assert kb.status("component", "camera") is Status.FEASIBLE


def test_a_failure_does_not_stop_a_component_from_being_active(kb: KnowledgeBase) -> None:
    kb.set_component_active("camera", True)
    kb.set_component_failure("camera")
    assert kb.is_component_active("camera")


def test_reporting_a_failure_again_or_clearing_what_has_not_failed_changes_nothing(kb: KnowledgeBase) -> None:
    kb.set_component_failure("camera", time=3)
    events = heard(kb)
    kb.set_component_failure("camera", time=9)
    kb.clear_component_failure("lidar")
    assert (events, kb.revision) == ([], 1)
    assert kb.explain("component", "camera").reason == "a failure was reported at 3.0 s"


# -- actions --


def test_a_request_makes_an_action_required_from_now_on(kb: KnowledgeBase, clock: SimulationClock) -> None:
    clock.advance_to(7.0)
    required = kb.request_action("hover", preference="wind")
    assert required == RequiredAction("hover", 7.0, "wind")
    assert kb.required_actions() == [required]
    assert kb.status("action", "hover") is Status.UNSOLVED
    assert kb.status("function", "fly") is Status.UNSOLVED


def test_a_request_for_an_unfeasible_action_is_refused_with_the_reason(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.125, time=3)
    with pytest.raises(RequestRefusedError, match=r"deliver is unfeasible.*battery 0\.125 \(measured at 3\.0 s\)"):
        kb.request_action("deliver")
    assert kb.required_actions() == []


def test_a_refusal_names_the_failed_component_at_the_bottom_of_the_chain(kb: KnowledgeBase) -> None:
    kb.set_component_failure("rotors", time=2)
    with pytest.raises(RequestRefusedError, match=r"rotors: a failure was reported at 2\.0 s"):
        kb.request_action("hover")


def test_a_request_for_an_action_already_required_changes_nothing(kb: KnowledgeBase, clock: SimulationClock) -> None:
    first = kb.request_action("deliver")
    kb.add_measurement("battery", 0.1)
    events, revision = heard(kb), kb.revision
    clock.advance_to(5)
    assert kb.request_action("deliver", preference="wind") == first
    assert (events, kb.revision, kb.required_actions()) == ([], revision, [first])


def test_an_action_that_becomes_unfeasible_while_required_stays_required(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    kb.add_measurement("battery", 0.1)
    assert not kb.is_action_feasible("deliver")
    assert [required.action for required in kb.required_actions()] == ["deliver"]


@pytest.mark.parametrize(
    ("end", "result"),
    [
        (lambda kb: kb.cancel_action("hover"), Result.ABANDONED),
        (lambda kb: kb.finish_action("hover"), Result.COMPLETED),
        (lambda kb: kb.finish_action("hover", "failed"), Result.FAILED),
        (lambda kb: kb.finish_action("hover", Result.COMPLETED), Result.COMPLETED),
    ],
)
def test_an_action_ends_with_a_result_and_a_time(
    kb: KnowledgeBase, clock: SimulationClock, end: Callable[[KnowledgeBase], Any], result: Result
) -> None:
    kb.request_action("hover", preference="wind")
    clock.advance_to(8)
    ended = end(kb)
    assert ended == RequiredAction("hover", 0.0, "wind", 8.0, result)
    assert kb.history("required_actions") == (ended,)
    assert kb.required_actions() == []
    assert kb.status("action", "hover") is Status.FEASIBLE


def test_ending_an_action_that_is_not_required_changes_nothing(kb: KnowledgeBase) -> None:
    assert kb.cancel_action("hover") is None
    assert kb.finish_action("hover", "failed") is None
    assert kb.revision == 0
    assert kb.history("required_actions") == ()


def test_a_result_is_one_of_the_three(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    with pytest.raises(InvalidValueError, match="'done' is not one of: completed, failed, abandoned"):
        kb.finish_action("hover", "done")
    plan = kb.select_configuration(["fly fast"], [])
    assert plan is not None
    with pytest.raises(InvalidValueError, match="'succeeded' is not one of"):
        kb.set_reconfiguration_result(plan, "succeeded")
    assert kb.pending_reconfiguration_plan() == plan


def test_required_actions_come_in_order_of_request(kb: KnowledgeBase) -> None:
    for action in ("wait", "deliver", "hover"):
        kb.request_action(action)
    kb.cancel_action("deliver")
    kb.request_action("deliver")
    assert [required.action for required in kb.required_actions()] == ["wait", "hover", "deliver"]


def test_a_function_stays_required_as_long_as_one_action_requires_it(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    kb.request_action("deliver")
    kb.cancel_action("hover")
    assert kb.statuses("function") == {"fly": Status.UNSOLVED, "see": Status.UNSOLVED}
    kb.cancel_action("deliver")
    assert kb.statuses("function") == {"fly": Status.FEASIBLE, "see": Status.FEASIBLE}


def test_an_action_without_functions_is_solved_as_soon_as_it_is_required(kb: KnowledgeBase) -> None:
    kb.request_action("wait")
    assert kb.status("action", "wait") is Status.SOLVED


def test_selectable_actions_are_those_not_unfeasible(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery", 0.1)
    assert kb.selectable_actions() == ["hover", "wait"]
    assert [kb.is_action_feasible(action) for action in ("deliver", "hover", "wait")] == [False, True, True]


# -- what planning asks --


def test_selectable_designs_and_configurations_leave_out_the_unfeasible(kb: KnowledgeBase) -> None:
    assert kb.selectable_function_designs("fly") == ["fly fast", "fly gently"]
    kb.add_measurement("wind", 9)
    kb.add_measurement("light", 10)
    assert kb.selectable_function_designs("fly") == ["fly gently"]
    assert kb.selectable_component_configurations("camera") == ["grainy"]
    assert kb.selectable_component_configurations("lidar") == []


def test_adaptable_is_what_is_required_and_unsolved(kb: KnowledgeBase) -> None:
    assert (kb.adaptable_functions(), kb.adaptable_components()) == ([], [])
    kb.request_action("deliver")
    assert kb.adaptable_functions() == ["fly", "see"]
    assert kb.adaptable_components() == []
    assert kb.adaptable_components(["see by camera", "fly gently"]) == ["rotors", "autopilot", "damper", "camera"]


def test_solved_is_adaptable_only_where_it_always_improves(kb: KnowledgeBase) -> None:
    everything = ("rotors", "autopilot", "camera")
    kb.suppose(Situation({}, (), ("deliver",), ("fly fast", "see by camera"), ("sharp",), everything))
    assert kb.status("action", "deliver") is Status.SOLVED
    assert kb.adaptable_functions() == ["see"]
    assert kb.adaptable_components() == ["camera"]


def test_the_model_can_be_asked_through_the_knowledge_base(kb: KnowledgeBase) -> None:
    assert kb.function_design_priority("fly gently") == 2
    assert kb.component_configuration_priority("sharp") == 1
    assert kb.component_parameters("grainy") == {"exposure": 0.1, "gain": 8}
    assert kb.configured_component("grainy") == "camera"
    assert kb.component_type("damper") is ComponentType.ROS_NODE
    assert kb.component_type("rotors") is ComponentType.COMPONENT


# -- history, supposition --


def test_history_remembers_statuses_with_their_times(kb: KnowledgeBase, clock: SimulationClock) -> None:
    clock.advance_to(2)
    kb.set_component_failure("lidar")
    clock.advance_to(3)
    kb.clear_component_failure("lidar")
    entries = kb.history("statuses", "lidar")
    assert [(entry.time, entry.change.old, entry.change.new) for entry in entries] == [
        (2.0, Status.FEASIBLE, Status.FAILURE),
        (3.0, Status.FAILURE, Status.FEASIBLE),
    ]


def test_history_of_plans_is_found_by_what_they_change(kb: KnowledgeBase, clock: SimulationClock) -> None:
    kb.request_action("deliver")
    plan = kb.select_configuration(["fly fast", "see by camera"], ["grainy"])
    assert plan is not None
    clock.advance_to(1)
    kb.set_reconfiguration_result(plan, "failed")
    for name in ("autopilot", "grainy", None):
        (entry,) = kb.history("reconfiguration_plans", name)
        assert (entry.plan, entry.end_time, entry.result) == (plan, 1.0, Result.FAILED)
    assert kb.history("reconfiguration_plans", "lidar") == ()


def test_history_keeps_the_latest_entries_up_to_its_length(drone: KnowledgeModel) -> None:
    kb = KnowledgeBase(drone, SimulationClock(), history_length=3)
    for value in range(5):
        kb.add_measurement("light", value)
    assert [entry.value for entry in kb.history("measurements")] == [2, 3, 4]


def test_an_unknown_topic_of_history_is_refused(kb: KnowledgeBase) -> None:
    with pytest.raises(InvalidValueError, match="measurements, statuses, required_actions, reconfiguration_plans"):
        kb.history("weather")


def test_a_supposed_situation_is_not_checked_for_sense_and_plans_nothing(kb: KnowledgeBase) -> None:
    kb.suppose(Situation({"battery": 0.1}, ("camera",), ("deliver",), ("see by camera",), ("sharp",), ("camera",)))
    assert kb.status("action", "deliver") is Status.UNFEASIBLE
    assert kb.status("function", "see") is Status.CONFIGURATION_ERROR
    assert kb.pending_reconfiguration_plan() is None
    assert kb.required_actions() == [RequiredAction("deliver", 0.0)]


def test_a_plan_is_a_value() -> None:
    assert ReconfigurationPlan(1, 2.0, ("a",)) == ReconfigurationPlan(1, 2.0, ("a",), (), ())
