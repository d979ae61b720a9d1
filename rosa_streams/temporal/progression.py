"""Progression of formulas (Bacchus and Kabanza 1998): what remains to be seen, after each state.

What remains is a boolean combination of *obligations*: until-formulas whose windows are relative to the present state.
Nodes are hash-consed, so that with relative windows a periodic stream leads back to nodes that are known, and each node
remembers where a step leads: an automaton that is built as far as it is needed. Of two obligations of which one follows
from the other, one is dropped (``F[0,3] f`` and ``F[0,5] f`` is ``F[0,3] f``), which bounds what is kept.

Unknown atoms follow Kleene's strong three-valued logic: what remains of an unknown is ``UNKNOWN``, not a name, so
that two unknowns never cancel each other.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass
from typing import Final, TypeAlias

from rosa_streams.errors import FormulaError

MOST_OBLIGATIONS = 200_000
"""How many parts what remains may have."""

MOST_REMEMBERED = 100_000
"""How many nodes and steps are remembered before memory is started anew."""


class Node:
    """What remains to be seen. ``steps`` remembers where a step of the key (time, values) leads."""

    __slots__ = ("children", "high", "is_and", "low", "operator", "positive", "steps")

    def __init__(
        self,
        operator: int = -1,
        low: int = 0,
        high: int | None = None,
        positive: bool = True,
        is_and: bool = False,
        children: frozenset[Node] = frozenset(),
    ) -> None:
        self.operator = operator
        self.low = low
        self.high = high
        self.positive = positive
        self.is_and = is_and
        self.children = children
        self.steps: dict[Hashable, Node] = {}


TRUE: Final = Node()
FALSE: Final = Node()
UNKNOWN: Final = Node()
_CONSTANTS: Final = frozenset({TRUE, FALSE, UNKNOWN})
_NEGATED: Final = {TRUE: FALSE, FALSE: TRUE, UNKNOWN: UNKNOWN}


@dataclass(frozen=True, slots=True)
class AtomAt:
    """The atom of that number."""

    number: int


@dataclass(frozen=True, slots=True)
class PastAt:
    """The past operator of that number: its value at the present state."""

    number: int


@dataclass(frozen=True, slots=True)
class Fixed:
    """True or false."""

    value: bool


@dataclass(frozen=True, slots=True)
class Negation:
    """Not the operand."""

    operand: Static


@dataclass(frozen=True, slots=True)
class Junction:
    """All of the operands, or one of them."""

    is_and: bool
    operands: tuple[Static, ...]


@dataclass(frozen=True, slots=True)
class UntilAt:
    """The until-operator of that number, with its window."""

    number: int
    low: int
    high: int | None


Static: TypeAlias = AtomAt | PastAt | Fixed | Negation | Junction | UntilAt

Values: TypeAlias = tuple[bool | None, ...]
"""The values of the atoms at a state."""

PastValues: TypeAlias = tuple[Node, ...]
"""What remains to be seen of each past operator's value at a state."""


