"""What a simulated run leaves behind is collected while it happens."""

from __future__ import annotations

from rosa_core import SimulationClock
from rosa_simulation.run_recorder import RunRecorder
from rosa_simulation.scenario import RunRequest
from task_layer.bt.testing import ScriptedLeaf
from tests.rosa_simulation.test_scenarios import Watching


def test_a_run_is_recorded_and_shown_as_it_happens() -> None:
    clock, watching = SimulationClock(), Watching()
    recorder = RunRecorder(watching, clock, effect_time=0.01)
    recorder.sample(("height_m",), lambda: (2.0 * clock.now(),), period=0.5)
    clock.advance_to(1.0)
    recorder.narrator.cause("it rises")
    with recorder.stopwatch.running():
        clock.advance_to(1.25)
    record = recorder.record(
        "lift", RunRequest(seed=3), ended_by="the top", inputs={"speed": 2}, metrics={"floors": 1}, reactions={"U1": []}
    )
    assert record.trajectory_columns == ("time_s", "height_m")
    assert record.trajectory == ((0.0, 0.0), (0.5, 1.0), (1.0, 2.0))
    assert watching.times == [0.0, 0.5, 1.0]
    assert [event.text for event in record.events] == ["it rises"]
    assert tuple(watching.events) == record.events
    assert (record.scenario, record.seed, record.ended_by, record.completed) == ("lift", 3, "the top", True)
    assert record.duration_s == 1.25
    assert record.reactions == {"U1": ()}
    assert 0.0 < record.managing_s <= record.wall_clock_s


def test_what_a_call_brings_about_after_the_end_is_still_recorded() -> None:
    clock = SimulationClock()
    recorder = RunRecorder(Watching(), clock, effect_time=0.01)
    recorder.narrator.cause("the end")
    recorder.narrator.call("lamp")
    clock.call_later(0.003, lambda: recorder.narrator.effect("lamp deactivated", "lamp"))
    record = recorder.record("x", RunRequest(), ended_by="", inputs={}, metrics={}, reactions={})
    assert [event.text for event in record.events] == ["the end: lamp deactivated"]
    assert record.duration_s == 0.0


def test_what_is_measured_may_wait_for_the_last_call_but_adds_nothing_to_the_duration() -> None:
    clock = SimulationClock()
    recorder = RunRecorder(Watching(), clock, effect_time=0.01)
    clock.advance_to(2.0)
    assert recorder.close() == recorder.close() == 2.0
    assert clock.now() == 2.01
    record = recorder.record("x", RunRequest(), ended_by="", inputs={}, metrics={}, reactions={})
    assert record.duration_s == 2.0
    other = recorder.record("x", RunRequest(), duration=1.5, ended_by="", inputs={}, metrics={}, reactions={})
    assert other.duration_s == 1.5


def test_an_error_that_is_raised_again_and_again_is_one_event_with_a_count() -> None:
    watching, clock = Watching(), SimulationClock()
    recorder = RunRecorder(watching, clock)
    for time in (1.0, 2.0, 3.0):
        clock.advance_to(time)
        recorder.on_raise(ScriptedLeaf("a"), KeyError("x"))
    recorder.on_raise(ScriptedLeaf("b"), KeyError("x"))
    recorder.on_raise(ScriptedLeaf("a"), KeyError("y"))
    record = recorder.record("x", RunRequest(), ended_by="", inputs={}, metrics={}, reactions={})
    assert [(event.time_s, event.text, event.facts[0].get("times")) for event in record.events] == [
        (1.0, "'a' raised KeyError: 'x': it has failed (3 times)", 3),
        (3.0, "'b' raised KeyError: 'x': it has failed", None),
        (3.0, "'a' raised KeyError: 'y': it has failed", None),
    ]


def test_times_count_from_the_beginning_of_the_mission() -> None:
    clock = SimulationClock()
    recorder = RunRecorder(Watching(), clock, start_time=lambda: 10.0)
    clock.advance_to(12.0)
    recorder.on_raise(ScriptedLeaf("leaf"), KeyError("x"))
    record = recorder.record("x", RunRequest(), ended_by="", inputs={}, metrics={}, reactions={})
    (raised,) = record.events
    assert raised.time_s == 2.0
    assert "'leaf' raised KeyError" in raised.text
    assert record.duration_s == 2.0
