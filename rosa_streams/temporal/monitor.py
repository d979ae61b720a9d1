"""Monitors: formulas evaluated state by state, with a verdict as early as it can be known."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from enum import StrEnum
from typing import Any

from rosa_streams.errors import StreamError
from rosa_streams.temporal.compiling import compiled
from rosa_streams.temporal.evaluation import evaluator
from rosa_streams.temporal.formula import TICKS_PER_SECOND, Formula
from rosa_streams.temporal.parsing import parse_formula
from rosa_streams.temporal.past import Since
from rosa_streams.temporal.progression import FALSE, MOST_REMEMBERED, TRUE, Node, PastValues, Progression, Values
from rosa_streams.temporal.state import State


class Verdict(StrEnum):
    """What is known of a formula."""

    TRUE = "true"
    FALSE = "false"
    UNKNOWN = "unknown"


_VERDICTS = {TRUE: Verdict.TRUE, FALSE: Verdict.FALSE}


class Monitor:
    """A formula, evaluated at the first state that is given; see docs/streams.md for the semantics.

    Args:
        formula: as text, or parsed.
        regions: for spatial atoms: regions by name, each a geometry of shapely, a list of points, or WKT.

    Raises:
        FormulaError: if the formula cannot be read.

    >>> monitor = Monitor("lost -> F[0,5] found")
    >>> monitor.step({"lost": True, "found": False}, 10.0).value
    'unknown'
    >>> monitor.tick(15.0).value, monitor.known_at
    ('false', 15.0)
    """

    def __init__(self, formula: str | Formula, regions: Mapping[str, Any] | None = None) -> None:
        self.formula = parse_formula(formula) if isinstance(formula, str) else formula
        parts = compiled(self.formula)
        self._root = parts.root
        self._evaluators = tuple(evaluator(atom, regions or {}) for atom in parts.atoms)
        self._progression = Progression(list(parts.untils))
        self._operands = tuple(parts.sinces)
        self._sinces = tuple(Since(each.low, each.high) for each in parts.sinces)
        self._weighed = tuple((evaluate, 3**number) for number, evaluate in enumerate(self._evaluators))
        self._codes = 3 ** len(self._evaluators)
        self._values_of: dict[int, Values] = {}
        self._open_codes: dict[tuple[int, int], bool] = {}
        self._node: Node | None = None
        self._node_time = 0
        self._now: int | None = None
        self.verdict = Verdict.UNKNOWN
        self.known_at: float | None = None

    def step(self, state: State, time: float) -> Verdict:
        """Take a further state.

        Args:
            state: values by variable; a variable that is missing, None or NaN is unknown.
            time: in seconds, later than every time before; whole microseconds are kept.

        Raises:
            StreamError: if the time is not later, or not a number.
            FormulaError: if a value cannot be compared as the formula does.
        """
        ticks = _ticks(time)
        now = self._now
        if now is not None and ticks <= now:
            raise _not_later(time, now)
        code = 0
        for evaluate, power in self._weighed:
            value = evaluate(state)
            if value:
                code += power
            elif value is None:
                code += 2 * power
        self._now = ticks
        node = self._node
        if node is None or self._sinces:
            self._advance(ticks, 0 if now is None else ticks - now, code)
        else:
            following = node.steps.get((ticks - self._node_time) * self._codes + code)
            if following is None:
                self._advance(ticks, ticks - self._node_time, code)
            else:
                self._node, self._node_time = following, ticks
        if self.known_at is None and self._node in _VERDICTS:
            self._decide(time)
        return self.verdict

    def tick(self, time: float) -> Verdict:
        """Time has come to ``time`` and there are no further states up to it, so that deadlines pass.

        Raises:
            StreamError: if time would go back.
        """
        ticks = _ticks(time)
        if self._now is None:
            return self.verdict
        if ticks < self._now:
            raise _not_later(time, self._now)
        for since in self._sinces:
            since.elapse(self._progression, ticks - self._now)
        self._now = ticks
        if self._node is not None:
            self._node = self._progression.elapse(self._node, ticks - self._node_time)
            self._node_time = ticks
            if self.known_at is None and self._node in _VERDICTS:
                self._decide(time)
        return self.verdict

    def restart(self) -> None:
        """Evaluate the formula anew at the next state; what past operators have seen is kept."""
        self._node = None
        self.verdict = Verdict.UNKNOWN
        self.known_at = None

    def run(self, times: Sequence[float], columns: Mapping[str, Sequence[Any]]) -> Verdict:
        """Take many states at once, up to the verdict; the same as :meth:`step` on each, and faster.

        Args:
            times: in seconds, each later than the one before.
            columns: for each variable its value at each time; a column that is missing is unknown.

        Raises:
            StreamError, FormulaError: as :meth:`step` does.
        """
        from rosa_streams.temporal.columns import valuations

        if self._sinces or not len(times):
            return self._run_by_steps(times, columns)
        memos = valuations(self.formula, times, columns, self._codes, self._now)
        if memos is None:
            return self._run_by_steps(times, columns)
        start = 0
        if self._now is None or self._node is None:
            self.step({name: column[0] for name, column in columns.items()}, float(times[0]))
            start = 1
        self._run_fast(memos, times, start)
        return self.verdict

    @property
    def size(self) -> int:
        """How many nodes and steps are remembered: what memory goes by. It is bounded."""
        return self._progression.remembered

    @property
    def open_obligations(self) -> int:
        """How many obligations what remains has."""
        return 0 if self._node is None or self._node in _VERDICTS else max(1, len(self._node.children))

    def _run_by_steps(self, times: Sequence[float], columns: Mapping[str, Sequence[Any]]) -> Verdict:
        names = list(columns)
        for index, time in enumerate(times):
            if self.known_at is not None:
                break
            self.step({name: columns[name][index] for name in names}, float(time))
        return self.verdict

    def _run_fast(self, memos: Sequence[int], times: Sequence[float], start: int) -> None:
        node = self._node
        if node is None or self.known_at is not None:
            return
        if self._now is not None:
            node = self._progression.elapse(node, self._now - self._node_time)
        index, count = start, len(memos)
        codes, progression = self._codes, self._progression
        while index < count:
            following = node.steps.get(memos[index])
            if following is None:
                index, node = self._glide(node, memos, index)
                if index == count or node is TRUE or node is FALSE:
                    break
                memo = memos[index]
                elapsed, code = divmod(memo, codes)
                values = self._values(code)
                following = progression.step(node, elapsed, memo, (values, ()), values, ())
                if progression.remembered > MOST_REMEMBERED:
                    following = progression.start_memory_anew([following])[following]
            node = following
            if node is TRUE or node is FALSE:
                break
            index += 1
        last = min(index, count - 1)
        self._node, self._now = node, _ticks(float(times[last]))
        self._node_time = self._now
        if node in _VERDICTS:
            self._decide(float(times[last]))

    def _glide(self, node: Node, memos: Sequence[int], index: int) -> tuple[int, Node]:
        """Take states that leave a lone ``F[0,b] f`` or ``G[0,b] f`` as it is but for its window, without remembering
        each width of the window; returns the index of the first state that is not taken, or that decides."""
        if not self._progression.is_plain_window(node):
            return index, node
        codes, count, high = self._codes, len(memos), node.high or 0
        while index < count:
            elapsed, code = divmod(memos[index], codes)
            left = high - elapsed
            if left >= 0 and not self._leaves_open(node, code):
                break
            high = left
            if left < 1:
                break
            index += 1
        return index, self._progression.obligation(node.operator, 0, high, node.positive)

    def _can_wait(self, node: Node, elapsed: int, code: int) -> bool:
        """Whether a node need not be stepped yet: its window is relative to the time of its last step."""
        plain = self._progression.is_plain_window(node)
        return plain and (node.high or 0) - elapsed >= 1 and self._leaves_open(node, code)

    def _leaves_open(self, node: Node, code: int) -> bool:
        key = (node.operator, code)
        known = self._open_codes.get(key)
        if known is None:
            if len(self._open_codes) > MOST_REMEMBERED:
                self._open_codes.clear()
            known = self._open_codes[key] = self._progression.leaves_open(node, self._values(code))
        return known

    def _advance(self, ticks: int, elapsed: int, code: int) -> None:
        """Take a state whose outcome is not remembered; ``elapsed`` is since the node's time."""
        node, progression = self._node, self._progression
        values = self._values(code)
        if self._sinces:
            past = self._past_values(ticks, elapsed, values)
            key: Hashable = (values, past)
            memo: Hashable = (elapsed, key)
        else:
            past = ()
            key, memo = (values, past), elapsed * self._codes + code
            if node is not None and self._can_wait(node, elapsed, code):
                return
        self._node = (
            progression.at_state(self._root, values, past)
            if node is None
            else progression.step(node, elapsed, memo, key, values, past)
        )
        self._node_time = ticks
        if progression.remembered > MOST_REMEMBERED:
            self._start_memory_anew()

    def _decide(self, time: float) -> None:
        if self._node is not None:
            self.verdict, self.known_at = _VERDICTS[self._node], time

    def _past_values(self, ticks: int, elapsed: int, values: Values) -> PastValues:
        past: PastValues = ()
        progression = self._progression
        for since, operands in zip(self._sinces, self._operands, strict=True):
            key = (values, past)
            memo = (elapsed, key)

            def over(node: Node, memo: Hashable = memo, key: Hashable = key, past: PastValues = past) -> Node:
                return progression.step(node, elapsed, memo, key, values, past)

            left = TRUE if operands.left is None else progression.at_state(operands.left, values, past)
            right = progression.at_state(operands.right, values, past)
            past = (*past, since.value(progression, ticks, over, left, right))
        return past

    def _values(self, code: int) -> Values:
        values = self._values_of.get(code)
        if values is None:
            digits = []
            rest = code
            for _ in self._evaluators:
                rest, digit = divmod(rest, 3)
                digits.append((False, True, None)[digit])
            if len(self._values_of) > MOST_REMEMBERED:
                self._values_of.clear()
            values = self._values_of[code] = tuple(digits)
        return values

    def _live(self) -> Iterator[Node]:
        if self._node is not None:
            yield self._node
        for since in self._sinces:
            yield from since.nodes()

    def _start_memory_anew(self) -> None:
        renewed = self._progression.start_memory_anew(self._live())
        if self._node is not None:
            self._node = renewed[self._node]
        for since in self._sinces:
            since.replace(renewed)


def _ticks(time: float) -> int:
    try:
        return round(time * TICKS_PER_SECOND)
    except (OverflowError, ValueError):
        raise StreamError(f"a time is a finite number of seconds, not {time}") from None


def _not_later(time: float, now: int) -> StreamError:
    return StreamError(f"times grow: {time:.9g} s comes after {now / TICKS_PER_SECOND:.9g} s")
