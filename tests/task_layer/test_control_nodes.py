"""SequenceWithMemory and RetryUntilSuccessful, tick by tick."""

from __future__ import annotations

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt import RetryUntilSuccessful, SequenceWithMemory

S, F, R, I = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.INVALID  # noqa: E741


class Leaf(Behaviour):
    """Returns the given statuses one after the other, the last for ever."""

    def __init__(self, name: str, *statuses: Status) -> None:
        super().__init__(name)
        self.script = list(statuses)
        self.ticks = 0

    def update(self) -> Status:
        self.ticks += 1
        return self.script.pop(0) if len(self.script) > 1 else self.script[0]


def ticks(root: Behaviour, count: int) -> list[Status]:
    trace = []
    for _ in range(count):
        root.tick_once()
        trace.append(root.status)
    return trace


def test_a_sequence_yields_after_a_child_that_succeeds_at_once() -> None:
    first, second, third = Leaf("1", S), Leaf("2", S), Leaf("3", S)
    sequence = SequenceWithMemory("sequence", [first, second, third])
    # R - [S, I, I]; R - [S, S, I]; S - [S, S, S]
    assert ticks(sequence, 3) == [R, R, S]
    assert [leaf.ticks for leaf in (first, second, third)] == [1, 1, 1]


def test_a_sequence_goes_straight_on_after_a_child_that_was_running() -> None:
    first, second = Leaf("1", R, S), Leaf("2", R)
    sequence = SequenceWithMemory("sequence", [first, second])
    assert ticks(sequence, 2) == [R, R]
    assert second.ticks == 1


def test_after_a_failure_a_sequence_goes_on_from_the_child_that_failed() -> None:
    first, second = Leaf("1", R, S), Leaf("2", F, S)
    sequence = SequenceWithMemory("sequence", [first, second])
    assert ticks(sequence, 3) == [R, F, S]
    assert first.ticks == 2


def test_a_halted_sequence_goes_on_from_the_child_that_was_running() -> None:
    first, second = Leaf("1", R, S), Leaf("2", R, R, S)
    sequence = SequenceWithMemory("sequence", [first, second])
    ticks(sequence, 2)
    sequence.stop(I)
    assert second.status == I
    assert ticks(sequence, 2) == [R, S]
    assert first.ticks == 2


def test_a_sequence_that_is_done_starts_anew() -> None:
    first = Leaf("1", R, S, R, S)
    sequence = SequenceWithMemory("sequence", [first])
    assert ticks(sequence, 4) == [R, S, R, S]


def test_an_empty_sequence_succeeds() -> None:
    assert ticks(SequenceWithMemory("sequence", []), 1) == [S]


def test_a_yield_asks_the_runner_to_tick_again() -> None:
    woken = []
    sequence = SequenceWithMemory("sequence", [Leaf("1", S), Leaf("2", S)])
    sequence.setup(wake=lambda: woken.append(True))
    ticks(sequence, 2)
    assert woken == [True]


def test_retrying_for_ever_never_fails() -> None:
    leaf = Leaf("leaf", F)
    assert ticks(RetryUntilSuccessful("retry", leaf, -1), 50) == [R] * 50
    assert leaf.ticks == 50


def test_retrying_fails_after_the_last_attempt_and_counts_anew_then() -> None:
    retry = RetryUntilSuccessful("retry", Leaf("leaf", F), 3)
    assert ticks(retry, 6) == [R, R, F, R, R, F]


def test_retrying_succeeds_with_its_child() -> None:
    assert ticks(RetryUntilSuccessful("retry", Leaf("leaf", F, R, S), 3), 3) == [R, R, S]


@pytest.mark.parametrize("attempts", [-2, -10])
def test_a_number_of_attempts_that_means_nothing_is_refused(attempts: int) -> None:
    with pytest.raises(ValueError, match="num_attempts"):
        RetryUntilSuccessful("retry", Leaf("leaf", S), attempts)
