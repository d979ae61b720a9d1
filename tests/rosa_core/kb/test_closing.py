"""The end of a knowledge base, and the choice of its dispatcher."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import pytest

from rosa_core import (
    InvalidValueError,
    KnowledgeBase,
    KnowledgeBaseClosedError,
    KnowledgeBaseError,
    Result,
    SimulationClock,
    Status,
)
from rosa_core.kb import (
    Event,
    MonitoringData,
    SynchronousDispatcher,
    ThreadedDispatcher,
)
from rosa_core.mape import AdaptationLoop
from tests.hang_limit import HANG_LIMIT
from tests.rosa_core.journal.writes import picture, robot
from tests.rosa_core.kb.threads_kit import DISPATCHES, RecordingSystem, make, together, values

pytestmark = pytest.mark.usefixtures("impatient_threads")

# -- the end --


@contextmanager
def closing(kb: KnowledgeBase) -> Iterator[None]:
    """Another thread closes the knowledge base; inside the block it has begun to, and at its end it is done."""
    closer = threading.Thread(target=kb.close, args=(HANG_LIMIT,))
    closer.start()
    with suppress(KnowledgeBaseClosedError):
        while closer.is_alive():
            kb.clear_component_failure("camera")  # changes nothing, but is refused too
    yield
    closer.join(HANG_LIMIT)
    assert not closer.is_alive()


@pytest.mark.parametrize("dispatch", DISPATCHES)
def test_a_closed_knowledge_base_refuses_writes_and_answers_questions(dispatch: str) -> None:
    kb = make(dispatch)
    kb.add_measurement("battery", 0.1)
    kb.close()
    kb.close()
    before = picture(kb)
    with pytest.raises(KnowledgeBaseClosedError, match="closed"):
        kb.add_measurement("battery", 0.9)
    with pytest.raises(KnowledgeBaseClosedError):
        kb.remove_elements(*kb.model.constraints)
    assert picture(kb) == before
    kb.subscribe(lambda event: None)
    assert not kb.is_action_feasible("explore")


@pytest.mark.parametrize("dispatch", DISPATCHES)
def test_closing_waits_until_everything_is_heard_and_answered(dispatch: str) -> None:
    """A chain of subscribers, each of which answers the one before: what they write still belongs to the last write."""
    kb, heard, go_on = make(dispatch), [], threading.Event()
    if dispatch == "synchronous":
        go_on.set()

    def answer(event: Event) -> None:
        go_on.wait(HANG_LIMIT)
        heard.append(values([event])[0])
        if heard[-1] < 5:
            kb.add_measurement("tick", heard[-1] + 1)

    kb.subscribe(answer, [MonitoringData])
    kb.add_measurement("tick", 0)
    if dispatch == "threads":
        with closing(kb):
            assert heard == []
            go_on.set()
    kb.close()
    assert heard == [0, 1, 2, 3, 4, 5]


def test_while_closing_only_subscribers_write() -> None:
    kb, go_on = make(), threading.Event()
    kb.subscribe(lambda event: go_on.wait(HANG_LIMIT))
    kb.add_measurement("tick", 1)
    with closing(kb):
        with pytest.raises(KnowledgeBaseClosedError):
            kb.add_measurement("tick", 2)
        go_on.set()
    assert kb.revision == 1


def test_closing_does_not_wait_for_ever(caplog: pytest.LogCaptureFixture) -> None:
    kb, begun, go_on, returned = make(), threading.Event(), threading.Event(), []

    def be_busy(event: Event) -> None:
        begun.set()
        go_on.wait(HANG_LIMIT)
        returned.append(event)

    kb.subscribe(be_busy, [MonitoringData])
    for index in range(5):
        kb.add_measurement("tick", index)
    assert begun.wait(HANG_LIMIT)
    kb.close(timeout=0.05)
    assert not returned
    assert "4 events not delivered" in caplog.text
    assert "left behind" in caplog.text
    go_on.set()


@pytest.mark.parametrize("dispatch", DISPATCHES)
def test_a_subscriber_may_close(dispatch: str) -> None:
    kb, closed = make(dispatch), threading.Event()

    def end(event: Event) -> None:
        kb.close()
        closed.set()

    kb.subscribe(end, [MonitoringData])
    kb.add_measurement("tick", 1)
    assert closed.wait(HANG_LIMIT)
    with pytest.raises(KnowledgeBaseClosedError):
        kb.add_measurement("tick", 2)


def test_it_cannot_be_closed_within_a_transaction() -> None:
    kb = make()
    with kb.transaction():
        kb.add_measurement("tick", 1)
        with pytest.raises(KnowledgeBaseError, match="within a transaction"):
            kb.close()
    assert kb.revision == 1
    kb.close()


def test_many_threads_may_close() -> None:
    kb, go_on = make(), threading.Event()
    kb.subscribe(lambda event: go_on.wait(HANG_LIMIT))
    for index in range(20):
        kb.add_measurement("tick", index)
    together([*[kb.close] * 5, go_on.set])
    assert kb.revision == 20


def test_the_context_manager_closes_also_after_an_error() -> None:
    kb = make()
    with suppress(ZeroDivisionError), kb:
        raise ZeroDivisionError
    with pytest.raises(KnowledgeBaseClosedError):
        kb.add_measurement("tick", 1)


# -- which dispatcher --


def test_dispatch_is_a_name_or_a_dispatcher() -> None:
    with pytest.raises(InvalidValueError, match="'synchronous', 'threads' or a Dispatcher, not 'later'"):
        make("later")
    with pytest.raises(InvalidValueError, match="capacity"):
        ThreadedDispatcher(capacity=0)
    heard: list[Event] = []
    with make(SynchronousDispatcher()) as kb:
        kb.subscribe(heard.append)
        kb.add_measurement("tick", 1)
        assert len(heard) == 1


def test_synchronous_delivery_is_the_default_and_within_the_write() -> None:
    kb, heard = KnowledgeBase(robot(), SimulationClock()), []
    kb.subscribe(lambda event: heard.append(threading.current_thread()))
    kb.add_measurement("tick", 1)
    assert heard == [threading.current_thread()]


def test_the_adaptation_loop_works_in_threads() -> None:
    system = RecordingSystem()
    kb = make()
    with AdaptationLoop(kb, system):
        kb.add_measurement("light", 0.5)
        kb.add_measurement("battery", 1.0)
        kb.request_action("explore")
        assert kb._dispatcher.drain(HANG_LIMIT)
        assert kb.status("action", "explore") is Status.SOLVED
        kb.set_component_failure("wheels")
        assert kb._dispatcher.drain(HANG_LIMIT)
        assert kb.selected_function_design("move") == "walk"
        assert kb.status("action", "explore") is Status.SOLVED
        kb.close()
    assert sorted(system.running) == ["camera", "legs"]
    assert [plan.result for plan in kb.history("reconfiguration_plans")] == [Result.COMPLETED] * 2  # type: ignore[union-attr]
