"""Reactions are timed from an uncertainty to the adaptation to it."""

from __future__ import annotations

import pytest

from rosa_core.clock import Stopwatch
from rosa_simulation.reaction_times import ReactionTimes


@pytest.fixture
def times() -> ReactionTimes:
    return ReactionTimes(("A", "B"), Stopwatch())


def delays(times: ReactionTimes, name: str) -> list[float]:
    return [reaction.delay_s for reaction in times.reactions[name]]


def test_a_reaction_is_from_its_beginning_to_its_end(times: ReactionTimes) -> None:
    times.begin("A", 3.0)
    times.end("A", 5.5)
    assert delays(times, "A") == [2.5]
    assert times.reactions["A"][0].cause_s == 3.0
    assert delays(times, "B") == []


def test_what_begins_again_before_its_end_began_the_first_time(times: ReactionTimes) -> None:
    times.begin("A", 1.0)
    times.begin("A", 2.0)
    times.end("A", 4.0)
    times.end("A", 9.0)
    assert delays(times, "A") == [3.0]


def test_what_is_dropped_is_no_reaction(times: ReactionTimes) -> None:
    times.begin("A", 1.0)
    times.drop("A")
    times.end("A", 4.0)
    times.drop("B")
    times.decide("B")
    assert times.means() == {"A": None, "B": None}


def test_only_what_is_spent_until_the_decision_is_computing() -> None:
    stopwatch = Stopwatch()
    times = ReactionTimes(("A",), stopwatch)
    with stopwatch.running():
        sum(range(1000))
    times.begin("A", 0.0)
    with stopwatch.running():
        sum(range(1000))
    decided = stopwatch.elapsed()
    times.decide("A")
    with stopwatch.running():
        sum(range(100_000))
    times.decide("A")
    times.end("A", 1.0)
    (reaction,) = times.reactions["A"]
    assert 0.0 < reaction.compute_s <= decided
    assert times.means() == {"A": pytest.approx(1.0 + reaction.compute_s)}
