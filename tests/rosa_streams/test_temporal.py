"""Metric temporal logic: what formulas mean, when verdicts are known, and what is refused."""

from __future__ import annotations

import math

import pytest

from rosa_core import InputError
from rosa_streams.temporal import Monitor, Verdict, parse_formula, variables

TRUE, FALSE, UNKNOWN = Verdict.TRUE, Verdict.FALSE, Verdict.UNKNOWN


def verdicts(formula: str, *states: tuple[float, dict[str, object]]) -> list[Verdict]:
    monitor = Monitor(formula)
    return [monitor.step(state, time) for time, state in states]


def test_a_response_is_violated_at_its_deadline_and_not_before() -> None:
    monitor = Monitor("G (lost -> F[0,5] found)")
    assert monitor.step({"lost": False, "found": False}, 0.0) is UNKNOWN
    assert monitor.step({"lost": True, "found": False}, 1.0) is UNKNOWN
    assert monitor.step({"lost": False, "found": False}, 5.9) is UNKNOWN
    assert monitor.tick(5.999) is UNKNOWN
    assert monitor.tick(6.0) is FALSE
    assert monitor.known_at == 6.0


def test_a_window_holds_both_its_ends_exactly() -> None:
    at_the_edge = [(0.1, {"p": False}), (0.3, {"p": True})]
    assert verdicts("F[0,0.2] p", *at_the_edge)[-1] is TRUE, "0.1 + 0.2 is 0.3 here"
    assert verdicts("F[0.2,1] p", *at_the_edge)[-1] is TRUE
    assert verdicts("F[0,0.199999] p", *at_the_edge)[-1] is FALSE
    assert verdicts("F[0.200001,1] p", *at_the_edge)[-1] is UNKNOWN
    epoch = [(1_700_000_000.1, {"p": False}), (1_700_000_000.3, {"p": True})]
    assert verdicts("F[0,0.2] p", *epoch)[-1] is TRUE


def test_always_is_known_at_the_end_of_its_window() -> None:
    assert verdicts("G[0,2] x > 3", (0, {"x": 4}), (1, {"x": 4}), (2, {"x": 4})) == [UNKNOWN, UNKNOWN, TRUE]
    assert verdicts("G[0,2] x > 3", (0, {"x": 4}), (1, {"x": 4}), (7, {"x": 0})) == [UNKNOWN, UNKNOWN, TRUE]


def test_until_needs_its_left_side_up_to_but_not_at_the_state_that_fulfils_it() -> None:
    assert verdicts("p U q", (0, {"p": True, "q": False}), (1, {"p": False, "q": True}))[-1] is TRUE
    assert verdicts("p U q", (0, {"p": False, "q": False}))[-1] is FALSE
    assert verdicts("p U[1,2] q", (0, {"p": False, "q": True}))[-1] is FALSE, "q is outside the window"


def test_past_operators_look_back() -> None:
    trace = [(0, {"p": True, "q": False}), (1, {"p": False, "q": True}), (3, {"p": True, "q": True})]
    assert verdicts("G[3,3] O[3,3] p", *trace)[-1] is TRUE
    assert verdicts("F[3,3] H[0,2] q", *trace)[-1] is TRUE
    assert verdicts("F[3,3] H[0,3] q", *trace)[-1] is FALSE
    assert verdicts("F[3,3] (q S[2,3] p)", *trace)[-1] is TRUE


def test_a_verdict_stays() -> None:
    assert verdicts("F[0,1] p", (0, {"p": True}), (5, {"p": False})) == [TRUE, TRUE]


def test_unknown_values_are_unknown_and_never_cancel_each_other() -> None:
    assert verdicts("p", (0, {})) == [UNKNOWN]
    assert verdicts("x > 3", (0, {"x": math.nan})) == [UNKNOWN]
    assert verdicts("F[0,1] p and not p", (0, {}), (2, {}))[-1] is UNKNOWN
    assert verdicts("G[0,1] p", (0, {}), (1, {"p": False}))[-1] is FALSE
    assert verdicts("F[0,1] p", (0, {}), (1, {"p": True}))[-1] is TRUE


