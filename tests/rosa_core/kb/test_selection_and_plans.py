"""Selecting a configuration, the reconfiguration plan that follows from it, and what becomes of plans."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from rosa_core import InvalidValueError, KnowledgeBase, ReconfigurationPlan, Result, SimulationClock, Status
from rosa_core.kb import ConfigurationSelected, ReconfigurationPlanCreated, ReconfigurationPlanEnded
from tests.rosa_core.sample_models import heard, knowledge_model


def carry_out(kb: KnowledgeBase, plan: ReconfigurationPlan | None) -> None:
    """What an executor on a robot that obeys would write."""
    assert plan is not None
    for component in plan.deactivate:
        kb.set_component_active(component, False)
    for component in plan.activate:
        kb.set_component_active(component, True)
    assert kb.set_reconfiguration_result(plan, "completed")


def work(plan: ReconfigurationPlan | None) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]] | None:
    return plan and (plan.activate, plan.deactivate, plan.parameter_adaptations)


@pytest.fixture
def delivering(kb: KnowledgeBase) -> KnowledgeBase:
    """The drone delivers, flies fast and sees by a sharp camera."""
    kb.request_action("deliver")
    carry_out(kb, kb.select_configuration(["fly fast", "see by camera"], ["sharp"]))
    assert kb.status("action", "deliver") is Status.SOLVED
    return kb


# -- what is selected --


def test_a_selection_takes_the_place_of_others_for_the_same_function_and_component(delivering: KnowledgeBase) -> None:
    events = heard(delivering, ConfigurationSelected)
    delivering.select_configuration(["fly gently"], ["grainy"])
    assert delivering.selected_function_design("fly") == "fly gently"
    assert delivering.selected_function_design("see") == "see by camera"
    assert delivering.selected_component_configuration("camera") == "grainy"
    (event,) = events
    assert event == ConfigurationSelected(
        event.revision, event.time, ("fly gently",), ("grainy",), ("fly fast",), ("sharp",)
    )


def test_designs_of_functions_no_longer_required_are_unselected(delivering: KnowledgeBase) -> None:
    delivering.cancel_action("deliver")
    assert delivering.selected_function_design("fly") == "fly fast"
    delivering.select_configuration([], [])
    assert delivering.selected_function_design("fly") is None
    assert delivering.selected_function_design("see") is None


def test_configurations_of_components_no_longer_required_are_unselected(delivering: KnowledgeBase) -> None:
    delivering.select_configuration(["see by lidar"], [])
    assert delivering.selected_component_configuration("camera") is None


def test_what_stays_required_stays_selected_without_being_named(delivering: KnowledgeBase) -> None:
    events, revision = heard(delivering), delivering.revision
    assert delivering.select_configuration([], []) is None
    assert (events, delivering.revision) == ([], revision)


def test_one_design_per_function_and_one_configuration_per_component(delivering: KnowledgeBase) -> None:
    with pytest.raises(InvalidValueError, match="'fly fast' and 'fly gently' are both designs of 'fly'"):
        delivering.select_configuration(["fly fast", "fly gently"], [])
    with pytest.raises(InvalidValueError, match="'sharp' and 'grainy' both configure 'camera'"):
        delivering.select_configuration([], ["sharp", "grainy"])


def test_a_selection_is_not_checked_for_sense_and_shows_at_once_in_the_statuses(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    kb.add_measurement("wind", 9)
    kb.add_measurement("light", 20)
    kb.select_configuration(["fly fast", "see by camera"], ["sharp"])
    assert kb.status("function", "fly") is Status.CONFIGURATION_ERROR
    assert kb.status("component", "camera") is Status.CONFIGURATION_ERROR
    assert kb.status("function", "see") is Status.IMPLICIT_CONFIGURATION_ERROR
    kb.select_configuration(["fly gently"], ["grainy"])
    assert kb.statuses("function") == {"fly": Status.UNSOLVED, "see": Status.UNSOLVED}


def test_naming_the_same_choice_twice_is_naming_it_once(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    plan = kb.select_configuration(["see by camera", "see by camera"], ["sharp", "sharp"])
    assert work(plan) == (("camera",), (), ("sharp",))


# -- what is planned --


def test_a_plan_activates_the_components_of_the_selected_designs_and_sets_new_configurations(
    kb: KnowledgeBase, clock: SimulationClock
) -> None:
    clock.advance_to(6)
    kb.request_action("deliver")
    plan = kb.select_configuration(["see by camera", "fly gently"], ["grainy"])
    assert plan == ReconfigurationPlan(1, 6.0, ("rotors", "autopilot", "damper", "camera"), (), ("grainy",))
    assert kb.pending_reconfiguration_plan() == plan


def test_a_plan_leaves_out_what_is_active_already(kb: KnowledgeBase) -> None:
    kb.set_component_active("autopilot", True)
    kb.request_action("hover")
    assert work(kb.select_configuration(["fly fast"], [])) == (("rotors",), (), ())


def test_a_component_that_the_old_and_the_new_design_share_keeps_running(delivering: KnowledgeBase) -> None:
    assert work(delivering.select_configuration(["fly gently"], [])) == (("damper",), (), ())
    carry_out(delivering, delivering.pending_reconfiguration_plan())
    assert work(delivering.select_configuration(["fly fast"], [])) == ((), ("damper",), ())


def test_a_component_that_another_required_function_uses_keeps_running() -> None:
    model = knowledge_model(
        """
        actions: {look: {requires: [see]}, listen: {requires: [hear]}}
        functions: {see: , hear: }
        components: {computer: , camera: , microphone: }
        function_designs:
          by camera: {function: see, components: [computer, camera]}
          by microphone: {function: hear, components: [computer, microphone]}
        """
    )
    kb = KnowledgeBase(model, SimulationClock())
    kb.request_action("look")
    kb.request_action("listen")
    carry_out(kb, kb.select_configuration(["by camera", "by microphone"], []))
    kb.finish_action("look")
    assert work(kb.select_configuration([], [])) == ((), ("camera",), ())


def test_active_components_that_no_selected_design_needs_are_deactivated(delivering: KnowledgeBase) -> None:
    delivering.finish_action("deliver")
    assert work(delivering.select_configuration([], [])) == ((), ("rotors", "autopilot", "camera"), ())


def test_a_component_that_is_in_no_design_at_all_is_left_alone(kb: KnowledgeBase) -> None:
    kb.set_component_active("beacon", True)
    kb.set_component_active("lidar", True)
    assert work(kb.select_configuration([], [])) == ((), ("lidar",), ())


def test_a_selected_design_of_a_function_that_is_not_required_activates_nothing(kb: KnowledgeBase) -> None:
    assert kb.select_configuration(["fly fast"], []) is None
    assert kb.selected_function_design("fly") == "fly fast"


def test_an_empty_plan_is_no_plan(delivering: KnowledgeBase) -> None:
    events = heard(delivering, ReconfigurationPlanCreated)
    assert delivering.select_configuration(["fly fast", "see by camera"], ["sharp"]) is None
    assert delivering.pending_reconfiguration_plan() is None
    assert events == []


def test_a_configuration_that_runs_already_is_not_set_again(delivering: KnowledgeBase) -> None:
    delivering.set_component_active("autopilot", False)
    assert work(delivering.select_configuration(["see by camera"], ["sharp"])) == (("autopilot",), (), ())


@pytest.mark.parametrize(
    "end", [lambda kb: kb.set_component_active("camera", False), lambda kb: kb.set_component_restarted("camera")]
)
def test_a_component_that_has_ended_is_configured_again_before_it_is_activated(
    delivering: KnowledgeBase, end: Callable[[KnowledgeBase], None]
) -> None:
    end(delivering)
    assert not delivering.is_component_active("camera")
    assert work(delivering.replan()) == (("camera",), (), ("sharp",))


def test_a_component_that_restarts_is_tried_again_although_a_plan_with_it_has_failed(delivering: KnowledgeBase) -> None:
    delivering.set_component_active("camera", False)
    plan = delivering.replan()
    assert plan is not None
    delivering.set_reconfiguration_result(plan, "failed")
    assert delivering.replan() is None
    delivering.set_component_restarted("camera")
    assert work(delivering.pending_reconfiguration_plan()) == (("camera",), (), ("sharp",))


def test_an_idle_component_that_restarts_is_no_reason_for_a_plan(delivering: KnowledgeBase) -> None:
    events = heard(delivering)
    delivering.set_component_restarted("lidar")
    assert events == []


def test_a_configuration_left_and_taken_up_again_is_set_again(delivering: KnowledgeBase) -> None:
    carry_out(delivering, delivering.select_configuration(["see by lidar"], []))
    plan = delivering.select_configuration(["see by camera"], ["sharp"])
    assert work(plan) == (("camera",), ("lidar",), ("sharp",))


# -- what becomes of plans --


def test_a_newer_plan_abandons_the_pending_one(kb: KnowledgeBase, clock: SimulationClock) -> None:
    kb.request_action("hover")
    old = kb.select_configuration(["fly fast"], [])
    events = heard(kb, ReconfigurationPlanCreated, ReconfigurationPlanEnded)
    clock.advance_to(2)
    new = kb.select_configuration(["fly gently"], [])
    assert old is not None
    assert new is not None
    assert kb.pending_reconfiguration_plan() == new
    assert new.id > old.id
    ended, created = events
    assert (ended.plan, ended.result, created.plan) == (old, Result.ABANDONED, new)
    assert [(e.plan, e.end_time, e.result) for e in kb.history("reconfiguration_plans")] == [(old, 2, "abandoned")]


def test_the_same_work_keeps_the_pending_plan(kb: KnowledgeBase, clock: SimulationClock) -> None:
    kb.request_action("hover")
    plan = kb.select_configuration(["fly fast"], [])
    events = heard(kb)
    clock.advance_to(2)
    assert kb.select_configuration(["fly fast"], []) is plan
    assert kb.pending_reconfiguration_plan() is plan
    assert events == []


def test_a_pending_plan_is_abandoned_when_nothing_is_left_to_do(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    plan = kb.select_configuration(["fly fast"], [])
    kb.cancel_action("hover")
    assert kb.select_configuration([], []) is None
    assert kb.pending_reconfiguration_plan() is None
    assert [(e.plan, e.result) for e in kb.history("reconfiguration_plans")] == [(plan, Result.ABANDONED)]


@pytest.mark.parametrize("result", Result)
def test_a_plan_ends_once(kb: KnowledgeBase, result: Result) -> None:
    kb.request_action("hover")
    plan = kb.select_configuration(["fly fast"], [])
    assert plan is not None
    events = heard(kb)
    assert kb.set_reconfiguration_result(plan, result) is True
    assert kb.set_reconfiguration_result(plan, "completed") is False
    assert kb.set_reconfiguration_result(plan, "failed") is False
    assert [(type(event), event.result) for event in events] == [(ReconfigurationPlanEnded, result)]
    assert kb.pending_reconfiguration_plan() is None


def test_the_result_of_an_abandoned_plan_does_not_end_the_newer_one(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    old = kb.select_configuration(["fly fast"], [])
    new = kb.select_configuration(["fly gently"], [])
    assert old is not None
    assert kb.set_reconfiguration_result(old, "completed") is False
    assert kb.pending_reconfiguration_plan() == new


@pytest.mark.parametrize("result", ["failed", "abandoned"])
def test_a_configuration_that_was_selected_but_not_applied_is_planned_again(
    delivering: KnowledgeBase, result: str
) -> None:
    plan = delivering.select_configuration([], ["grainy"])
    assert plan is not None
    delivering.set_reconfiguration_result(plan, result)
    again = delivering.select_configuration(["fly gently"], [])
    assert work(again) == (("damper",), (), ("grainy",))
    carry_out(delivering, again)
    assert delivering.select_configuration([], []) is None


def test_a_configuration_planned_in_an_abandoned_plan_is_in_the_newer_one(delivering: KnowledgeBase) -> None:
    delivering.select_configuration([], ["grainy"])
    assert work(delivering.select_configuration(["fly gently"], [])) == (("damper",), (), ("grainy",))


def fail(kb: KnowledgeBase) -> ReconfigurationPlan:
    """A plan to hover that failed."""
    kb.request_action("hover")
    plan = kb.select_configuration(["fly fast"], [])
    assert plan is not None
    kb.set_reconfiguration_result(plan, "failed")
    return plan


def test_the_work_of_a_failed_plan_is_not_planned_again(kb: KnowledgeBase) -> None:
    fail(kb)
    events = heard(kb)
    assert kb.select_configuration(["fly fast"], []) is None
    assert kb.select_configuration([], []) is None
    assert kb.pending_reconfiguration_plan() is None
    assert events == []


def test_the_work_of_a_failed_plan_is_planned_again_once_a_failure_is_cleared(kb: KnowledgeBase) -> None:
    plan = fail(kb)
    kb.set_component_failure("autopilot")
    assert kb.select_configuration([], []) is None
    kb.clear_component_failure("autopilot")
    again = kb.select_configuration(["fly fast"], [])
    assert work(again) == work(plan)
    assert again != plan


def test_clearing_what_has_not_failed_does_not_repeat_a_failed_plan(kb: KnowledgeBase) -> None:
    fail(kb)
    kb.clear_component_failure("autopilot")
    assert kb.select_configuration(["fly fast"], []) is None


def test_other_work_than_that_of_the_failed_plan_is_planned(kb: KnowledgeBase) -> None:
    plan = fail(kb)
    other = kb.select_configuration(["fly gently"], [])
    assert work(other) == (("rotors", "autopilot", "damper"), (), ())
    assert work(kb.select_configuration(["fly fast"], [])) == work(plan)


def test_an_abandoned_plan_may_be_planned_again_at_once(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    plan = kb.select_configuration(["fly fast"], [])
    assert plan is not None
    kb.set_reconfiguration_result(plan, "abandoned")
    assert work(kb.select_configuration(["fly fast"], [])) == work(plan)


# -- plans and transactions that are taken back --


class AbortedError(Exception):
    """What rolls a transaction back."""


def take_back(kb: KnowledgeBase, *writes: Callable[[], object]) -> None:
    """Write, and then let it never have been."""

    def write_in_vain() -> None:
        with kb.transaction():
            for write in writes:
                write()
            raise AbortedError

    with pytest.raises(AbortedError):
        write_in_vain()


def test_a_selection_taken_back_leaves_the_configuration_applied(delivering: KnowledgeBase) -> None:
    take_back(delivering, lambda: delivering.select_configuration([], ["grainy"]))
    assert delivering.selected_component_configuration("camera") == "sharp"
    assert delivering.select_configuration(["see by camera"], ["sharp"]) is None


def test_a_result_taken_back_leaves_the_configuration_to_be_applied(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    plan = kb.select_configuration(["see by camera"], ["sharp"])
    assert plan is not None
    take_back(kb, lambda: kb.set_reconfiguration_result(plan, "completed"))
    assert kb.pending_reconfiguration_plan() == plan
    assert kb.select_configuration(["see by camera"], ["sharp"]) == plan


def test_a_plan_that_failed_stays_failed_when_what_would_forgive_it_is_taken_back(kb: KnowledgeBase) -> None:
    fail(kb)
    kb.set_component_failure("camera")
    take_back(kb, lambda: kb.clear_component_failure("camera"))
    assert kb.select_configuration(["fly fast"], []) is None
    take_back(kb, lambda: kb.select_configuration(["fly gently"], []))
    assert kb.select_configuration(["fly fast"], []) is None


def test_a_failed_result_taken_back_does_not_keep_the_work_from_being_planned(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    plan = kb.select_configuration(["fly fast"], [])
    assert plan is not None
    take_back(kb, lambda: kb.set_reconfiguration_result(plan, "failed"))
    kb.set_reconfiguration_result(plan, "abandoned")
    assert work(kb.select_configuration(["fly fast"], [])) == work(plan)
