"""Streams brought together into states."""

from __future__ import annotations

import pytest

from rosa_core import InputError
from rosa_streams.environment import Sample
from rosa_streams.runtime import Synchroniser, TimedState


def states(synchroniser: Synchroniser, *samples: tuple[str, object, float]) -> list[tuple[float, dict[str, object]]]:
    made = [synchroniser.receive(name, Sample(name, value, time)) for name, value, time in samples]
    return [(state.time, dict(state.values)) for state in made if state is not None]


def test_on_any_sample_states_hold_all_that_came_for_a_time() -> None:
    on_any = Synchroniser(["x", "y"])
    assert states(on_any, ("x", 1, 1.0), ("y", 2, 1.0), ("x", 3, 2.0)) == [(1.0, {"x": 1, "y": 2})]
    assert on_any.tick(2.5) == TimedState(2.0, {"x": 3, "y": 2})
    assert on_any.tick(2.6) is None


def test_on_all_a_state_waits_for_a_new_sample_of_each_stream() -> None:
    on_all = Synchroniser(["x", "y"], policy="all")
    assert states(on_all, ("x", 1, 1.0), ("x", 2, 2.0), ("y", 5, 2.5), ("y", 6, 3.0), ("x", 3, 4.0)) == [
        (2.5, {"x": 2, "y": 5}),
        (4.0, {"x": 3, "y": 6}),
    ]


def test_periodic_states_hold_the_latest_values() -> None:
    periodic = Synchroniser(["x"], policy="periodic", period=1.0)
    assert periodic.tick(1.0) == TimedState(1.0, {})
    assert states(periodic, ("x", 1, 1.2), ("x", 2, 1.8)) == []
    assert periodic.tick(2.0) == TimedState(2.0, {"x": 2})
    assert periodic.tick(3.0) == TimedState(3.0, {"x": 2})


def test_a_value_that_is_too_old_is_unknown() -> None:
    on_any = Synchroniser(["x", "y"], max_age=1.0)
    made = states(on_any, ("x", 1, 0.0), ("y", 2, 1.0), ("y", 3, 1.5), ("y", 4, 2.0))
    assert made == [(0.0, {"x": 1}), (1.0, {"x": 1, "y": 2}), (1.5, {"y": 3})]


def test_a_sample_that_is_older_than_its_streams_latest_is_left_out() -> None:
    on_any = Synchroniser(["x"])
    assert states(on_any, ("x", 1, 2.0), ("x", 9, 1.0), ("x", 3, 3.0)) == [(2.0, {"x": 1})]


@pytest.mark.parametrize(
    "options",
    [
        {"policy": "sometimes"},
        {"policy": "periodic"},
        {"period": 1.0},
        {"policy": "periodic", "period": 0.0},
        {"max_age": 0.0},
    ],
)
def test_policies_that_make_no_sense_are_refused(options: dict[str, object]) -> None:
    with pytest.raises(InputError):
        Synchroniser(["x"], **options)  # type: ignore[arg-type]


def test_a_stranger_is_refused() -> None:
    with pytest.raises(InputError, match="'z' is none of x"):
        Synchroniser(["x"]).receive("z", Sample("z", 1, 0.0))