class Progression:
    """Makes, combines and steps nodes. One monitor has one.

    Args:
        untils: for each until-operator, its left and right operand; the left is None for ``F``, where it is true.
    """

    def __init__(self, untils: list[tuple[Static | None, Static]]) -> None:
        self._untils = untils
        self._obligations: dict[tuple[int, int, int | None, bool], Node] = {}
        self._junctions: dict[tuple[bool, frozenset[Node]], Node] = {}
        self._at_state: dict[tuple[int, Hashable], tuple[Node, Node]] = {}
        self.remembered = 0

    # -- making nodes --

    def obligation(self, operator: int, low: int, high: int | None, positive: bool) -> Node:
        """The until-formula of that operator, about states after the present one."""
        if high is not None and high < 1:
            return FALSE if positive else TRUE
        if low == 1:
            low = 0  # Further states are at least a tick later.
        key = (operator, low, high, positive)
        node = self._obligations.get(key)
        if node is None:
            self.remembered += 1
            node = self._obligations[key] = Node(operator, low, high, positive)
        return node

    def junction(self, is_and: bool, operands: Iterable[Node]) -> Node:
        """All of the operands, or one of them, in as few parts as simple rules give."""
        absorbing, neutral = (FALSE, TRUE) if is_and else (TRUE, FALSE)
        parts: set[Node] = set()
        for operand in operands:
            if operand is absorbing:
                return absorbing
            if operand is neutral:
                continue
            if operand.children and operand.is_and == is_and:
                parts |= operand.children
            else:
                parts.add(operand)
        if len(parts) > 1:
            simplified = self._simplified(is_and, parts)
            if simplified is None:
                return absorbing
            parts = simplified
        if len(parts) < 2:
            return next(iter(parts), neutral)
        return self._junction(is_and, frozenset(parts))

    def _junction(self, is_and: bool, children: frozenset[Node]) -> Node:
        key = (is_and, children)
        node = self._junctions.get(key)
        if node is None:
            if len(children) > MOST_OBLIGATIONS:
                raise FormulaError(f"more than {MOST_OBLIGATIONS} obligations are open at once")
            self.remembered += 1 + len(children) // 8
            node = self._junctions[key] = Node(is_and=is_and, children=children)
        return node

    def negation(self, node: Node) -> Node:
        """Not the node."""
        if node in _CONSTANTS:
            return _NEGATED[node]
        if node.children:
            return self.junction(not node.is_and, [self.negation(child) for child in node.children])
        return self.obligation(node.operator, node.low, node.high, not node.positive)

    # -- simplifying --

    def _simplified(self, is_and: bool, parts: set[Node]) -> set[Node] | None:
        """The parts without those that follow from others; None if together they are absorbing."""
        groups: dict[int, tuple[list[Node], list[Node]]] = {}
        nested: list[Node] = []
        for part in parts:
            if part.children:
                nested.append(part)
            elif part.operator >= 0:
                groups.setdefault(part.operator, ([], []))[not part.positive].append(part)
        kept = parts
        for positive, negative in groups.values():
            if len(positive) > 1:
                kept = kept - _dropped(positive, keep_narrow=is_and)
            if len(negative) > 1:
                kept = kept - _dropped(negative, keep_narrow=not is_and)
            if positive and negative and _contradict(is_and, positive, negative):
                return None
        if nested and len(kept) > 1 and len(nested) * len(kept) < 1000:
            # Absorption: A and (A or B) is A.
            kept = {part for part in kept if not (part.children and not part.children.isdisjoint(kept))}
        return kept

    # -- evaluating at a state --

    def at_state(self, formula: Static, values: Values, past: PastValues) -> Node:
        """What remains of a formula whose present state has these values."""
        if isinstance(formula, AtomAt):
            value = values[formula.number]
            return UNKNOWN if value is None else TRUE if value else FALSE
        if isinstance(formula, PastAt):
            return past[formula.number]
        if isinstance(formula, Fixed):
            return TRUE if formula.value else FALSE
        if isinstance(formula, Negation):
            return self.negation(self.at_state(formula.operand, values, past))
        if isinstance(formula, Junction):
            return self.junction(formula.is_and, [self.at_state(each, values, past) for each in formula.operands])
        return self._until_now(formula.number, formula.low, formula.high, True, (values, past), values, past)

    def _until_now(
        self, number: int, low: int, high: int | None, positive: bool, key: Hashable, values: Values, past: PastValues
    ) -> Node:
        """What remains of an until-formula, its window relative to the present state, after that state."""
        operands = self._at_state.get((number, key))
        if operands is None:
            left, right = self._untils[number]
            self.remembered += 1
            operands = self._at_state[number, key] = (
                TRUE if left is None else self.at_state(left, values, past),
                self.at_state(right, values, past),
            )
        before, reached = operands
        if before is TRUE and (reached is FALSE or low > 0):
            return self.obligation(number, low, high, positive)
        later = self.obligation(number, low, high, True) if before is not FALSE else FALSE
        if before is not TRUE:
            later = self.junction(True, (before, later))
        if low <= 0 and reached is not FALSE:
            later = TRUE if reached is TRUE else self.junction(False, (reached, later))
        return later if positive else self.negation(later)

    # -- stepping --

    def step(self, node: Node, elapsed: int, memo: Hashable, key: Hashable, values: Values, past: PastValues) -> Node:
        """What remains after a further state.

        Args:
            node: what remained after the state before.
            elapsed: ticks since then.
            memo: stands for ``elapsed`` and ``key``.
            key: stands for ``values`` and ``past``: equal keys mean equal values.
            values, past: of the atoms and the past operators at the new state.
        """
        if node in _CONSTANTS:
            return node
        known = node.steps.get(memo)
        if known is None:
            if node.children:
                known = self.junction(
                    node.is_and, [self.step(child, elapsed, memo, key, values, past) for child in node.children]
                )
            else:
                known = self._step_obligation(node, elapsed, key, values, past)
            self.remembered += 1
            node.steps[memo] = known
        return known

    def _step_obligation(self, node: Node, elapsed: int, key: Hashable, values: Values, past: PastValues) -> Node:
        low, high = node.low - elapsed, node.high
        if high is not None:
            high -= elapsed
            if high < 0:
                return FALSE if node.positive else TRUE
        return self._until_now(node.operator, max(low, 0), high, node.positive, key, values, past)

    def elapse(self, node: Node, elapsed: int) -> Node:
        """What remains when time passes without a state."""
        if node in _CONSTANTS or elapsed == 0:
            return node
        if node.children:
            return self.junction(node.is_and, [self.elapse(child, elapsed) for child in node.children])
        high = None if node.high is None else node.high - elapsed
        return self.obligation(node.operator, max(node.low - elapsed, 0), high, node.positive)

    def is_plain_window(self, node: Node) -> bool:
        """Whether the node is a lone ``F[0,b] f`` or its negation."""
        return node.operator >= 0 and node.low == 0 and node.high is not None and self._untils[node.operator][0] is None

    def leaves_open(self, node: Node, values: Values) -> bool:
        """Whether a state with these values leaves a plain window as it is but for its width."""
        return self.at_state(self._untils[node.operator][1], values, ()) is FALSE

    # -- memory --

    def start_memory_anew(self, live: Iterable[Node]) -> dict[Node, Node]:
        """Discard what is remembered; returns the nodes that stand in for the live ones."""
        self._obligations, self._junctions, self._at_state = {}, {}, {}
        self.remembered = 0
        renewed: dict[Node, Node] = {}

        def renew(node: Node) -> Node:
            if node in _CONSTANTS:
                return node
            if node not in renewed:
                renewed[node] = (
                    self._junction(node.is_and, frozenset(map(renew, node.children)))
                    if node.children
                    else self.obligation(node.operator, node.low, node.high, node.positive)
                )
            return renewed[node]

        return {node: renew(node) for node in live}


