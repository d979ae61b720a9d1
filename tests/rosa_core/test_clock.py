"""Time: simulated and exact, or that of the wall; and the stopwatch that measures what a manager costs."""

from __future__ import annotations

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_core import SimulationClock, WallClock
from rosa_core.clock import Stopwatch


class Diary:
    """What was called, and at what time."""

    def __init__(self, clock: SimulationClock) -> None:
        self.clock = clock
        self.entries: list[tuple[float, str]] = []

    def write(self, what: str) -> None:
        self.entries.append((self.clock.now(), what))


@pytest.fixture
def diary(clock: SimulationClock) -> Diary:
    return Diary(clock)


def test_time_passes_only_when_it_is_advanced(clock: SimulationClock) -> None:
    assert [clock.now(), clock.now()] == [0.0, 0.0]
    clock.advance_to(3.5)
    assert clock.now() == 3.5
    assert SimulationClock(start=100.0).now() == 100.0


def test_time_never_goes_back(clock: SimulationClock) -> None:
    clock.advance_to(5)
    clock.advance_to(2)
    assert clock.now() == 5


def test_calls_are_made_in_order_of_time_at_their_time(clock: SimulationClock, diary: Diary) -> None:
    clock.call_at(3, lambda: diary.write("three"))
    clock.call_at(1, lambda: diary.write("one"))
    clock.call_later(2, lambda: diary.write("two"))
    clock.call_at(4.5, lambda: diary.write("too late"))
    clock.advance_to(4)
    assert diary.entries == [(1, "one"), (2, "two"), (3, "three")]
    assert clock.now() == 4


def test_calls_at_the_same_time_are_made_in_order_of_scheduling(clock: SimulationClock, diary: Diary) -> None:
    for name in "abc":
        clock.call_at(1, lambda name=name: diary.write(name))
    clock.call_every(1, lambda: diary.write("every"))
    clock.call_at(1, lambda: diary.write("last"))
    clock.advance_to(1)
    assert [what for _, what in diary.entries] == ["a", "b", "c", "every", "last"]


def test_a_call_in_the_past_is_made_now(clock: SimulationClock, diary: Diary) -> None:
    clock.advance_to(10)
    clock.call_at(3, lambda: diary.write("late"))
    clock.advance_to(10)
    assert diary.entries == [(10, "late")]


def test_a_call_may_schedule_another_at_the_same_time(clock: SimulationClock, diary: Diary) -> None:
    clock.call_at(1, lambda: clock.call_later(0, lambda: diary.write("then")))
    clock.advance_to(1)
    assert diary.entries == [(1, "then")]


def test_periodic_calls_come_every_period_from_one_period_on(clock: SimulationClock, diary: Diary) -> None:
    clock.call_every(2, lambda: diary.write("tick"))
    clock.advance_to(7)
    assert [time for time, _ in diary.entries] == [2, 4, 6]


def test_periodic_calls_may_start_at_a_given_time(clock: SimulationClock, diary: Diary) -> None:
    clock.call_every(2, lambda: diary.write("tick"), start=0.5)
    clock.advance_to(5)
    assert [time for time, _ in diary.entries] == [0.5, 2.5, 4.5]


def test_periods_do_not_drift(clock: SimulationClock, diary: Diary) -> None:
    clock.call_every(0.1, lambda: diary.write("tick"), start=0.0)
    clock.advance_to(1000)
    assert [time for time, _ in diary.entries] == [number * 0.1 for number in range(10_001)]


@pytest.mark.parametrize("period", [0, -1, float("nan")])
def test_a_period_must_be_positive(clock: SimulationClock, period: float) -> None:
    with pytest.raises(ValueError, match="positive"):
        clock.call_every(period, lambda: None)


def test_a_cancelled_call_is_not_made(clock: SimulationClock, diary: Diary) -> None:
    timer = clock.call_at(1, lambda: diary.write("no"))
    timer.cancel()
    clock.advance_to(2)
    assert diary.entries == []
    assert clock.now() == 2


def test_a_periodic_call_may_cancel_itself(clock: SimulationClock, diary: Diary) -> None:
    def tick() -> None:
        diary.write("tick")
        if len(diary.entries) == 3:
            timer.cancel()

    timer = clock.call_every(1, tick)
    clock.advance_to(10)
    assert [time for time, _ in diary.entries] == [1, 2, 3]


