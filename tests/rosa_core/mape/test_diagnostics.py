"""Diagnostics that robots without ROS publish are those that the monitor reads."""

from __future__ import annotations

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock, Status
from rosa_core.mape import DiagnosticsMonitor
from rosa_core.mape.diagnostics import diagnostic, values_of
from tests.conftest import SUAVE, SUAVE_EXTENDED


def test_what_is_published_is_understood() -> None:
    kb = KnowledgeBase(KnowledgeModel.load(SUAVE, SUAVE_EXTENDED), clock=SimulationClock())
    monitor = DiagnosticsMonitor(kb)
    level = monitor.update(diagnostic(2.5, "battery_monitor", "QA measurement", "battery_level", "0.2"))
    failed = monitor.update(diagnostic(3.0, "thruster_monitor", "Component status", "c_thruster_1", "FALSE"))
    assert level.written == failed.written == 1
    measured = kb.measurement("battery_level")
    assert measured is not None
    assert (measured.value, measured.time) == (0.2, 2.5)
    assert kb.status("component", "c_thruster_1") is Status.FAILURE


def test_the_values_of_an_array_come_in_order_with_their_message() -> None:
    array = diagnostic(1.0, "m", "QA measurement", "a", "1")
    array["status"] += diagnostic(1.0, "n", "Component status", "b", "FALSE")["status"]
    array["status"][0]["values"].append({"key": "c", "value": "2"})
    assert list(values_of(array)) == [
        ("a", "1", "QA measurement"),
        ("c", "2", "QA measurement"),
        ("b", "FALSE", "Component status"),
    ]
    assert list(values_of({"header": {"stamp": 0.0}, "status": []})) == []
