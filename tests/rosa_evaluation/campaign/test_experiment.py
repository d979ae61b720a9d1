"""Experiment files: what is set, what is drawn, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosa_core import InputError
from rosa_evaluation.campaign import Experiment


def load(tmp_path: Path, text: str) -> Experiment:
    path = tmp_path / "murky water.yaml"
    path.write_text(text, encoding="utf-8")
    return Experiment.load(path)


def test_plain_values_stay_and_distributions_are_drawn_wherever_they_stand(tmp_path: Path) -> None:
    experiment = load(
        tmp_path,
        "parameters:\n  a: 3\n  b: [1, {choice: [x]}, [{integer: [4, 4]}]]\n  c: {choice: [{uniform: [2, 2]}]}\n",
    )
    assert experiment.draw(1) == {"a": 3, "b": [1, "x", [4]], "c": 2.0}


def test_it_is_called_by_its_name_or_else_like_its_file(tmp_path: Path) -> None:
    assert load(tmp_path, "parameters: {}").name == "murky water"
    assert load(tmp_path, "name: night\nparameters: {}").name == "night"
    assert Experiment().name == ""


def test_the_same_seed_draws_the_same_and_one_parameter_more_changes_no_other(tmp_path: Path) -> None:
    one = load(tmp_path, "parameters: {a: {uniform: [0, 1]}}")
    more = load(tmp_path, "parameters: {b: {uniform: [0, 1]}, a: {uniform: [0, 1]}}")
    for seed in range(5):
        assert one.draw(seed)["a"] == more.draw(seed)["a"] == one.draw(seed)["a"]
        assert more.draw(seed)["a"] != more.draw(seed)["b"]


def test_draws_are_distributed_as_they_say(tmp_path: Path) -> None:
    experiment = load(
        tmp_path,
        "parameters: {u: {uniform: [10, 20]}, n: {normal: [5, 2]}, i: {integer: [1, 3]}, c: {choice: [a, b]}}",
    )
    draws = [experiment.draw(seed) for seed in range(2000)]
    uniform, normal = (np.array([draw[name] for draw in draws]) for name in "un")
    assert uniform.min() >= 10
    assert uniform.max() <= 20
    assert uniform.mean() == pytest.approx(15, abs=0.3)
    assert (normal.mean(), normal.std()) == pytest.approx((5, 2), abs=0.2)
    for name, known in (("i", [1, 2, 3]), ("c", ["a", "b"])):
        shares = [sum(draw[name] == value for draw in draws) / len(draws) for value in known]
        assert shares == pytest.approx([1 / len(known)] * len(known), abs=0.05)


@given(st.integers(0, 2**53), st.floats(-1e6, 1e6), st.floats(0, 1e6))
def test_a_uniform_draw_is_within_its_range(seed: int, low: float, width: float) -> None:
    from rosa_evaluation.campaign.experiment import Distribution

    drawn = Experiment(parameters={"a": Distribution("uniform", (low, low + width))}).draw(seed)["a"]
    assert low - 1e-4 <= drawn <= low + width + 1e-4


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("", 1, "not an experiment"),
        ("- 1", 1, "not an experiment"),
        ("parameters: 3", 1, "a mapping is expected"),
        ("parameters: {}\nparametres: {}", 2, r"unknown key 'parametres' in the file \(did you mean 'parameters'\?\)"),
        ("name: 3\nparameters: {}", 1, "text is expected"),
        ("parameters:\n  a: {unifrom: [0, 1]}", 2, r"did you mean 'uniform'\?"),
        ("parameters:\n  a: {banana: 1}", 2, "allowed here: uniform, normal, integer, choice"),
        ("parameters:\n  a: {uniform: [0, 1], normal: [0, 1]}", 2, "a distribution with one key"),
        ("parameters:\n  a: {uniform: [1, 0]}", 2, r"write it as {uniform: \[low, high\]}"),
        ("parameters:\n  a: {uniform: 3}", 2, r"write it as {uniform: \[low, high\]}"),
        ("parameters:\n  a: {uniform: [0, {uniform: [0, 1]}]}", 2, r"write it as {uniform: \[low, high\]}"),
        ("parameters:\n  a: {uniform: [-1.0e+308, 1.0e+308]}", 2, "write it as"),
        ("parameters:\n  a: {normal: [0, -1]}", 2, "standard deviation"),
        ("parameters:\n  a: {integer: [0.5, 2]}", 2, r"\[lowest, highest\]"),
        ("parameters:\n  a: {choice: []}", 2, "at least 1 expected"),
        ("parameters:\n  b: 1\n  a: [1, .nan]", 3, "finite"),
        ("parameters:\n  a: {uniform: [0, .inf]}", 2, "write it as"),
        ("parameters:\n  a: 2024-01-01", 2, "quote it"),
    ],
)
def test_what_is_wrong_is_reported_with_its_line(tmp_path: Path, text: str, line: int, words: str) -> None:
    with pytest.raises(InputError, match=words) as refusal:
        load(tmp_path, text)
    where = refusal.value.problems[0].where
    assert where is not None
    assert where.line == line


def test_everything_that_is_wrong_is_reported_at_once(tmp_path: Path) -> None:
    with pytest.raises(InputError) as refusal:
        load(tmp_path, "parameters:\n  a: {uniform: 3}\n  b: .nan\nc: 1\n")
    assert len(refusal.value.problems) == 3


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        Experiment.load(tmp_path / "none.yaml")
