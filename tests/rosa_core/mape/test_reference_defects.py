"""What the reference implementation of ROSA gets wrong, one test each; here it must go right."""

from __future__ import annotations

from typing import Any

import pytest

from rosa_core import KnowledgeBase, KnowledgeBaseError, Result, Status
from rosa_core.kb import Event, MonitoringData, ReconfigurationPlanEnded
from rosa_core.mape import AdaptationLoop
from tests.rosa_core.sample_models import PretendedRobot, knowledge_model


@pytest.fixture
def loop(kb: KnowledgeBase, robot: PretendedRobot) -> AdaptationLoop:
    return AdaptationLoop(kb, robot)


def test_a_component_that_two_designs_share_runs_on_when_one_takes_over_from_the_other(
    kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop
) -> None:
    kb.request_action("hover")
    kb.add_measurement("wind", 10)
    assert kb.selected_function_design("fly") == "fly gently"
    assert robot.calls == [("activate", "autopilot"), ("activate", "damper")]
    assert kb.is_component_active("rotors")


def test_a_pending_plan_is_abandoned_by_the_next_and_does_not_run_later(
    kb: KnowledgeBase, robot: PretendedRobot
) -> None:
    kb.request_action("hover")
    old = kb.select_configuration(["fly gently"], [])
    new = kb.select_configuration(["fly fast"], [])
    assert [(e.plan, e.result) for e in kb.history("reconfiguration_plans")] == [(old, Result.ABANDONED)]

    loop = AdaptationLoop(kb, robot)
    assert kb.pending_reconfiguration_plan() == new
    assert old is not None
    assert new is not None
    loop.executor.execute(old)
    loop.executor.execute(new)
    loop.executor.execute(old)
    assert robot.calls == [("activate", "autopilot")]


def test_a_failed_activation_fails_the_plan(kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop) -> None:
    ended: list[Event] = []
    kb.subscribe(ended.append, [ReconfigurationPlanEnded])
    robot.deaf = {"autopilot"}
    kb.request_action("hover")
    assert {event.result for event in ended} == {Result.FAILED}
    assert not kb.is_component_active("autopilot")


def test_a_failed_parameter_change_is_made_again_once_the_component_works(
    kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop
) -> None:
    def only_parameters_fail(call: tuple[Any, ...]) -> None:
        if call[0] == "set_parameters" and failing:
            raise OSError("no parameters")

    failing = [True]
    robot.during_call = only_parameters_fail
    kb.set_component_failure("lidar")
    kb.request_action("deliver")
    assert "camera" not in robot.parameters
    failing.clear()
    kb.clear_component_failure("camera")
    assert robot.parameters["camera"] == {"exposure": 0.01}
    assert kb.status("action", "deliver") is Status.SOLVED


def test_every_recovery_in_a_diagnostic_status_is_read(kb: KnowledgeBase, loop: AdaptationLoop) -> None:
    def diagnose(word: str) -> None:
        values = [{"key": name, "value": word} for name in ("rotors", "camera", "lidar")]
        loop.monitor.update({"status": [{"message": "Component status", "values": values}]})

    diagnose("FALSE")
    assert list(kb.statuses("component").values()).count(Status.FAILURE) == 3
    diagnose("RECOVERED")
    assert Status.FAILURE not in kb.statuses("component").values()


def test_a_request_for_an_unknown_action_does_not_succeed(kb: KnowledgeBase, loop: AdaptationLoop) -> None:
    with pytest.raises(KnowledgeBaseError, match="there is no action 'fetch'"):
        kb.request_action("fetch")
    assert kb.required_actions() == []


def test_a_configuration_without_parameters_is_as_good_as_any(robot: PretendedRobot) -> None:
    text = """
    actions: {run: {requires: [move]}}
    functions: {move: }
    components: {legs: {type: ros_node}}
    function_designs: {on foot: {function: move, components: [legs]}}
    component_configurations: {walk: {component: legs}}
    """
    kb = KnowledgeBase(knowledge_model(text))
    assert kb.component_parameters("walk") == {}
    with AdaptationLoop(kb, robot):
        kb.request_action("run")
    assert kb.selected_component_configuration("legs") == "walk"
    assert kb.status("action", "run") is Status.SOLVED


def test_an_event_is_announced_after_its_data_is_written(kb: KnowledgeBase) -> None:
    found: list[object] = []

    def look(event: Event) -> None:
        found.append(kb.measurement("wind"))
        found.append(kb.status("function_design", "fly fast"))

    kb.subscribe(look, [MonitoringData])
    kb.add_measurement("wind", 10)
    assert found == [kb.measurement("wind"), Status.UNFEASIBLE]


def test_after_a_failed_plan_another_design_is_planned_without_waiting_for_news(
    kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop
) -> None:
    robot.broken = {"camera"}
    kb.request_action("deliver")
    assert kb.selected_function_design("see") == "see by lidar"
    assert robot.running == {"autopilot", "lidar"}
    assert [entry.result for entry in kb.history("reconfiguration_plans")] == [Result.FAILED, Result.COMPLETED]
