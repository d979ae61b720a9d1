"""Which events of the knowledge base are reason for a tick."""

from __future__ import annotations

from rosa_core import KnowledgeBase
from rosa_core.kb import Event, MonitoringData, StatusesChanged
from task_layer.waking import WAKING, is_reason_to_tick


def events_of_a_low_battery(kb: KnowledgeBase) -> list[Event]:
    events: list[Event] = []
    kb.add_measurement("battery_level", 0.9)
    unsubscribe = kb.subscribe(events.append)
    kb.add_measurement("battery_level", 0.1)
    unsubscribe()
    return events


def test_what_follows_from_own_requests_is_none_unless_it_concerns_feasibility(kb: KnowledgeBase) -> None:
    (statuses,) = [event for event in events_of_a_low_battery(kb) if isinstance(event, StatusesChanged)]
    assert is_reason_to_tick(statuses, own=False)
    assert is_reason_to_tick(statuses, own=True)
    kept: list[Event] = []
    kb.subscribe(kept.append, WAKING)
    kb.request_action("recharge")
    assert kept
    assert all(is_reason_to_tick(event, own=False) for event in kept)
    assert not any(is_reason_to_tick(event, own=True) for event in kept)


def test_a_measurement_is_one_only_where_the_measure_is_sensed(kb: KnowledgeBase) -> None:
    (data,) = [event for event in events_of_a_low_battery(kb) if isinstance(event, MonitoringData)]
    assert not is_reason_to_tick(data, own=False)
    assert is_reason_to_tick(data, own=False, measures={"battery_level"})
    assert not is_reason_to_tick(data, own=False, measures={"water_visibility"})