@pytest.mark.parametrize(
    ("formula", "state", "holds"),
    [
        ("mode == 'attack'", {"mode": "attack"}, True),
        ("mode != 'attack'", {"mode": "defend"}, True),
        ("mode matches 'att*'", {"mode": "attack"}, True),
        ("mode matches '*ck'", {"mode": "attack"}, True),
        ("mode matches 'a?t*k*'", {"mode": "attack"}, True),
        ("mode matches 'att'", {"mode": "attack"}, False),
        ("mode matches '*a*a*a*a*b'", {"mode": "a" * 500}, False),
        ("x > y", {"x": 2, "y": 1}, True),
        ("3 < x", {"x": 4}, True),
        ("x == -1.5e1", {"x": -15}, True),
        ("robot.ready", {"robot.ready": 1}, True),
        ("ready", {"ready": "false"}, False),
        ("ready == true", {"ready": 1}, True),
        ("ready != false", {"ready": False}, False),
        ("ready = false and not done", {"ready": False, "done": 0}, True),
        ("x > 1 & !(x > 5) | false", {"x": 3}, True),
        ("always[0,0] x > 1 implies eventually[0,0 ms] x > 2", {"x": 3}, True),
    ],
)
def test_atoms_and_spellings(formula: str, state: dict[str, object], holds: bool) -> None:
    assert verdicts(formula, (0, state), (1, state))[-1] is (TRUE if holds else FALSE)


def test_operators_bind_as_the_docs_say() -> None:
    assert str(parse_formula("a -> b -> c or d and not e U f")) == "a -> (b -> (c or (d and (not e U f))))"
    assert str(parse_formula("G a U b")) == "G a U b"
    assert str(parse_formula("G[0,1.5] (a and b) S[2,inf) c")) == "G[0,1.5] (a and b) S[2,inf] c"
    assert variables(parse_formula("x > 3 -> distance(ball, goal) < y")) == ("x", "ball", "goal", "y")


@pytest.mark.parametrize(
    ("text", "said", "column"),
    [
        ("G[5,2] x", "ends before it begins", 2),
        ("G x >", "expected a formula", 6),
        ("x > 3 and", "expected a formula", 10),
        ("F[0,-1] x", "at least 0", 5),
        ("F[0,1e-7] x", "whole number of microseconds", 5),
        ("x ? 3", "cannot read '?'", 3),
        ("foo(a, b)", "unknown relation 'foo'", 1),
        ("3 < 4", "needs a variable", 1),
        ("x < 'a'", "compared with == and !=", 1),
        ("mode == 'attack", "closing quote", 9),
        ("x > 3 y", "expected an operator or the end", 7),
        ("(x > 3", "expected ')'", 7),
        ("U x", "expected a formula, found 'U'", 1),
        ("", "expected a formula", 1),
        ("mode matches 3", "expected a pattern in quotes", 14),
        ("F[0,1e999] x", "not beyond all measure", 5),
    ],
)
def test_a_formula_that_cannot_be_read_is_an_error_that_points_at_the_place(text: str, said: str, column: int) -> None:
    with pytest.raises(InputError, match="column") as caught:
        parse_formula(text)
    lines = str(caught.value).splitlines()
    assert said in lines[0]
    assert f"column {column}" in lines[0]
    assert lines[2].index("^") - 4 == column - 1


@pytest.mark.parametrize(
    "text",
    ["(" * 10_000, "not " * 4000 + "p", "G " * 9000 + "p", "p U " * 4000 + "p", "p -> " * 3000 + "p", "p" * 30_000],
)
def test_hostile_formulas_are_refused_at_once(text: str) -> None:
    with pytest.raises(InputError):
        parse_formula(text)


