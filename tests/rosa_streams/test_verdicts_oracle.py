"""Verdicts of monitors against the naive semantics, on random formulas and traces."""

from __future__ import annotations

import random

import pytest

from rosa_streams.temporal import Formula, Monitor, Verdict, parse_formula
from rosa_streams.temporal import monitor as monitor_module
from rosa_streams.temporal.formula import Binary, Not, Timed, TimedBinary
from tests.rosa_streams.naive_semantics import ATOMS, Naive, a_formula, a_trace, an_interval

TRUTHS = {Verdict.TRUE: True, Verdict.FALSE: False, Verdict.UNKNOWN: None}


def check_one(rng: random.Random, formula: Formula, unknowns: float) -> int | None:
    """Compare every prefix of one trace. Returns by how many states the monitor was ahead, if it came to a verdict."""
    states, times = a_trace(rng, rng.randint(1, 14), unknowns=unknowns)
    monitor = Monitor(formula)
    decided: int | None = None
    for length in range(1, len(states) + 1):
        verdict = TRUTHS[monitor.step(states[length - 1], times[length - 1])]
        naive = Naive(states[:length], times[:length]).value(formula)
        if naive is not None:
            assert verdict == naive, (str(formula), states, times, length)
            return None if decided is None else length - decided
        if verdict is not None:
            # It knows more than the naive semantics of this prefix: then however the trace goes on, and whatever the
            # unknown values are, the naive semantics must come to the same.
            decided = length if decided is None else decided
            for _ in range(4):
                known = [
                    {"p": rng.random() < 0.5, "q": rng.random() < 0.5, "x": rng.randint(0, 3), **s} for s in states
                ]
                more, later = a_trace(rng, 25)
                later = [times[length - 1] + each - later[0] + 0.5 for each in later]
                end = Naive(known[:length] + more, times[:length] + later).value(formula)
                assert end in (None, verdict), (str(formula), known[:length] + more, times[:length] + later)
    return None


def check_many(seed: int, count: int, *, unknowns: float = 0.0, depth: int = 3) -> None:
    rng = random.Random(seed)
    for _ in range(count):
        check_one(rng, a_formula(rng, depth), unknowns)


@pytest.mark.parametrize("seed", range(2))
def test_no_verdict_is_wrong_or_late(seed: int) -> None:
    check_many(seed, 250)


def test_no_verdict_is_wrong_or_late_where_values_are_unknown() -> None:
    check_many(7, 250, unknowns=0.25)


@pytest.mark.parametrize("seed", range(3))
def test_no_verdict_is_wrong_or_late_where_windows_overlap(seed: int) -> None:
    """A window inside a window opens a further obligation at every state; of these, some follow from others."""
    rng = random.Random(seed)
    for _ in range(200):
        inner = Timed(rng.choice("FGFGO"), an_interval(rng), rng.choice(ATOMS))
        second = TimedBinary("U", an_interval(rng), rng.choice(ATOMS), rng.choice(ATOMS))
        other = Not(Timed(inner.operator, an_interval(rng), inner.operand))
        either = Binary(rng.choice(["and", "or", "->"]), inner, rng.choice([second, Not(second), other, *ATOMS]))
        check_one(rng, Timed(rng.choice("FG"), an_interval(rng), either), 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10, 15))
def test_no_verdict_of_ten_thousand_is_wrong_or_late(seed: int) -> None:
    check_many(seed, 1200)
    check_many(seed + 100, 500, unknowns=0.2)
    check_many(seed + 200, 300, depth=4)


def test_starting_memory_anew_changes_no_verdict(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(monitor_module, "MOST_REMEMBERED", 3)
    check_many(3, 200)


@pytest.mark.parametrize("seed", range(4))
def test_columns_at_once_give_the_verdict_of_state_by_state(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(60):
        formula = a_formula(rng, 3)
        states, times = a_trace(rng, 20)
        columns = {name: [state[name] for state in states] for name in ("p", "q", "x")}
        by_steps, at_once = Monitor(formula), Monitor(formula)
        cut = rng.randint(0, 5)
        for state, time in zip(states, times, strict=True):
            by_steps.step(state, time)
        at_once.run(times[:cut], {name: column[:cut] for name, column in columns.items()})
        at_once.run(times[cut:], {name: column[cut:] for name, column in columns.items()})
        assert (by_steps.verdict, by_steps.known_at) == (at_once.verdict, at_once.known_at), str(formula)


@pytest.mark.parametrize("seed", range(4))
def test_a_tick_between_states_changes_no_verdict_but_may_give_it_earlier(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(100):
        formula = a_formula(rng, 3)
        states, times = a_trace(rng, 14)
        plain, ticked = Monitor(formula), Monitor(formula)
        for index, (state, time) in enumerate(zip(states, times, strict=True)):
            plain.step(state, time)
            ticked.step(state, time)
            if index + 1 < len(times):
                ticked.tick(time + (times[index + 1] - time) * 0.5)
                ticked.tick(time + (times[index + 1] - time) * 0.75)
            if plain.known_at is not None:
                assert ticked.verdict == plain.verdict, str(formula)
                assert ticked.known_at is not None
                assert ticked.known_at <= plain.known_at


@pytest.mark.parametrize("seed", range(3))
def test_a_formula_reads_back_from_its_text(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(200):
        formula = a_formula(rng, 4)
        assert str(parse_formula(str(formula))) == str(formula)


@pytest.mark.parametrize("seed", range(3))
def test_a_restarted_monitor_says_of_each_state_what_holds_there(seed: int) -> None:
    """Formulas about the past have a verdict at every state."""
    rng = random.Random(seed)
    for text in ("O[0,1.5] p", "H[0.5,2] (p or q)", "p S[0,3] q", "q -> O[1,4] (p S x > 1)"):
        formula = parse_formula(text)
        states, times = a_trace(rng, 40)
        monitor, naive = Monitor(formula), Naive(states, times)
        for index, (state, time) in enumerate(zip(states, times, strict=True)):
            assert TRUTHS[monitor.step(state, time)] == naive.value(formula, index), (text, index)
            monitor.restart()
