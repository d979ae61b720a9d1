"""What the monitor makes of diagnostics: what a status means, what is written, and that no junk ever stops it."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rosa_core import KnowledgeBase, SimulationClock, Status
from rosa_core.kb import Measurement, MonitoringData
from rosa_core.mape import DiagnosticsMonitor, MonitorReport
from rosa_core.mape.monitor import MOST_ITEMS
from tests.rosa_core.sample_models import DRONE, heard, knowledge_model, snapshot


def array(*statuses: tuple[str, list[tuple[Any, Any]]], stamp: Any = None) -> dict[str, Any]:
    """A diagnostic array of dicts, from a message and key-value pairs for each status."""
    return {
        "header": {"stamp": stamp},
        "status": [
            {"level": 0, "name": "", "message": message, "values": [{"key": k, "value": v} for k, v in values]}
            for message, values in statuses
        ],
    }


@pytest.fixture
def monitor(kb: KnowledgeBase) -> DiagnosticsMonitor:
    return DiagnosticsMonitor(kb)


# -- what a status means --


@pytest.mark.parametrize(
    "message",
    [
        "QA status",
        "QA measurement",
        "EA status",
        "EA measurement",
        "Attribute measurement",
        "qa STATUS",
        "attribute MEASUREMENT",
    ],
)
def test_measurements_are_known_by_their_message(kb: KnowledgeBase, monitor: DiagnosticsMonitor, message: str) -> None:
    report = monitor.update(array((message, [("light", "60.5")])))
    assert report == MonitorReport(written=1, ignored=0, rejected=())
    assert kb.measurement("light") == Measurement("light", 60.5, 0.0)


@pytest.mark.parametrize("message", ["Component status", "Component", "COMPONENT", "component Status"])
@pytest.mark.parametrize("word", ["FALSE", "failure", "error", "False", "ERROR", "Failure"])
def test_component_failures_are_known_by_message_and_word(
    kb: KnowledgeBase, monitor: DiagnosticsMonitor, message: str, word: str
) -> None:
    monitor.update(array((message, [("camera", word)])))
    assert kb.status("component", "camera") is Status.FAILURE


@pytest.mark.parametrize("word", ["RECOVERED", "OK", "recovered", "ok", "Ok"])
def test_component_recoveries_are_known_by_their_word(
    kb: KnowledgeBase, monitor: DiagnosticsMonitor, word: str
) -> None:
    kb.set_component_failure("camera")
    monitor.update(array(("Component status", [("camera", word)])))
    assert kb.status("component", "camera") is Status.FEASIBLE


@pytest.mark.parametrize(
    "message", ["", "status", "QA", "heartbeat", "Component statuses", None, 7, True, b"QA status"]
)
def test_any_other_message_is_ignored(kb: KnowledgeBase, monitor: DiagnosticsMonitor, message: Any) -> None:
    report = monitor.update(array((message, [("light", "60"), ("camera", "FALSE")])))
    assert report == MonitorReport(written=0, ignored=1, rejected=())
    assert kb.revision == 0


# -- what is written --


def test_an_array_is_one_write(kb: KnowledgeBase, monitor: DiagnosticsMonitor) -> None:
    events = heard(kb, MonitoringData)
    monitor.update(
        array(
            ("QA status", [("light", "60"), ("battery", "0.5")]),
            ("Component status", [("camera", "FALSE"), ("lidar", "ERROR")]),
            ("EA status", [("wind", "3")]),
        )
    )
    (event,) = events
    assert isinstance(event, MonitoringData)
    assert [(m.measure, m.value) for m in event.measurements] == [("light", 60), ("battery", 0.5), ("wind", 3)]
    assert event.failures == ("camera", "lidar")
    assert kb.revision == 1


def test_the_same_key_may_stand_twice_in_a_status(kb: KnowledgeBase, monitor: DiagnosticsMonitor) -> None:
    report = monitor.update(array(("Component status", [("camera", "FALSE"), ("camera", "ERROR")])))
    assert report.written == 2
    assert kb.status("component", "camera") is Status.FAILURE


def test_of_the_same_key_every_value_is_taken_in_order(kb: KnowledgeBase, monitor: DiagnosticsMonitor) -> None:
    monitor.update(array(("Component", [("camera", "FALSE"), ("camera", "OK")]), ("Component", [("lidar", "OK")])))
    assert kb.status("component", "camera") is Status.FEASIBLE
    monitor.update(array(("QA status", [("light", "1"), ("light", "2")])))
    assert [m.value for m in kb.history("measurements", "light")] == [1, 2]
    assert kb.measurement("light") == Measurement("light", 2.0, 0.0)


def test_every_recovery_in_a_status_counts(kb: KnowledgeBase, monitor: DiagnosticsMonitor) -> None:
    for component in ("rotors", "camera", "lidar"):
        kb.set_component_failure(component)
    monitor.update(array(("Component status", [(c, "RECOVERED") for c in ("rotors", "camera", "lidar")])))
    assert Status.FAILURE not in kb.statuses("component").values()


@pytest.mark.parametrize("value", ["60", " 60 ", "6e1", 60, 60.0, "+60.0"])
def test_a_number_may_be_text_or_number(kb: KnowledgeBase, monitor: DiagnosticsMonitor, value: Any) -> None:
    monitor.update(array(("QA status", [("light", value)])))
    assert kb.measurement("light") == Measurement("light", 60.0, 0.0)


# -- when --


@pytest.mark.parametrize(
    "stamp",
    [
        {"sec": 12, "nanosec": 500_000_000},
        SimpleNamespace(sec=12, nanosec=500_000_000),
        12.5,
        {"sec": 12.5},
        SimpleNamespace(sec="12.5", nanosec=None),
    ],
)
def test_a_measurement_has_the_time_of_the_stamp(kb: KnowledgeBase, monitor: DiagnosticsMonitor, stamp: Any) -> None:
    monitor.update(array(("QA status", [("light", "60")]), ("Component", [("camera", "FALSE")]), stamp=stamp))
    assert kb.measurement("light") == Measurement("light", 60.0, 12.5)
    assert "12.5 s" in kb.explain("component", "camera").reason


@pytest.mark.parametrize(
    "stamp",
    [None, "now", {}, [], {"sec": None}, {"sec": "x"}, float("nan"), {"sec": 10**400}, {"sec": 1, "nanosec": "y"}],
)
def test_without_a_readable_stamp_the_time_is_now(
    kb: KnowledgeBase, clock: SimulationClock, monitor: DiagnosticsMonitor, stamp: Any
) -> None:
    clock.advance_to(7)
    assert monitor.update(array(("QA status", [("light", "60")]), stamp=stamp)).written == 1
    assert kb.measurement("light") == Measurement("light", 60.0, 7.0)


def test_a_late_array_does_not_undo_a_newer_one(kb: KnowledgeBase, monitor: DiagnosticsMonitor) -> None:
    monitor.update(array(("QA status", [("light", "60")]), stamp={"sec": 5, "nanosec": 0}))
    monitor.update(array(("QA status", [("light", "10")]), stamp={"sec": 4, "nanosec": 999_999_999}))
    assert kb.measurement("light") == Measurement("light", 60.0, 5.0)


def test_messages_of_ros_are_read_by_their_attributes(kb: KnowledgeBase, monitor: DiagnosticsMonitor) -> None:
    value = SimpleNamespace(key="light", value="60")
    status = SimpleNamespace(level=b"\x00", name="sensor", message="QA status", hardware_id="", values=(value,))
    header = SimpleNamespace(stamp=SimpleNamespace(sec=3, nanosec=250_000_000), frame_id="")
    report = monitor.update(SimpleNamespace(header=header, status=[status]))
    assert report == MonitorReport(1, 0, ())
    assert kb.measurement("light") == Measurement("light", 60.0, 3.25)


# -- junk --


@pytest.mark.parametrize(
    ("message", "key", "value"),
    [
        ("QA status", "lihgt", "60"),
        ("QA status", None, "60"),
        ("QA status", "light", "dark"),
        ("QA status", "light", ""),
        ("QA status", "light", None),
        ("QA status", "light", "nan"),
        ("QA status", "light", "-inf"),
        ("QA status", "light", "1e999"),
        ("QA status", "light", True),
        ("QA status", "light", [60]),
        pytest.param("QA status", "light", 10**5000, id="over printing"),
        ("QA status", ["light"], "60"),
        ("QA status", "camera", "60"),
        ("Component", "camrea", "FALSE"),
        ("Component", "camera", "perhaps"),
        ("Component", "camera", "TRUE"),
        ("Component", "camera", None),
        ("Component", "light", "FALSE"),
    ],
)
def test_what_cannot_be_used_is_counted_and_logged_and_the_rest_is_written(
    kb: KnowledgeBase,
    monitor: DiagnosticsMonitor,
    caplog: pytest.LogCaptureFixture,
    message: str,
    key: Any,
    value: Any,
) -> None:
    with caplog.at_level(logging.WARNING):
        report = monitor.update(
            array(("EA status", [("wind", "3")]), (message, [(key, value)]), ("Component", [("lidar", "ERROR")]))
        )
    assert (report.written, report.ignored, len(report.rejected)) == (2, 0, 1)
    assert report.rejected[0] in caplog.text
    assert monitor.rejected == 1
    assert kb.measurement("wind") == Measurement("wind", 3.0, 0.0)
    assert kb.status("component", "lidar") is Status.FAILURE
    assert kb.measurement("light") is None


def test_an_unknown_name_in_a_diagnostic_is_logged_with_the_nearest_known_one(monitor: DiagnosticsMonitor) -> None:
    report = monitor.update(array(("QA status", [("lihgt", "60")])))
    assert "did you mean 'light'" in report.rejected[0]


def test_rejected_values_are_counted_over_all_updates(monitor: DiagnosticsMonitor) -> None:
    for _ in range(3):
        monitor.update(array(("QA status", [("x", "1"), ("light", "y"), ("light", "5")])))
    assert monitor.rejected == 6


class Unreadable:
    """An object with no attribute that can be read."""

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name)


@pytest.mark.parametrize(
    "junk",
    [
        None,
        7,
        "text",
        b"bytes",
        [],
        {},
        {"status": None},
        {"status": "QA status"},
        {"status": 5},
        {"status": {"message": "QA status"}},
        {"header": 3, "status": []},
        {"status": [None]},
        {"status": [[], "QA status", 3, {}]},
        {"status": [{"message": "QA status"}]},
        {"status": [{"message": "QA status", "values": None}]},
        {"status": [{"message": "QA status", "values": "light"}]},
        {"status": [{"message": "QA status", "values": {"light": 60}}]},
        {"status": [{"message": "QA status", "values": [None, 3, "light", {}, {"key": "light"}]}]},
        SimpleNamespace(),
        SimpleNamespace(status=SimpleNamespace()),
        SimpleNamespace(status=[SimpleNamespace(message="Component", values=[SimpleNamespace()])]),
        Unreadable(),
    ],
)
def test_junk_changes_nothing_and_does_not_raise(kb: KnowledgeBase, monitor: DiagnosticsMonitor, junk: Any) -> None:
    before = snapshot(kb)
    assert monitor.update(junk).written == 0
    assert snapshot(kb) == before


scalars = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.binary(max_size=4)
words = st.sampled_from(["light", "camera", "FALSE", "OK", "QA status", "Component", "60", "-1e3", "nan"]) | scalars
junk_values = st.recursive(
    words,
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from(["header", "stamp", "sec", "status", "message", "values", "key"]), inner)
    ),
    max_leaves=12,
)
pairs = st.lists(st.fixed_dictionaries({}, optional={"key": words, "value": words | junk_values}) | junk_values)
statuses = st.lists(st.fixed_dictionaries({"message": words, "values": pairs}) | junk_values, max_size=4)
stamps = st.fixed_dictionaries({}, optional={"sec": words, "nanosec": words}) | words


@settings(max_examples=200, deadline=None)
@given(junk_values | st.fixed_dictionaries({"header": st.fixed_dictionaries({"stamp": stamps}), "status": statuses}))
def test_nothing_that_comes_in_raises_or_goes_uncounted(diagnostics: Any) -> None:
    kb = KnowledgeBase(knowledge_model(DRONE), SimulationClock())
    monitor = DiagnosticsMonitor(kb)
    report = monitor.update(diagnostics)
    assert monitor.rejected == len(report.rejected)
    written = len(kb.history("measurements"))
    assert written <= report.written
    assert kb.revision <= 1


class _Raising:
    def __str__(self) -> str:
        raise RuntimeError("no text")

    def __iter__(self) -> Iterator[Any]:
        raise RuntimeError("no items")


def _endless() -> Iterator[dict[str, Any]]:
    while True:
        yield {"key": "nowhere", "value": "1"}


def test_objects_that_raise_when_they_are_read_are_rejected_and_the_rest_is_written(
    kb: KnowledgeBase, monitor: DiagnosticsMonitor
) -> None:
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    odd = [{"key": "light", "value": _Raising()}, {"key": _Raising(), "value": "1"}, {"key": "light", "value": deep}]
    good = {"key": "light", "value": "0.25"}
    report = monitor.update(
        {
            "status": [
                {"message": "QA status", "values": odd},
                {"message": "QA status", "values": _Raising()},
                {"message": _Raising(), "values": [good]},
                {"message": "QA status", "values": _endless()},
                {"message": "QA status", "values": [good]},
            ]
        }
    )
    while deep:  # nobody is to free it recursively
        deep = deep.pop()
    assert (report.written, report.ignored) == (1, 1)
    assert len(report.rejected) == 3 + 1 + MOST_ITEMS + 1
    assert report.rejected[0] == "a value of type _Raising cannot be read: RuntimeError"
    assert kb.measurement("light") is not None
