"""Calls that block, made in threads: nobody waits for anybody else, and the order of one component is kept."""

from __future__ import annotations

import threading
from collections.abc import Mapping

from rosa_core import KnowledgeBase, Status, WallClock
from rosa_core.mape import AdaptationLoop, ComponentState, InThreads, Limits
from rosa_core.model.elements import ParameterValue
from tests.rosa_core.sample_models import DRONE, knowledge_model

SOON = 20.0


class Meeting:
    """Starts two components only when both are being started: one after the other would never come to an end."""

    def __init__(self) -> None:
        self.both = threading.Barrier(2, timeout=SOON)
        self.calls: list[tuple[str, str]] = []

    def activate(self, component: str) -> None:
        self.calls.append(("activate", component))
        self.both.wait()

    def deactivate(self, component: str) -> None:
        self.calls.append(("deactivate", component))

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> None:
        self.calls.append(("set_parameters", component))


def test_components_are_changed_at_the_same_time_each_in_its_order() -> None:
    system = Meeting()
    with KnowledgeBase(knowledge_model(DRONE), WallClock()) as kb, AdaptationLoop(kb, InThreads(system)):
        kb.request_action("deliver")
        assert kb.status("action", "deliver") is Status.SOLVED
    assert [call for call, component in system.calls if component == "camera"] == ["set_parameters", "activate"]


class Deaf:
    """Never comes back from starting the camera."""

    def __init__(self) -> None:
        self.never = threading.Event()

    def activate(self, component: str) -> None:
        if component == "camera":
            self.never.wait(SOON)

    def deactivate(self, component: str) -> None: ...

    def set_parameters(self, component: str, parameters: Mapping[str, ParameterValue]) -> None: ...


def test_a_call_that_does_not_come_back_is_given_up_and_another_design_taken() -> None:
    system = Deaf()
    adapter = InThreads(system)
    limits = {"camera": Limits(activation=0.05, attempts=2)}
    with KnowledgeBase(knowledge_model(DRONE), WallClock()) as kb, AdaptationLoop(kb, adapter, limits=limits):
        kb.request_action("deliver")
        assert kb.status("component", "camera") is Status.FAILURE
        assert kb.status("action", "deliver") is Status.SOLVED
        assert kb.is_component_active("lidar")
        assert adapter.state("camera") is ComponentState.UNKNOWN
    system.never.set()


def test_a_call_that_raises_or_says_no_changes_no_state() -> None:
    class Broken(Deaf):
        def activate(self, component: str) -> None:
            raise OSError("no")

    adapter = InThreads(Broken())
    answered = threading.Event()
    adapter.subscribe(lambda component: answered.set())
    assert isinstance(adapter.activate("camera").exception(SOON), OSError)
    assert answered.wait(SOON)
    assert adapter.state("camera") is ComponentState.INACTIVE