def test_a_long_flat_formula_is_no_problem() -> None:
    formula = " and ".join(f"x{number} > 0" for number in range(1500))
    assert verdicts(formula, (0, {f"x{number}": 1 for number in range(1500)})) == [TRUE]


def test_values_that_cannot_be_compared_are_an_error_that_names_the_atom() -> None:
    with pytest.raises(InputError, match="'x > 3' compares numbers, and one of its values is 'high'"):
        Monitor("x > 3").step({"x": "high"}, 0)
    with pytest.raises(InputError, match="'p' stands for true or false"):
        Monitor("p").step({"p": "perhaps"}, 0)


def test_times_must_grow() -> None:
    monitor = Monitor("G p")
    monitor.step({"p": True}, 1.0)
    with pytest.raises(InputError, match="times grow"):
        monitor.step({"p": True}, 1.0)
    with pytest.raises(InputError, match="times grow"):
        monitor.tick(0.5)
    with pytest.raises(InputError, match="finite"):
        monitor.step({"p": True}, math.inf)
    with pytest.raises(InputError, match="times grow"):
        Monitor("G p").run([0.0, 1.0, 1.0], {"p": [1, 1, 1]})


def test_a_day_of_samples_is_monitored_in_flat_memory() -> None:
    """24 h at 10 Hz: what is remembered and what is open after the first hour is not exceeded later."""
    count = 24 * 3600 * 10
    monitor = Monitor("G (p -> (F[0,30] q and not (r U[2,60] s)))")
    sizes, opens = [], []
    for hour in range(24):
        indices = range(hour * 36_000, (hour + 1) * 36_000)
        columns = {
            "p": [index % 77 == 0 for index in indices],
            "q": [index % 200 == 0 for index in indices],
            "r": [index % 5 != 0 for index in indices],
            "s": [False for _ in indices],
        }
        assert monitor.run([index / 10 for index in indices], columns) is UNKNOWN
        sizes.append(monitor.size)
        opens.append(monitor.open_obligations)
    assert count == 864_000
    assert max(sizes[2:]) <= max(sizes[:2]) + 100_000
    assert max(opens) < 100


def test_regions_and_points_are_related() -> None:
    pytest.importorskip("shapely")
    regions = {"half": [(0, 0), (4, 0), (4, 6), (0, 6)], "goal": "POINT (0 3)"}
    monitor = Monitor("G[0,2] (inside(ball, half) and distance(ball, goal) > 1)", regions)
    monitor.step({"ball": (2, 3)}, 0)
    assert monitor.step({"ball": "POINT (0.5 3)"}, 1) is FALSE
    assert Monitor("inside(ball, half)", regions).step({}, 0) is UNKNOWN
    with pytest.raises(InputError, match="no point or region"):
        Monitor("inside(ball, half)", regions).step({"ball": "somewhere"}, 0)


def test_exactly_one_relation_of_rcc8_holds_between_two_regions() -> None:
    pytest.importorskip("shapely")
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    others = {
        "DC": [(9, 9), (10, 9), (10, 10)],
        "EC": [(4, 0), (8, 0), (8, 4), (4, 4)],
        "PO": [(2, 2), (6, 2), (6, 6), (2, 6)],
        "EQ": [(4, 4), (0, 4), (0, 0), (4, 0)],
        "TPPi": [(0, 0), (2, 0), (2, 2), (0, 2)],
        "NTPPi": [(1, 1), (2, 1), (2, 2), (1, 2)],
        "TPP": [(0, 0), (8, 0), (8, 8), (0, 8)],
        "NTPP": [(-1, -1), (8, -1), (8, 8), (-1, 8)],
    }
    for name, other in others.items():
        holding = [
            relation for relation in others if Monitor(f"{relation}(a, b)", {"a": square}).step({"b": other}, 0) is TRUE
        ]
        assert holding == [name]
