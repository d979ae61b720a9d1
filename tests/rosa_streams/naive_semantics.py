"""The semantics of formulas as the docs state it, evaluated as it is written: slow, and obviously right."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import Any

from rosa_streams.temporal.formula import (
    TICKS_PER_SECOND,
    Binary,
    Comparison,
    Constant,
    Formula,
    Holds,
    Interval,
    Not,
    Number,
    Timed,
    TimedBinary,
    Variable,
)

Truth = bool | None


def both(*values: Truth) -> Truth:
    return False if False in values else None if None in values else True


def one(*values: Truth) -> Truth:
    return True if True in values else None if None in values else False


def opposite(value: Truth) -> Truth:
    return None if value is None else not value


class Naive:
    """The value of a formula at a state of a trace of which the end is not known (Kleene's three values)."""

    def __init__(self, states: Sequence[Mapping[str, Any]], times: Sequence[float]) -> None:
        self.states, self.times = states, [round(time * TICKS_PER_SECOND) for time in times]
        self._known: dict[tuple[Formula, int], Truth] = {}

    def value(self, formula: Formula, at: int = 0) -> Truth:
        key = (formula, at)
        if key not in self._known:
            self._known[key] = self._value(formula, at)
        return self._known[key]

    def _value(self, f: Formula, at: int) -> Truth:
        match f:
            case Constant():
                return f.value
            case Holds():
                return self.states[at].get(f.variable.name)
            case Comparison():
                assert isinstance(f.left, Variable)
                assert isinstance(f.right, Number)
                value = self.states[at].get(f.left.name)
                compared = {">": lambda a, b: a > b, "<=": lambda a, b: a <= b}[f.operator]
                return None if value is None else compared(value, f.right.value)
            case Not():
                return opposite(self.value(f.operand, at))
            case Binary():
                left, right = self.value(f.left, at), self.value(f.right, at)
                return {"and": both(left, right), "or": one(left, right), "->": one(opposite(left), right)}[f.operator]
            case Timed():
                name = {"F": "U", "O": "S", "G": "U", "H": "S"}[f.operator]
                if f.operator in "FO":
                    return self.value(TimedBinary(name, f.interval, Constant(True), f.operand), at)
                return opposite(self.value(TimedBinary(name, f.interval, Constant(True), Not(f.operand)), at))
            case TimedBinary(operator="U"):
                return self._until(f, at)
            case TimedBinary():
                return self._since(f, at)
        raise AssertionError(f)

    def _until(self, f: TimedBinary, at: int) -> Truth:
        found: list[Truth] = []
        for there in range(at, len(self.times)):
            if self._inside(f.interval, self.times[there] - self.times[at]):
                found.append(both(self.value(f.right, there), *(self.value(f.left, k) for k in range(at, there))))
        if f.interval.high is None or self.times[-1] - self.times[at] < f.interval.high:
            found.append(both(None, *(self.value(f.left, k) for k in range(at, len(self.times)))))
        return one(*found)

    def _since(self, f: TimedBinary, at: int) -> Truth:
        return one(
            *(
                both(self.value(f.right, there), *(self.value(f.left, k) for k in range(there + 1, at + 1)))
                for there in range(at + 1)
                if self._inside(f.interval, self.times[at] - self.times[there])
            )
        )

    @staticmethod
    def _inside(interval: Interval, distance: int) -> bool:
        return interval.low <= distance and (interval.high is None or distance <= interval.high)


ATOMS: tuple[Formula, ...] = (
    Holds(Variable("p")),
    Holds(Variable("q")),
    Comparison(Variable("x"), ">", Number(1)),
    Comparison(Variable("x"), "<=", Number(2)),
)


def a_formula(rng: random.Random, depth: int) -> Formula:
    if depth == 0 or rng.random() < 0.1:
        return rng.choice(ATOMS) if rng.random() < 0.97 else Constant(rng.random() < 0.5)
    kind = rng.random()
    inner = [a_formula(rng, depth - 1) for _ in range(2)]
    if kind < 0.12:
        return Not(inner[0])
    if kind < 0.4:
        return Binary(rng.choice(["and", "or", "->"]), *inner)
    if kind < 0.75:
        return Timed(rng.choice("GFGFHO"), an_interval(rng), inner[0])
    return TimedBinary(rng.choice("UUS"), an_interval(rng), *inner)


def an_interval(rng: random.Random) -> Interval:
    low = rng.choice([0, 0, 0, 500_000, 1_000_000, 2_500_000])
    high = None if rng.random() < 0.3 else low + rng.choice([0, 500_000, 1_000_000, 3_000_000])
    return Interval(low, high)


def a_trace(rng: random.Random, length: int, *, unknowns: float = 0.0) -> tuple[list[dict[str, Any]], list[float]]:
    now, times, states = rng.choice([0.0, 1.7e9]), [], []
    for _ in range(length):
        now += rng.choice([0.1, 0.5, 0.5, 0.5, 1.0, 2.0])
        times.append(now)
        state = {"p": rng.random() < 0.6, "q": rng.random() < 0.4, "x": rng.choice([0, 1, 2, 3])}
        states.append({name: value for name, value in state.items() if rng.random() >= unknowns})
    return states, times
