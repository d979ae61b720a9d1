"""Parameters of scenarios, from requests and from files."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_core import InputError
from rosa_simulation.parameters import number, requested_parameters, truth, whole_number
from rosa_simulation.scenario import Parameter, RunRequest

KNOWN = {
    "speed": Parameter("m/s", number(0.0, 10.0)),
    "count": Parameter("how many", whole_number(1)),
    "lamp": Parameter("whether there is one", truth),
    "time_limit": Parameter("s", number()),
}
ANYTHING = st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.lists(st.integers())


@given(ANYTHING)
def test_a_number_is_finite_and_in_its_range(raw: object) -> None:
    sound = isinstance(raw, int | float) and not isinstance(raw, bool) and 0.0 <= raw <= 10.0
    assert accepted(number(0.0, 10.0), raw) == sound


@given(ANYTHING)
def test_no_number_is_infinite_or_text(raw: object) -> None:
    sound = isinstance(raw, int | float) and not isinstance(raw, bool) and abs(raw) < math.inf
    assert accepted(number(), raw) == sound


@given(ANYTHING)
def test_a_whole_number_is_one(raw: object) -> None:
    assert accepted(whole_number(1), raw) == (type(raw) in (int, float) and raw == raw // 1 >= 1)


@given(ANYTHING)
def test_a_truth_is_true_or_false(raw: object) -> None:
    assert accepted(truth, raw) == (type(raw) is bool)


def accepted(read: Callable[[object], object], raw: object) -> bool:
    try:
        assert read(raw) == raw
    except ValueError:
        return False
    return True


@pytest.mark.parametrize(
    ("read", "said"),
    [
        (number(), "a number is expected"),
        (number(high=3.0), "a number up to 3 is"),
        (number(2.0), "a number from 2 up is"),
        (whole_number(1, 6), "a whole number from 1 to 6 is"),
    ],
)
def test_a_reader_says_what_is_expected(read: Callable[[object], object], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        read("x")


def test_the_request_counts_before_its_parameters_and_these_before_the_file(tmp_path: Path) -> None:
    path = tmp_path / "values.yaml"
    path.write_text("parameters: {speed: 1, count: 2, time_limit: 3}\n", encoding="utf-8")
    request = RunRequest(mission_config=path, parameters={"count": 5, "time_limit": 6}, time_limit=7.0)
    assert requested_parameters(KNOWN, request) == {"speed": 1.0, "count": 5, "time_limit": 7.0}
    assert requested_parameters(KNOWN, RunRequest()) == {}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("parameters:\n  speed: 1\n  lmap: true\n", r"values.yaml:3: .*'lmap' \(did you mean 'lamp'\?\)"),
        ("parameters: {speed: 11}\n", "from 0 to 10"),
        ("parameters: {}\nname: x\n", "unknown key 'name'"),
        ("- speed\n", "it looks like 'parameters: {speed: ...}'"),
        ("parameters: [\n", "not valid YAML"),
    ],
)
def test_a_file_that_does_not_fit_is_refused_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "values.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=said):
        requested_parameters(KNOWN, RunRequest(mission_config=path))


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        requested_parameters(KNOWN, RunRequest(mission_config=tmp_path / "none.yaml"))
