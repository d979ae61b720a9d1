"""Past operators: what is kept of earlier states so that ``f S g`` is known at each state."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator

from rosa_streams.errors import FormulaError
from rosa_streams.temporal.progression import FALSE, MOST_OBLIGATIONS, TRUE, UNKNOWN, Node, Progression

Step = Callable[[Node], Node]


class Since:
    """``f S[low,high] g`` at each state of a stream.

    For each earlier state, what remains of "g there, and f ever since" is kept until its window has passed. Of the
    states in the window, a later one at which this is true makes the earlier ones needless, so that an open window, and
    one that begins at 0, keeps a single state.
    """

    def __init__(self, low: int, high: int | None) -> None:
        self.low = low
        self.high = high
        self._young: deque[tuple[int, Node]] = deque()
        self._ripe: deque[tuple[int, Node]] = deque()
        self._all_known = True

    def value(self, progression: Progression, now: int, step: Step, left: Node, right: Node) -> Node:
        """The value at a new state.

        Args:
            progression: combines nodes.
            now: ticks.
            step: takes what remained of an earlier state over the new state.
            left, right: what remains of f and g at the new state.
        """
        if left is FALSE:
            self._young.clear()
            self._ripe.clear()
        else:
            self._carry_over(progression, step, left)
        if right is not FALSE:
            self._young.append((now, right))
            self._all_known &= right is TRUE or right is UNKNOWN
            if len(self._young) > MOST_OBLIGATIONS:
                raise FormulaError(f"a past operator would have to keep more than {MOST_OBLIGATIONS} states")
        self._ripen(progression, now)
        return progression.junction(False, [node for _, node in self._ripe])

    def nodes(self) -> Iterator[Node]:
        """What is kept."""
        for entries in (self._young, self._ripe):
            yield from (node for _, node in entries)

    def replace(self, renewed: dict[Node, Node]) -> None:
        """Keep these nodes instead."""
        for entries in (self._young, self._ripe):
            for index, (time, node) in enumerate(entries):
                entries[index] = (time, renewed[node])

    def elapse(self, progression: Progression, elapsed: int) -> None:
        """Time passes without a state."""
        for entries in (self._young, self._ripe):
            for index, (time, node) in enumerate(entries):
                entries[index] = (time, progression.elapse(node, elapsed))

    def _carry_over(self, progression: Progression, step: Step, left: Node) -> None:
        if left is TRUE and self._all_known:
            return
        self._all_known = True
        for entries in (self._young, self._ripe):
            kept = [(time, progression.junction(True, (step(node), left))) for time, node in entries]
            entries.clear()
            entries.extend((time, node) for time, node in kept if node is not FALSE)
            self._all_known &= all(node is TRUE or node is UNKNOWN for _, node in entries)

    def _ripen(self, progression: Progression, now: int) -> None:
        ripe = self._ripe
        while self._young and now - self._young[0][0] >= self.low:
            time, node = self._young.popleft()
            if node is TRUE:
                ripe.clear()
            elif node is UNKNOWN:
                while ripe and ripe[-1][1] is UNKNOWN:
                    ripe.pop()
            ripe.append((time, node))
        if self.high is not None:
            while ripe and now - ripe[0][0] > self.high:
                ripe.popleft()
        elif len(ripe) > 1:
            joined = progression.junction(False, [node for _, node in ripe])
            ripe.clear()
            ripe.append((now, joined))