def test_waiting_lets_time_pass_with_its_calls(clock: SimulationClock, diary: Diary) -> None:
    clock.call_every(1, lambda: diary.write("tick"))
    clock.wait(threading.Event(), 2.5)
    assert clock.now() == 2.5
    assert [time for time, _ in diary.entries] == [1, 2]


def test_waiting_stops_at_the_call_that_wakes(clock: SimulationClock, diary: Diary) -> None:
    wake = threading.Event()
    clock.call_at(1, lambda: diary.write("before"))
    clock.call_at(2, wake.set)
    clock.call_at(2, lambda: diary.write("after"))
    clock.wait(wake, 10)
    assert clock.now() == 2
    assert diary.entries == [(1, "before")]


def test_waiting_for_what_has_happened_takes_no_time(clock: SimulationClock, diary: Diary) -> None:
    wake = threading.Event()
    wake.set()
    clock.call_at(0, lambda: diary.write("no"))
    clock.wait(wake, 10)
    assert (clock.now(), diary.entries) == (0, [])


def test_waiting_less_than_nothing_does_not_turn_time_back(clock: SimulationClock) -> None:
    clock.advance_to(5)
    clock.wait(threading.Event(), -2)
    assert clock.now() == 5


def test_a_call_during_a_wait_may_itself_let_more_time_pass(clock: SimulationClock) -> None:
    clock.call_at(1, lambda: clock.advance_to(20))
    clock.wait(threading.Event(), 5)
    assert clock.now() == 20


@given(st.lists(st.tuples(st.floats(0, 100), st.sampled_from(["at", "later", "wait", "advance"])), max_size=20))
def test_whatever_is_scheduled_calls_come_in_order_and_never_early(steps: list[tuple[float, str]]) -> None:
    clock = SimulationClock()
    made: list[tuple[float, float]] = []

    def due(when: float) -> None:
        clock.call_at(when, lambda: made.append((clock.now(), when)))

    for amount, step in steps:
        before = clock.now()
        if step == "at":
            due(amount)
        elif step == "later":
            due(before + amount)
        elif step == "wait":
            clock.wait(threading.Event(), amount)
        else:
            clock.advance_to(amount)
        assert clock.now() >= before
    clock.advance_to(10_000)
    assert made == sorted(made, key=lambda call: call[0])
    assert all(now >= when for now, when in made)
    assert len(made) == sum(step in ("at", "later") for _, step in steps)


def test_the_wall_clock_does_not_jump_when_the_system_clock_does(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("time.time", lambda: 1_000_000.0)
    monkeypatch.setattr("time.perf_counter", lambda: 50.0)
    clock = WallClock()
    assert clock.now() == 1_000_000.0
    monkeypatch.setattr("time.time", lambda: 3.0)
    monkeypatch.setattr("time.perf_counter", lambda: 52.5)
    assert clock.now() == 1_000_002.5


def test_waiting_by_the_wall_clock_ends_when_woken_or_when_time_is_up() -> None:
    clock, wake, never = WallClock(), threading.Event(), threading.Event()
    clock.wait(never, 0.001)
    waker = threading.Timer(0.01, wake.set)
    waker.start()
    clock.wait(wake, 3600)
    waker.join()
    assert wake.is_set()
    assert not never.is_set()


def test_a_stopwatch_adds_up_what_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [10.0]
    monkeypatch.setattr("time.perf_counter", lambda: now[0])
    stopwatch = Stopwatch()
    assert stopwatch.elapsed() == 0
    with stopwatch.running():
        now[0] += 2
        assert stopwatch.elapsed() == 2
    now[0] += 100
    assert stopwatch.elapsed() == 2
    with stopwatch.running():
        now[0] += 3
    assert stopwatch.elapsed() == 5


def test_a_stopwatch_counts_blocks_inside_blocks_once(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr("time.perf_counter", lambda: now[0])
    stopwatch = Stopwatch()
    with stopwatch.running():
        now[0] += 1
        with stopwatch.running():
            now[0] += 1
        now[0] += 1
    assert stopwatch.elapsed() == 3


def test_a_stopwatch_stops_when_its_block_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr("time.perf_counter", lambda: now[0])
    stopwatch = Stopwatch()

    def run() -> None:
        with stopwatch.running():
            now[0] += 1
            raise ArithmeticError

    with pytest.raises(ArithmeticError):
        run()
    now[0] += 9
    assert stopwatch.elapsed() == 1
