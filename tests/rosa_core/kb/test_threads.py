"""Any thread may write: one write after the other, events in their order, subscribers that disturb nobody, an end."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from rosa_core import (
    KnowledgeBase,
    KnowledgeBaseError,
    SimulationClock,
)
from rosa_core.kb import (
    Event,
    EventsDroppedError,
    MonitoringData,
    StatusesChanged,
    SynchronousDispatcher,
    ThreadedDispatcher,
)
from rosa_core.mape import AdaptationLoop
from rosa_core.model.elements import Component, ElementKind, FunctionDesign
from tests.hang_limit import HANG_LIMIT
from tests.rosa_core.journal.writes import STATUS_KINDS, picture, robot
from tests.rosa_core.kb.threads_kit import DISPATCHES, RecordingSystem, make, together, values

pytestmark = pytest.mark.usefixtures("impatient_threads")


# -- order --


@pytest.mark.parametrize("dispatch", DISPATCHES)
def test_events_arrive_in_the_order_of_the_writes(dispatch: str) -> None:
    heard: list[list[Event]] = [[], [], []]
    with make(dispatch) as kb:
        for events in heard:
            kb.subscribe(events.append)

        def write(thread: int) -> None:
            for index in range(200):
                kb.add_measurement("tick", thread * 1000 + index)

        together(lambda thread=thread: write(thread) for thread in range(8))
    revisions = [event.revision for event in heard[0]]
    assert revisions == sorted(revisions)
    assert len(values(heard[0])) == 1600
    for thread in range(8):
        of_thread = [value for value in values(heard[0]) if value // 1000 == thread]
        assert of_thread == sorted(of_thread)
    assert heard[1] == heard[0]
    assert heard[2] == heard[0]
    assert tuple(values(heard[0])) == tuple(m.value for m in kb.history("measurements"))  # type: ignore[union-attr]


@pytest.mark.parametrize("dispatch", DISPATCHES)
def test_statuses_followed_by_events_are_the_real_ones_at_the_end(dispatch: str) -> None:
    with make(dispatch) as kb:
        known = dict(kb.statuses("action"))

        def follow(event: Event) -> None:
            assert isinstance(event, StatusesChanged)
            for change in event.changes:
                if change.kind is ElementKind.ACTION:
                    assert known[change.name] is change.old
                    known[change.name] = change.new

        kb.subscribe(follow, [StatusesChanged])

        def write(thread: int) -> None:
            for index in range(150):
                kb.add_measurement("battery", (index + thread) % 2)
                (kb.set_component_failure if (index + thread) % 3 else kb.clear_component_failure)("camera")

        together(lambda thread=thread: write(thread) for thread in range(6))
    assert known == kb.statuses("action")


# -- subscribers --


def test_a_slow_subscriber_blocks_neither_writers_nor_others() -> None:
    go_on, all_heard, heard, slow = threading.Event(), threading.Event(), [], []

    def wait(event: Event) -> None:
        go_on.wait(HANG_LIMIT)
        slow.append(event)

    def hear(event: Event) -> None:
        heard.append(event)
        if len(heard) == 100:
            all_heard.set()

    with make() as kb:
        kb.subscribe(wait, [MonitoringData])
        kb.subscribe(hear, [MonitoringData])
        for index in range(100):
            kb.add_measurement("tick", index)
        assert all_heard.wait(HANG_LIMIT)
        assert not slow
        go_on.set()
    assert values(slow) == [float(index) for index in range(100)]


@pytest.mark.parametrize("dispatch", DISPATCHES)
def test_a_raising_subscriber_is_reported_and_the_others_hear_all(dispatch: str) -> None:
    reported, heard = [], []

    def fail(event: Event) -> None:
        raise ValueError("no")

    def report(error: BaseException, subscriber: object, event: Event) -> None:
        reported.append((str(error), subscriber, event))

    with make(dispatch, on_subscriber_error=report) as kb:
        kb.subscribe(fail, [MonitoringData])
        kb.subscribe(heard.append, [MonitoringData])
        for index in range(5):
            kb.add_measurement("tick", index)
    assert len(heard) == 5
    assert [(text, subscriber) for text, subscriber, _ in reported] == [("no", fail)] * 5


def test_a_subscriber_that_ends_its_thread_still_hears_the_rest(caplog: pytest.LogCaptureFixture) -> None:
    heard = []

    def leave(event: Event) -> None:
        heard.append(event)
        raise SystemExit

    with make() as kb:
        kb.subscribe(leave, [MonitoringData])
        kb.add_measurement("tick", 1)
        kb.add_measurement("tick", 2)
    assert values(heard) == [1, 2]
    assert "raised" in caplog.text


def test_an_error_in_the_error_handler_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    def fail(*_: object) -> None:
        raise ValueError("no")

    with make(on_subscriber_error=fail) as kb:
        kb.subscribe(fail)
        kb.add_measurement("tick", 1)
    assert "reporting an error" in caplog.text


@pytest.mark.parametrize("dispatch", DISPATCHES)
def test_subscribers_may_write_while_others_do(dispatch: str) -> None:
    """What each hears, each answers with a write: the writers and the subscribers all want the same lock."""
    with make(dispatch) as kb:

        def answer(measure: str) -> Callable[[Event], None]:
            def write(event: Event) -> None:
                if any(value < 1000 for value in values([event])):
                    with kb.transaction():
                        kb.add_measurement(measure, 1000 + event.revision)
                        kb.status("action", "explore")

            return write

        for measure in ("battery", "light", "battery"):
            kb.subscribe(answer(measure), [MonitoringData])
        together(lambda: [kb.add_measurement("tick", index) for index in range(100)] for _ in range(6))
    assert len(kb.history("measurements", "tick")) == 600
    assert len(kb.history("measurements", "light")) == 600
    assert len(kb.history("measurements", "battery")) == 1200


def test_a_subscriber_that_falls_far_behind_loses_the_oldest_and_is_reported() -> None:
    go_on, heard = threading.Event(), []
    reported: list[Any] = []
    started = threading.Event()

    def wait(event: Event) -> None:
        started.set()
        go_on.wait(HANG_LIMIT)
        heard.append(event)

    def report(error: BaseException, _subscriber: object, _event: Event) -> None:
        reported.append(error)

    with make(ThreadedDispatcher(report, capacity=10)) as kb:
        kb.subscribe(wait, [MonitoringData])
        kb.add_measurement("tick", 0)
        assert started.wait(HANG_LIMIT)
        for index in range(1, 51):
            kb.add_measurement("tick", index)
        go_on.set()
    assert values(heard) == [0, *range(41, 51)]
    assert all(isinstance(error, EventsDroppedError) for error in reported)
    assert [(error.dropped, error.caught_up) for error in reported] == [(40, False), (40, True)]
    assert "more than 10 events waited: 40 were dropped" in str(reported[0])


def test_after_unsubscribing_nothing_more_is_heard() -> None:
    heard = []
    with make() as kb:
        unsubscribe = kb.subscribe(heard.append, [MonitoringData])
        kb.add_measurement("tick", 1)
        kb._dispatcher.drain(HANG_LIMIT)
        unsubscribe()
        unsubscribe()
        kb.add_measurement("tick", 2)
    assert values(heard) == [1]


def test_a_subscriber_may_unsubscribe_itself() -> None:
    heard: list[Event] = []
    with make() as kb:

        def once(event: Event) -> None:
            heard.append(event)
            unsubscribe()

        unsubscribe = kb.subscribe(once, [MonitoringData])
        for index in range(3):
            kb.add_measurement("tick", index)
    assert len(heard) == 1


def test_subscribers_come_and_go_while_others_write() -> None:
    with make() as kb:

        def come_and_go() -> None:
            for _ in range(50):
                kb.subscribe(lambda event: None)()

        together([come_and_go, come_and_go, *[lambda: [kb.add_measurement("tick", i) for i in range(200)]] * 3])
        assert kb.revision == 600
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("rosa subscriber")]


# -- consistent reading --


QUESTIONS: dict[str, Callable[[KnowledgeBase], object]] = {
    "revision": lambda kb: kb.revision,
    "model": lambda kb: kb.model,
    "query": lambda kb: kb.query("match $c isa Component, has name $name, has status $status; get $name, $status;"),
    "measurement": lambda kb: kb.measurement("battery"),
    "selectable_actions": lambda kb: kb.selectable_actions(),
    "is_action_feasible": lambda kb: kb.is_action_feasible("explore"),
    "required_components": lambda kb: kb.required_components(),
    "alternatives": lambda kb: kb.alternatives("explore"),
    "configurations": lambda kb: list(kb.configurations("explore")),
    "required_actions": lambda kb: kb.required_actions(),
    "adaptable_functions": lambda kb: kb.adaptable_functions(),
    "adaptable_components": lambda kb: kb.adaptable_components(),
    "selectable_function_designs": lambda kb: kb.selectable_function_designs("see"),
    "function_design_priority": lambda kb: kb.function_design_priority("look"),
    "selectable_component_configurations": lambda kb: kb.selectable_component_configurations("wheels"),
    "component_configuration_priority": lambda kb: kb.component_configuration_priority("fast"),
    "selected_function_design": lambda kb: kb.selected_function_design("see"),
    "selected_component_configuration": lambda kb: kb.selected_component_configuration("wheels"),
    "pending_reconfiguration_plan": lambda kb: kb.pending_reconfiguration_plan(),
    "is_component_active": lambda kb: kb.is_component_active("motor"),
    "component_type": lambda kb: kb.component_type("camera"),
    "configured_component": lambda kb: kb.configured_component("fast"),
    "component_parameters": lambda kb: kb.component_parameters("fast"),
    "components_to_reconfigure": lambda kb: kb.components_to_reconfigure(["motor", "legs"]),
    "status": lambda kb: kb.status("action", "explore"),
    "statuses": lambda kb: kb.statuses("component"),
    "constraints": lambda kb: kb.constraints(),
    "explain": lambda kb: str(kb.explain("component", "camera")),
    "why": lambda kb: kb.why("component", "camera"),
    "history": lambda kb: kb.history("measurements"),
}
WRITES = {"add_measurement", "set_component_failure", "clear_component_failure", "request_action", "cancel_action"}
WRITES |= {"finish_action", "select_configuration", "set_reconfiguration_result", "set_component_active"}
WRITES |= {"replan", "suppose", "supposing", "add_elements", "remove_elements", "transaction", "subscribe", "close"}


@pytest.mark.parametrize("question", QUESTIONS)
def test_nobody_sees_half_a_transaction(question: str) -> None:
    """Asked by another thread in the middle of a transaction, each question waits for the state after it."""
    kb = make("synchronous")
    answers: list[object] = []
    asking = threading.Thread(target=lambda: answers.append(QUESTIONS[question](kb)))
    with kb.transaction():
        for change in (
            lambda: kb.add_measurement("battery", 0.1),
            lambda: kb.set_component_failure("camera"),
            lambda: kb.set_component_active("motor", True),
            lambda: kb.add_elements(Component("lidar")),
            lambda: kb.request_action("charge"),
            lambda: kb.select_configuration(["walk"], []),
        ):
            change()
            if not asking.ident:
                asking.start()
            asking.join(0.005)
            assert asking.is_alive(), f"{question} was answered from half a transaction: {answers}"
    asking.join(HANG_LIMIT)
    assert answers == [QUESTIONS[question](kb)]


def test_every_question_is_among_those() -> None:
    public = {name for name in dir(KnowledgeBase) if not name.startswith("_")}
    assert public - WRITES == set(QUESTIONS)


def test_events_are_announced_while_writes_are_locked_out() -> None:
    """Their order could not be that of the writes otherwise."""

    class Suspicious(SynchronousDispatcher):
        def announce(self, events: Iterable[Event]) -> None:
            other = threading.Thread(target=kb.add_measurement, args=("tick", 1))
            if len(others) < 3:
                others.append(other)
                other.start()
                other.join(0.02)
                assert other.is_alive()
            super().announce(events)

    others: list[threading.Thread] = []
    kb = make(Suspicious())
    kb.add_measurement("tick", 0)
    for other in others:
        other.join(HANG_LIMIT)
    assert kb.revision == 4


def test_several_questions_in_a_transaction_are_answered_from_one_state() -> None:
    kb = make("synchronous")
    stop = threading.Event()

    def write() -> None:
        for index in range(500):
            kb.add_measurement("battery", index % 2)
        stop.set()

    def read() -> None:
        while not stop.is_set():
            with kb.transaction():
                low = (kb.measurement("battery") or kb.history("measurements")[0]).value == 0
                assert kb.is_action_feasible("explore") is not low

    kb.add_measurement("battery", 1)
    together([write, read, read])


@pytest.mark.parametrize("dispatch", DISPATCHES)
def test_many_threads_do_everything_at_once(dispatch: str, tmp_path: Path) -> None:
    path = tmp_path / "kb"
    kb = KnowledgeBase(robot(), SimulationClock(), path, dispatch=dispatch)  # type: ignore[arg-type]
    problems: list[BaseException] = []

    def grow(name: str) -> None:
        for _ in range(15):
            kb.add_elements(Component(name), FunctionDesign(name, "see", (name,)))
            with suppress(KnowledgeBaseError):
                kb.set_component_failure(name)
            with kb.transaction():
                kb.set_component_active(name, False)
                kb.remove_elements(FunctionDesign(name, "see", (name,)), Component(name))

    def work() -> None:
        for index in range(60):
            with suppress(KnowledgeBaseError):
                kb.request_action("explore" if index % 2 else "charge")
            kb.add_measurement("battery", (index % 10) / 10)
            kb.cancel_action("charge")
            with suppress(KnowledgeBaseError):
                kb.set_component_failure("new" if index % 2 else "camera")
            kb.clear_component_failure("camera")

    def read() -> None:
        for _ in range(60):
            for kind in STATUS_KINDS:
                for name in kb.statuses(kind):
                    with suppress(KnowledgeBaseError):  # it may be gone by now
                        str(kb.explain(kind, name))
            kb.history("measurements", limit=20_000)

    loop = AdaptationLoop(kb, RecordingSystem())
    kb.subscribe(lambda event: problems.append(KeyError()) if event.revision > kb.revision else None)
    together([lambda: grow("new"), lambda: grow("newer"), work, work, work, read])
    kb.close()
    loop.close()
    assert not problems
    last = picture(kb)
    with KnowledgeBase(robot(), SimulationClock(), path) as again:
        assert picture(again) == last
