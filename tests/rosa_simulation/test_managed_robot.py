"""A simulated robot with ROSA as its managing system."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from rosa_core import KnowledgeModel, SimulationClock
from rosa_core.clock import Stopwatch
from rosa_core.kb import Event
from rosa_core.mape.diagnostics import DiagnosticArray, diagnostic
from rosa_core.model.elements import ParameterValue
from rosa_simulation.managed_robot import knowledge_base_for
from tests.conftest import SUAVE, SUAVE_EXTENDED


class Robot:
    """Writes down what is called."""

    def __init__(self) -> None:
        self.clock = SimulationClock()
        self.on_diagnostics: list[Callable[[DiagnosticArray], None]] = []
        self.calls: list[tuple[str, str]] = []

    def activate(self, component: str) -> None:
        self.calls.append(("activate", component))

    def deactivate(self, component: str) -> None:
        self.calls.append(("deactivate", component))

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> None:
        self.calls.append(("set", component))

    def publish(self, array: DiagnosticArray) -> None:
        for subscriber in self.on_diagnostics:
            subscriber(array)


def test_diagnostics_become_reconfigurations_and_events_and_cost_time() -> None:
    robot, stopwatch, events = Robot(), Stopwatch(), []
    kb = knowledge_base_for(
        robot, KnowledgeModel.load(SUAVE, SUAVE_EXTENDED), stopwatch=stopwatch, on_event=events.append
    )
    kb.request_action("search_pipeline")
    robot.calls.clear()
    events.clear()
    robot.publish(diagnostic(0.0, "monitor", "Component status", "c_thruster_1", "FALSE"))
    assert ("activate", "f_maintain_motion_node") in robot.calls
    assert events
    assert stopwatch.elapsed() > 0.0


def test_an_error_in_who_listens_is_not_passed_over() -> None:
    def raises(_event: Event) -> None:
        raise LookupError("lost")

    kb = knowledge_base_for(Robot(), KnowledgeModel.load(SUAVE, SUAVE_EXTENDED), stopwatch=Stopwatch(), on_event=raises)
    with pytest.raises(LookupError, match="lost"):
        kb.request_action("search_pipeline")
