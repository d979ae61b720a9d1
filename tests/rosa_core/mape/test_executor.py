"""Carrying out plans on a robot that obeys, refuses or breaks, and the whole loop around it."""

from __future__ import annotations

from typing import Any

import pytest

from rosa_core import KnowledgeBase, ReconfigurationPlan, Result, SimulationClock, Status
from rosa_core.kb import ActionUpdate, ComponentActivity, Event, MonitoringData, ReconfigurationPlanCreated
from rosa_core.mape import AdaptationLoop, Executor
from tests.rosa_core.sample_models import PretendedRobot, heard, knowledge_model


@pytest.fixture
def executor(kb: KnowledgeBase, robot: PretendedRobot) -> Executor:
    """An executor that is woken by new plans."""
    executor = Executor(kb, robot)
    kb.subscribe(executor.on_event, Executor.EVENTS)
    return executor


@pytest.fixture
def loop(kb: KnowledgeBase, robot: PretendedRobot) -> AdaptationLoop:
    return AdaptationLoop(kb, robot)


def results(kb: KnowledgeBase) -> list[str]:
    return [entry.result for entry in kb.history("reconfiguration_plans")]


# -- one plan --


@pytest.mark.usefixtures("executor")
def test_it_deactivates_then_sets_parameters_then_activates(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    kb.set_component_active("lidar", True)
    kb.set_component_active("damper", True)
    kb.request_action("deliver")
    kb.select_configuration(["fly fast", "see by camera"], ["grainy"])
    assert robot.calls == [
        ("deactivate", "damper"),
        ("deactivate", "lidar"),
        ("set_parameters", "camera", {"exposure": 0.1, "gain": 8}),
        ("activate", "autopilot"),
        ("activate", "camera"),
    ]


@pytest.mark.usefixtures("executor")
def test_what_was_done_is_written_with_the_result_as_one_write(kb: KnowledgeBase) -> None:
    kb.set_component_active("lidar", True)
    kb.request_action("deliver")
    events = heard(kb)
    kb.select_configuration(["fly fast", "see by camera"], ["sharp"])
    last = [event for event in events if event.revision == kb.revision]
    activity = next(event for event in last if isinstance(event, ComponentActivity))
    assert (activity.activated, activity.deactivated) == (("rotors", "autopilot", "camera"), ("lidar",))
    assert results(kb) == ["completed"]
    assert kb.status("action", "deliver") is Status.SOLVED


@pytest.mark.usefixtures("executor")
def test_hardware_is_not_called_it_only_becomes_active_in_the_knowledge_base(
    kb: KnowledgeBase, robot: PretendedRobot
) -> None:
    kb.request_action("hover")
    kb.select_configuration(["fly fast"], [])
    assert robot.calls == [("activate", "autopilot")]
    assert kb.is_component_active("rotors")
    kb.cancel_action("hover")
    kb.select_configuration([], [])
    assert robot.calls[1:] == [("deactivate", "autopilot")]
    assert not kb.is_component_active("rotors")


def test_a_configuration_without_parameters_needs_no_call(robot: PretendedRobot) -> None:
    kb = KnowledgeBase(
        knowledge_model(
            """
            actions: {run: {requires: [move]}}
            functions: {move: }
            components: {legs: {type: ros_node}}
            function_designs: {on foot: {function: move, components: [legs]}}
            component_configurations: {walk: {component: legs}}
            """
        )
    )
    with AdaptationLoop(kb, robot):
        kb.request_action("run")
    assert robot.calls == [("activate", "legs")]
    assert results(kb) == ["completed"]
    assert kb.status("action", "run") is Status.SOLVED


@pytest.mark.parametrize("answer", [None, True, 1, "done", 0])
def test_any_answer_but_false_is_a_success(kb: KnowledgeBase, robot: PretendedRobot, answer: Any) -> None:
    robot.activate = lambda component: answer  # type: ignore[method-assign]
    with AdaptationLoop(kb, robot):
        kb.request_action("hover")
    assert results(kb) == ["completed"]


@pytest.mark.parametrize("robot", [PretendedRobot(broken=("autopilot",)), PretendedRobot(deaf=("autopilot",))])
def test_a_call_that_raises_or_says_no_fails_the_plan_and_the_component(
    kb: KnowledgeBase, robot: PretendedRobot
) -> None:
    robot.calls.clear()
    executor = Executor(kb, robot, attempts=3)
    kb.request_action("hover")
    plan = kb.select_configuration(["fly fast"], [])
    assert plan is not None
    assert executor.execute(plan) is Result.FAILED
    assert robot.calls == [("activate", "autopilot")] * 3
    assert results(kb) == ["failed"]
    assert kb.status("component", "autopilot") is Status.FAILURE
    assert not kb.is_component_active("autopilot")
    assert kb.is_component_active("rotors")


@pytest.mark.parametrize("attempts", [1, 2, 5])
def test_a_failing_call_is_tried_a_bounded_number_of_times(kb: KnowledgeBase, attempts: int) -> None:
    robot = PretendedRobot(broken=("camera", "lidar"))
    with AdaptationLoop(kb, robot, attempts=attempts):
        kb.request_action("deliver")
    tries = [call[1] for call in robot.calls]
    assert {name: tries.count(name) for name in tries} == {"camera": attempts, "lidar": attempts, "autopilot": 1}


def test_a_call_that_works_at_the_second_try_is_a_success(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    robot.broken = {"autopilot"}
    robot.during_call = lambda call: len(robot.calls) > 1 and robot.broken.clear()
    with AdaptationLoop(kb, robot):
        kb.request_action("hover")
    assert robot.calls == [("activate", "autopilot")] * 2
    assert results(kb) == ["completed"]


def test_there_must_be_at_least_one_attempt(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    with pytest.raises(ValueError, match="at least 1"):
        Executor(kb, robot, attempts=0)


@pytest.mark.usefixtures("executor")
def test_the_rest_of_a_failing_plan_is_carried_out(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    robot.broken = {"autopilot"}
    kb.request_action("deliver")
    kb.select_configuration(["fly fast", "see by camera"], ["sharp"])
    assert robot.running == {"camera"}
    assert kb.is_component_active("camera")
    assert results(kb) == ["failed"]


@pytest.mark.usefixtures("executor")
def test_a_component_whose_parameters_cannot_be_set_is_not_started(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    robot.broken = {"camera"}
    kb.request_action("deliver")
    kb.select_configuration(["see by camera"], ["sharp"])
    assert {call[0] for call in robot.calls} == {"set_parameters"}
    assert kb.status("component", "camera") is Status.FAILURE
    assert not kb.is_component_active("camera")


def test_a_plan_that_is_not_pending_is_not_carried_out(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    executor = Executor(kb, robot)
    kb.request_action("hover")
    old = kb.select_configuration(["fly gently"], [])
    new = kb.select_configuration(["fly fast"], [])
    assert old is not None
    assert executor.execute(old) is Result.ABANDONED
    assert executor.execute(ReconfigurationPlan(99, 0.0, activate=("camera",))) is Result.ABANDONED
    assert robot.calls == []
    assert kb.pending_reconfiguration_plan() == new


# -- the whole loop --


def test_when_a_request_returns_the_robot_is_configured(
    kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop
) -> None:
    kb.request_action("deliver")
    assert robot.running == {"autopilot", "camera"}
    assert robot.parameters == {"camera": {"exposure": 0.01}}
    assert kb.status("action", "deliver") is Status.SOLVED


def test_a_diagnostic_that_makes_a_component_fail_makes_another_design_run(
    kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop
) -> None:
    kb.request_action("deliver")
    status = {"message": "Component status", "values": [{"key": "camera", "value": "FALSE"}]}
    loop.monitor.update({"status": [status]})
    assert robot.running == {"autopilot", "lidar"}
    status["values"] = [{"key": "camera", "value": "RECOVERED"}]
    loop.monitor.update({"status": [status]})
    assert robot.running == {"autopilot", "camera"}


@pytest.mark.parametrize("robot", [PretendedRobot(broken=("camera",)), PretendedRobot(deaf=("camera",))])
def test_a_component_that_cannot_be_started_is_reported_and_another_design_is_taken(
    kb: KnowledgeBase, robot: PretendedRobot
) -> None:
    with AdaptationLoop(kb, robot):
        kb.request_action("deliver")
    assert robot.running == {"autopilot", "lidar"}
    assert results(kb) == ["failed", "completed"]
    assert kb.status("component", "camera") is Status.FAILURE
    assert kb.status("action", "deliver") is Status.SOLVED


def test_when_nothing_else_is_feasible_the_loop_comes_to_rest(kb: KnowledgeBase) -> None:
    robot = PretendedRobot(broken=("autopilot",))
    with AdaptationLoop(kb, robot):
        kb.request_action("hover")
        assert kb.status("action", "hover") is Status.UNFEASIBLE
        calls = len(robot.calls)
        for light in range(5):
            kb.add_measurement("light", 60 + light)
    assert len(robot.calls) == calls
    assert kb.pending_reconfiguration_plan() is None


def test_a_component_that_cannot_be_stopped_is_tried_again_only_for_a_reason(kb: KnowledgeBase) -> None:
    robot = PretendedRobot()
    with AdaptationLoop(kb, robot):
        kb.request_action("deliver")
        robot.broken = {"camera"}
        kb.finish_action("deliver")
        tries = len(robot.calls)
        kb.add_measurement("light", 60)
        kb.add_measurement("light", 61)
        assert len(robot.calls) == tries
        assert kb.is_component_active("camera")
        robot.broken.clear()
        kb.clear_component_failure("camera")
    assert robot.running == set()
    assert not kb.is_component_active("camera")


def test_after_repair_the_robot_is_configured_again(kb: KnowledgeBase) -> None:
    robot = PretendedRobot(broken=("autopilot",))
    with AdaptationLoop(kb, robot):
        kb.request_action("hover")
        robot.broken.clear()
        kb.clear_component_failure("autopilot")
    assert robot.running == {"autopilot"}
    assert kb.status("action", "hover") is Status.SOLVED


def test_a_plan_abandoned_midway_is_not_carried_on_with(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    def change_mind(call: tuple[Any, ...]) -> None:
        if call == ("activate", "damper"):
            kb.select_configuration(["see by lidar"], [])

    executor = Executor(kb, robot)
    robot.during_call = change_mind
    kb.request_action("deliver")
    old = kb.select_configuration(["fly gently", "see by camera"], [])
    assert old is not None
    assert executor.execute(old) is Result.ABANDONED
    assert robot.calls == [("activate", "autopilot"), ("activate", "damper")]
    assert results(kb)[0] == "abandoned"
    pending = kb.pending_reconfiguration_plan()
    assert pending is not None
    assert pending.activate == ("lidar",)  # what the old plan did already is not done again
    assert all(kb.is_component_active(name) for name in ("rotors", "autopilot", "damper"))


@pytest.mark.parametrize("changing_call", [("activate", "lidar"), ("deactivate", "camera")])
def test_when_a_call_itself_changes_the_selection_the_robot_ends_up_as_last_selected(
    kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop, changing_call: tuple[str, str]
) -> None:
    def change_mind(call: tuple[Any, ...]) -> None:
        if call == changing_call:
            robot.during_call = lambda call: None
            kb.select_configuration(["see by camera"], ["sharp"])

    kb.request_action("deliver")
    robot.during_call = change_mind
    kb.select_configuration(["see by lidar"], [])
    assert kb.selected_function_design("see") == "see by camera"
    assert robot.running == {"autopilot", "camera"}
    assert kb.status("action", "deliver") is Status.SOLVED


def test_news_that_come_in_during_a_call_are_dealt_with_after_the_plan(
    kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop
) -> None:
    def fail_during(call: tuple[Any, ...]) -> None:
        if call == ("activate", "camera"):
            kb.set_component_failure("camera")

    robot.during_call = fail_during
    kb.request_action("deliver")
    assert results(kb) == ["completed", "completed"]
    assert robot.running == {"autopilot", "lidar"}


def test_what_the_knowledge_base_believes_to_run_is_what_runs(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    nodes = {"autopilot", "damper", "camera", "lidar", "beacon"}
    with AdaptationLoop(kb, robot):
        kb.request_action("deliver")
        for wind, light, broken in [(9, 20, "lidar"), (1, 3, "damper"), (9, 80, "camera"), (3, 60, "")]:
            robot.broken = {broken}
            kb.add_measurement("wind", wind)
            kb.add_measurement("light", light)
            assert {name for name in nodes if kb.is_component_active(name)} == robot.running


def test_a_closed_loop_adapts_no_longer(kb: KnowledgeBase, robot: PretendedRobot, loop: AdaptationLoop) -> None:
    kb.request_action("hover")
    loop.close()
    kb.add_measurement("wind", 9)
    kb.request_action("deliver")
    assert robot.running == {"autopilot"}
    assert kb.selected_function_design("fly") == "fly fast"


def test_a_loop_closed_while_an_event_is_delivered_does_not_act_on_it(kb: KnowledgeBase, robot: PretendedRobot) -> None:
    loops: list[AdaptationLoop] = []
    kb.subscribe(lambda event: loops[0].close(), [ActionUpdate])
    loops.append(AdaptationLoop(kb, robot))
    kb.request_action("hover")
    assert kb.selected_function_design("fly") is None
    assert robot.calls == []


def test_the_loop_tells_its_story_in_events(kb: KnowledgeBase, loop: AdaptationLoop) -> None:
    events: list[Event] = heard(kb, ActionUpdate, MonitoringData, ReconfigurationPlanCreated, ComponentActivity)
    kb.request_action("hover")
    kb.add_measurement("wind", 10)
    assert [type(event) for event in events] == [
        ActionUpdate,
        ReconfigurationPlanCreated,
        ComponentActivity,
        MonitoringData,
        ReconfigurationPlanCreated,
        ComponentActivity,
    ]


def test_the_same_inputs_give_the_same_run(clock: SimulationClock) -> None:
    def run() -> list[Event]:
        model = knowledge_model.__wrapped__(_MANY)
        kb = KnowledgeBase(model, SimulationClock())
        events = heard(kb)
        with AdaptationLoop(kb, PretendedRobot(broken=("c3",))):
            for action in range(3):
                kb.request_action(f"a{action}")
            kb.set_component_failure("c5")
            kb.add_measurement("m", 1)
        return events

    assert run() == run()


_MANY = "measures: {m: }\n" + "\n".join(
    [
        "actions: {" + ", ".join(f"a{n}: {{requires: [f{n}, f{n + 1}]}}" for n in range(4)) + "}",
        "functions: {" + ", ".join(f"f{n}: " for n in range(5)) + "}",
        "components: {" + ", ".join(f"c{n}: {{type: ros_node}}" for n in range(10)) + "}",
        "function_designs:",
        *(f"  d{n}: {{function: f{n % 5}, components: [c{n}, c{(n * 3 + 1) % 10}]}}" for n in (0, 1, 2, 3, 4, 6, 7, 8)),
    ]
)