def _dropped(group: list[Node], *, keep_narrow: bool) -> set[Node]:
    """Those of one operator's obligations whose window contains (or is in) the window of another."""
    dropped: set[Node] = set()
    if keep_narrow:
        # From narrow to wide: one with a lower bound no higher and an upper no lower than a kept one is dropped.
        ordered = sorted(group, key=lambda node: (-node.low, _high(node)))
        narrowest: float | None = None
        for node in ordered:
            if narrowest is not None and _high(node) >= narrowest:
                dropped.add(node)
            else:
                narrowest = _high(node)
        return dropped
    widest: float | None = None
    for node in sorted(group, key=lambda node: (node.low, -_high(node))):
        if widest is not None and _high(node) <= widest:
            dropped.add(node)
        else:
            widest = _high(node)
    return dropped


def _contradict(is_and: bool, positive: list[Node], negative: list[Node]) -> bool:
    """Whether ``U[narrow]`` and ``not U[wide]`` stand together (in a disjunction: ``U[wide]``, ``not U[narrow]``)."""
    pairs: Callable[[Node, Node], bool] = _within if is_and else lambda first, second: _within(second, first)
    return any(pairs(one, other) for one in positive[:64] for other in negative[:64])


def _within(inner: Node, outer: Node) -> bool:
    return outer.low <= inner.low and _high(inner) <= _high(outer)


def _high(node: Node) -> float:
    return float("inf") if node.high is None else node.high
