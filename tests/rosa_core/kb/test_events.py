"""Who hears what, when and in which order; and transactions, which are heard of as one."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterable

import pytest

from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock, Status
from rosa_core.kb import (
    ActionUpdate,
    ComponentActivity,
    ConfigurationSelected,
    Event,
    MonitoringData,
    ReconfigurationPlanCreated,
    ReconfigurationPlanEnded,
    StatusChange,
    StatusesChanged,
)
from rosa_core.model import ElementKind
from tests.hang_limit import HANG_LIMIT
from tests.rosa_core.sample_models import heard, snapshot


class AbortedError(Exception):
    """What rolls a transaction back."""


def types(events: Iterable[Event]) -> list[type[Event]]:
    return [type(event) for event in events]


def test_a_measurement_is_announced_with_the_statuses_that_it_changed(
    kb: KnowledgeBase, clock: SimulationClock
) -> None:
    clock.advance_to(3)
    events = heard(kb)
    kb.add_measurement("wind", 9)
    data, changed = events
    assert isinstance(data, MonitoringData)
    assert isinstance(changed, StatusesChanged)
    assert [(event.revision, event.time) for event in events] == [(1, 3.0), (1, 3.0)]
    assert [(m.measure, m.value, m.time) for m in data.measurements] == [("wind", 9.0, 3.0)]
    assert changed.changes[1:] == (
        StatusChange(ElementKind.FUNCTION_DESIGN, "fly fast", Status.FEASIBLE, Status.UNFEASIBLE),
    )
    assert (changed.changes[0].kind, changed.changes[0].new) == (ElementKind.CONSTRAINT, Status.VIOLATED)


def test_what_is_announced_is_written_already(kb: KnowledgeBase) -> None:
    seen = []
    kb.subscribe(lambda event: seen.append((kb.revision, kb.status("component", "camera"))))
    kb.set_component_failure("camera")
    assert seen == [(1, Status.FAILURE), (1, Status.FAILURE)]


def test_every_write_that_changes_something_is_a_revision(kb: KnowledgeBase) -> None:
    kb.add_measurement("light", 60)
    kb.add_measurement("light", 60)
    kb.set_component_active("camera", True)
    kb.set_component_active("camera", True)
    kb.request_action("wait")
    assert kb.revision == 4


def test_within_a_write_events_come_in_the_order_in_which_the_loop_needs_them(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    kb.select_configuration(["fly fast"], [])
    events = heard(kb)
    with kb.transaction():
        kb.select_configuration(["fly gently"], [])
        kb.set_component_active("beacon", True)
        kb.request_action("deliver")
        kb.add_measurement("light", 60)
    assert types(events) == [
        MonitoringData,
        ActionUpdate,
        ConfigurationSelected,
        ComponentActivity,
        StatusesChanged,
        ReconfigurationPlanEnded,
        ReconfigurationPlanCreated,
    ]
    assert {event.revision for event in events} == {3}


def test_status_changes_come_from_constraints_up_to_actions(kb: KnowledgeBase) -> None:
    events = heard(kb, StatusesChanged)
    kb.set_component_failure("rotors")
    kinds = [change.kind for change in events[0].changes]
    assert kinds == ["component", "function_design", "function_design", "function", "action", "action"]


def test_status_changes_of_a_transaction_too_come_from_constraints_up_to_actions(kb: KnowledgeBase) -> None:
    events = heard(kb, StatusesChanged)
    with kb.transaction():
        kb.set_component_failure("rotors")
        kb.add_measurement("wind", 9)
        kb.add_measurement("light", 10)
    order = ["constraint", "component_configuration", "component", "function_design", "function", "action"]
    kinds = [change.kind for change in events[0].changes]
    assert kinds == sorted(kinds, key=order.index)


def test_a_subscriber_that_writes_is_heard_of_after_everybody_heard_the_present_event(kb: KnowledgeBase) -> None:
    received: list[tuple[str, int, str]] = []

    def first(event: Event) -> None:
        received.append(("first", event.revision, type(event).__name__))
        if isinstance(event, MonitoringData) and event.failures:
            kb.set_component_active("lidar", True)

    kb.subscribe(first)
    kb.subscribe(lambda event: received.append(("second", event.revision, type(event).__name__)))
    kb.set_component_failure("camera")
    assert received == [
        (who, revision, what)
        for revision, what in [(1, "MonitoringData"), (1, "StatusesChanged"), (2, "ComponentActivity")]
        for who in ("first", "second")
    ]


def test_a_chain_of_writes_by_subscribers_is_done_when_the_first_write_returns(kb: KnowledgeBase) -> None:
    heights: list[float] = []

    def count_up(event: Event) -> None:
        assert isinstance(event, MonitoringData)
        value = event.measurements[0].value
        heights.append(value)
        if value < 200:
            kb.add_measurement("light", value + 1)

    kb.subscribe(count_up, [MonitoringData])
    kb.add_measurement("light", 0)
    assert heights == list(range(201))


def test_a_subscriber_that_raises_is_reported_and_the_others_still_hear(
    drone: KnowledgeModel, clock: SimulationClock
) -> None:
    reported = []
    kb = KnowledgeBase(drone, clock, on_subscriber_error=lambda *report: reported.append(report))
    error = RuntimeError("no")

    def bad(event: Event) -> None:
        raise error

    kb.subscribe(bad)
    events = heard(kb)
    kb.add_measurement("light", 60)
    kb.request_action("wait")
    assert types(events) == [MonitoringData, StatusesChanged, ActionUpdate, StatusesChanged]
    assert reported == [(error, bad, event) for event in events]


def test_by_default_an_error_in_a_subscriber_is_logged(drone: KnowledgeModel, caplog: pytest.LogCaptureFixture) -> None:
    kb = KnowledgeBase(drone)

    def bad(event: Event) -> None:
        raise RuntimeError("no")

    kb.subscribe(bad)
    with caplog.at_level(logging.ERROR):
        kb.set_component_active("lidar", True)
    assert "ComponentActivity" in caplog.text
    assert "RuntimeError: no" in caplog.text
    assert kb.is_component_active("lidar")


def test_only_the_event_types_asked_for_are_heard(kb: KnowledgeBase) -> None:
    events, none = heard(kb, ActionUpdate, ComponentActivity), []
    kb.subscribe(none.append, [])
    kb.add_measurement("wind", 9)
    kb.request_action("hover")
    kb.set_component_active("rotors", True)
    assert types(events) == [ActionUpdate, ComponentActivity]
    assert none == []


def test_after_unsubscribing_nothing_more_is_heard(kb: KnowledgeBase) -> None:
    events: list[Event] = []
    unsubscribe = kb.subscribe(events.append)
    still = heard(kb)
    kb.set_component_active("rotors", True)
    unsubscribe()
    unsubscribe()
    kb.set_component_active("rotors", False)
    assert [event.revision for event in events] == [1]
    assert [event.revision for event in still] == [1, 2]


def test_one_callback_subscribed_twice_hears_twice_until_one_subscription_ends(kb: KnowledgeBase) -> None:
    events: list[Event] = []
    kb.subscribe(events.append)
    unsubscribe = kb.subscribe(events.append)
    kb.set_component_active("rotors", True)
    unsubscribe()
    kb.set_component_active("rotors", False)
    assert [event.revision for event in events] == [1, 1, 2]


# -- transactions --


def test_a_transaction_is_announced_as_one_write(kb: KnowledgeBase) -> None:
    events = heard(kb)
    with kb.transaction():
        kb.set_component_failure("camera")
        kb.set_component_failure("lidar")
        assert kb.status("function", "see") is Status.UNFEASIBLE
        assert events == []
    data, changed = events
    assert isinstance(data, MonitoringData)
    assert data.failures == ("camera", "lidar")
    assert len({change.name for change in changed.changes}) == len(changed.changes)
    assert kb.revision == 1


def test_what_is_done_and_undone_within_a_transaction_is_not_heard_of(kb: KnowledgeBase) -> None:
    kb.set_component_active("beacon", True)
    kb.set_component_failure("rotors")
    events = heard(kb)
    with kb.transaction():
        kb.set_component_failure("camera")
        kb.clear_component_failure("rotors")
        kb.set_component_active("lidar", True)
        kb.set_component_active("beacon", False)
        kb.set_component_active("beacon", True)
        kb.set_component_active("lidar", False)
        kb.set_component_failure("rotors")
        kb.clear_component_failure("camera")
    assert (events, kb.revision) == ([], 2)


def test_a_selection_within_a_transaction_is_heard_of_as_it_is_in_the_end(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    events = heard(kb, ConfigurationSelected)
    with kb.transaction():
        kb.select_configuration(["fly gently"], [])
        kb.select_configuration(["fly fast"], [])
        kb.select_configuration(["fly gently"], [])
    assert [event.function_designs for event in events] == [("fly gently",)]
    assert events[0].unselected_function_designs == ()


def test_a_plan_made_and_abandoned_within_a_transaction_is_not_heard_of(kb: KnowledgeBase) -> None:
    kb.request_action("hover")
    events = heard(kb, ReconfigurationPlanCreated, ReconfigurationPlanEnded)
    with kb.transaction():
        kb.select_configuration(["fly gently"], [])
        plan = kb.select_configuration(["fly fast"], [])
    assert [(type(event), event.plan) for event in events] == [(ReconfigurationPlanCreated, plan)]


def test_an_action_requested_and_cancelled_within_a_transaction_is_not_heard_of(kb: KnowledgeBase) -> None:
    events = heard(kb)
    with kb.transaction():
        kb.request_action("hover")
        kb.cancel_action("hover")
    assert events == []


def test_a_status_that_is_as_before_after_a_transaction_has_not_changed(kb: KnowledgeBase) -> None:
    events = heard(kb)
    with kb.transaction():
        kb.add_measurement("battery", 0.1)
        kb.add_measurement("battery", 0.9)
    data, changed = events
    assert isinstance(data, MonitoringData)
    assert [measurement.value for measurement in data.measurements] == [0.1, 0.9]
    assert [change.kind for change in changed.changes] == [ElementKind.CONSTRAINT]


def test_an_empty_transaction_is_no_write(kb: KnowledgeBase) -> None:
    events = heard(kb)
    with kb.transaction():
        pass
    assert (events, kb.revision) == ([], 0)


def test_a_transaction_that_raises_takes_everything_back(kb: KnowledgeBase) -> None:
    kb.request_action("deliver")
    plan = kb.select_configuration(["fly fast", "see by camera"], ["sharp"])
    kb.add_measurement("light", 60)
    before, events = snapshot(kb), heard(kb)

    def everything() -> None:
        with kb.transaction():
            kb.add_measurement("light", 1)
            kb.set_component_failure("rotors")
            kb.set_component_active("lidar", True)
            kb.cancel_action("deliver")
            kb.request_action("wait")
            kb.select_configuration(["see by lidar"], [])
            assert kb.pending_reconfiguration_plan() != plan
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        everything()
    assert snapshot(kb) == before
    assert events == []
    assert kb.pending_reconfiguration_plan() == plan


def test_a_refusal_caught_within_a_transaction_leaves_the_rest_of_it_standing(kb: KnowledgeBase) -> None:
    with kb.transaction():
        kb.set_component_failure("camera")
        with pytest.raises(LookupError):
            kb.set_component_failure("wings")
        kb.set_component_active("lidar", True)
    assert kb.status("component", "camera") is Status.FAILURE
    assert kb.is_component_active("lidar")


def test_a_transaction_within_a_transaction_is_part_of_it(kb: KnowledgeBase) -> None:
    events = heard(kb)

    def outer() -> None:
        with kb.transaction():
            with kb.transaction():
                kb.set_component_failure("camera")
            assert events == []
            raise AbortedError

    with pytest.raises(AbortedError):
        outer()
    assert (events, kb.status("component", "camera")) == ([], Status.FEASIBLE)


def test_of_an_inner_transaction_that_raises_nothing_stands(kb: KnowledgeBase) -> None:
    def inner() -> None:
        with kb.transaction():
            kb.set_component_failure("camera")
            raise AbortedError

    with kb.transaction():
        kb.set_component_active("lidar", True)
        with pytest.raises(AbortedError):
            inner()
    assert kb.status("component", "camera") is Status.FEASIBLE


# -- threads --


def test_threads_may_write_at_the_same_time_and_events_keep_the_order_of_the_writes(kb: KnowledgeBase) -> None:
    events = heard(kb)
    each = 150

    def work(component: str) -> None:
        for step in range(each):
            if step % 2:
                kb.set_component_active(component, step % 4 == 1)
            else:
                with kb.transaction():
                    kb.set_component_failure(component)
                    kb.add_measurement("light", step)
                    kb.clear_component_failure(component)

    threads = [threading.Thread(target=work, args=(name,)) for name in ("camera", "lidar", "rotors", "damper")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()

    revisions = [event.revision for event in events]
    assert revisions == sorted(revisions)
    assert set(revisions) == set(range(1, 4 * each + 1))
    assert kb.revision == 4 * each
    measured = [m for event in events if isinstance(event, MonitoringData) for m in event.measurements]
    assert tuple(measured) == kb.history("measurements")


def test_another_thread_never_sees_what_a_transaction_takes_back(kb: KnowledgeBase) -> None:
    seen: list[object] = []
    asking = threading.Event()
    lock = kb._lock

    class NoticedLock:
        def __enter__(self) -> None:
            asking.set()
            lock.__enter__()

        def __exit__(self, *error: object) -> None:
            lock.__exit__(*error)

    kb._lock = NoticedLock()

    def look() -> None:
        seen.append(kb.status("component", "camera"))
        seen.append(kb.is_component_active("camera"))
        seen.append(kb.is_action_feasible("deliver"))
        seen.append(kb.measurement("battery"))
        seen.append(kb.revision)

    def write_and_take_back(reader: threading.Thread) -> None:
        with kb.transaction():
            kb.set_component_failure("camera")
            kb.set_component_active("camera", True)
            kb.add_measurement("battery", 0.1)
            reader.start()
            assert asking.wait(HANG_LIMIT)
            reader.join(0.005)
            assert not seen
            raise AbortedError

    reader = threading.Thread(target=look)
    with pytest.raises(AbortedError):
        write_and_take_back(reader)
    reader.join()
    assert seen == [Status.FEASIBLE, False, True, None, 0]
