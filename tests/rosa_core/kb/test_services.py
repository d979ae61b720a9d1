"""Every service of the ROSA paper's table 5 has its method; a test each, on the SUAVE model."""

from __future__ import annotations

import pytest

from rosa_core import KnowledgeBase, KnowledgeModel, Result, SimulationClock, Status
from rosa_core.kb import Event, MonitoringData, ReconfigurationPlanCreated
from rosa_core.mape import DiagnosticsMonitor

SEARCH = "generate spiral search path function design"


@pytest.fixture
def kb(extended_model: KnowledgeModel) -> KnowledgeBase:
    """The knowledge base of the extended SUAVE mission."""
    return KnowledgeBase(extended_model, clock=SimulationClock())


def search(kb: KnowledgeBase) -> None:
    """Search at the high altitude, with healthy thrusters."""
    kb.request_action("search_pipeline")
    plan = kb.select_configuration([SEARCH, "fd_recover_motion_inactive"], ["high altitude"])
    assert plan is not None
    for component in plan.activate:
        kb.set_component_active(component, True)
    kb.set_reconfiguration_result(plan, "completed")


def test_events(kb: KnowledgeBase) -> None:
    heard: list[Event] = []
    unsubscribe = kb.subscribe(heard.append)
    kb.add_measurement("battery_level", 0.9)
    unsubscribe()
    kb.add_measurement("battery_level", 0.8)
    assert isinstance(heard[0], MonitoringData)
    assert {event.revision for event in heard} == {1}


def test_diagnostics(kb: KnowledgeBase) -> None:
    values = [{"key": "c_thruster_1", "value": "FALSE"}]
    DiagnosticsMonitor(kb).update({"status": [{"message": "Component status", "values": values}]})
    assert kb.status("component", "c_thruster_1") is Status.FAILURE


def test_function_adaptable(kb: KnowledgeBase) -> None:
    assert kb.adaptable_functions() == []
    kb.request_action("search_pipeline")
    assert kb.adaptable_functions() == ["generate search path", "recover motion"]
    search(kb)
    assert kb.adaptable_functions() == ["recover motion"]  # solved, but always to be improved


def test_component_adaptable(kb: KnowledgeBase) -> None:
    assert kb.adaptable_components() == []
    assert kb.adaptable_components(["fd_recover_motion"]) == ["f_maintain_motion_node"]
    search(kb)
    assert kb.adaptable_components() == ["f_generate_search_path_node"]


def test_function_designs_selectable_and_priority(kb: KnowledgeBase) -> None:
    designs = kb.selectable_function_designs("recover motion")
    assert [(name, kb.function_design_priority(name)) for name in designs] == [
        ("fd_recover_motion_inactive", 1),
        ("fd_recover_motion", 2),
    ]
    kb.set_component_failure("c_thruster_4")
    assert kb.selectable_function_designs("recover motion") == ["fd_recover_motion"]
    assert kb.function_design_priority(SEARCH) is None


def test_component_configuration_selectable_and_priority(kb: KnowledgeBase) -> None:
    kb.add_measurement("water_visibility", 3.0)
    configurations = kb.selectable_component_configurations("f_generate_search_path_node")
    assert [(name, kb.component_configuration_priority(name)) for name in configurations] == [
        ("low altitude", 3),
        ("medium altitude", 2),
    ]


def test_select_configuration(kb: KnowledgeBase) -> None:
    heard: list[Event] = []
    kb.subscribe(heard.append, (ReconfigurationPlanCreated,))
    kb.request_action("recharge")
    plan = kb.select_configuration(["fd_recover_motion", "generate recharge path function design"], [])
    assert plan is not None
    assert plan.activate == ("f_maintain_motion_node", "generate_recharge_path_node")
    assert [event.plan for event in heard] == [plan]  # type: ignore[attr-defined]


def test_reconfiguration_plan_get_latest_and_result_set(kb: KnowledgeBase) -> None:
    assert kb.pending_reconfiguration_plan() is None
    kb.request_action("inspect_pipeline")
    plan = kb.select_configuration(["follow pipeline function design"], [])
    assert plan is not None
    assert kb.pending_reconfiguration_plan() == plan
    assert kb.set_reconfiguration_result(plan, Result.COMPLETED)
    assert kb.pending_reconfiguration_plan() is None
    assert [ended.result for ended in kb.history("reconfiguration_plans")] == [Result.COMPLETED]


def test_component_active_set(kb: KnowledgeBase) -> None:
    kb.request_action("inspect_pipeline")
    kb.select_configuration(["follow pipeline function design", "fd_recover_motion"], [])
    assert kb.status("component", "f_follow_pipeline_node") is Status.UNSOLVED
    kb.set_component_active("f_follow_pipeline_node", True)
    assert kb.status("component", "f_follow_pipeline_node") is Status.SOLVED


def test_component_parameters_get(kb: KnowledgeBase) -> None:
    assert kb.component_parameters("medium altitude") == {"spiral_altitude": 2.0}


def test_action_selectable(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery_level", 0.2)
    assert kb.selectable_actions() == ["recharge"]


def test_action_request(kb: KnowledgeBase) -> None:
    search(kb)
    assert kb.status("action", "search_pipeline") is Status.SOLVED
    ended = kb.finish_action("search_pipeline")
    assert ended is not None
    assert ended.result is Result.COMPLETED
    assert kb.status("action", "search_pipeline") is Status.FEASIBLE


def test_query(kb: KnowledgeBase) -> None:
    kb.add_measurement("battery_level", 0.2)
    listing_3 = "match $a isa Action, has name $name;\nnot {$a has status 'unfeasible';};\nfetch $name;\n"
    assert kb.query(listing_3) == [{"name": "recharge"}]
