"""What would have to change for an element to be feasible again: all of several changes, or one of them.

The remedy follows the rules downwards (see :mod:`rosa_core.inference.rules`): constraints must be satisfied, failed
components must recover, and one design or configuration of each function or component must become feasible. It is
simplified: bounds on the same measure become one, and what another remedy brings about anyway is not repeated.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import singledispatch

from rosa_core.inference.network import (
    ActionNode,
    ComponentNode,
    ConfigurationNode,
    ConstraintNode,
    DesignNode,
    FunctionNode,
    Node,
)
from rosa_core.inference.reasoner import Reasoner
from rosa_core.model.elements import ConstraintOperator
from rosa_core.model.status import Status

_MOST_SHOWN = 5
"""How many alternatives are written out; of more only the number."""


@dataclass(frozen=True, slots=True)
class Bound:
    """One end of what a measure may be; ``reached``: the value itself will do."""

    value: float
    reached: bool


@dataclass(frozen=True, slots=True)
class MeasureWithin:
    """A measure must come to lie within bounds; None is no bound. ``measured`` is its latest value."""

    measure: str
    least: Bound | None
    most: Bound | None
    measured: float | None

    def __str__(self) -> str:
        ends = [f"{'>=' if b.reached else '>'} {_plain(b.value)}" for b in (self.least,) if b]
        ends += [f"{'<=' if b.reached else '<'} {_plain(b.value)}" for b in (self.most,) if b]
        return f"{self.measure} must be {' and '.join(ends)}" + (
            "" if self.measured is None else f" (is {_plain(self.measured)})"
        )

    @property
    def is_empty(self) -> bool:
        """Whether no value lies within the bounds."""
        low, high = self.least, self.most
        if low is None or high is None:
            return False
        return low.value > high.value or (low.value == high.value and not (low.reached and high.reached))

    @property
    def is_met(self) -> bool:
        """Whether the measured value lies within them already."""
        if self.measured is None:
            return False
        here = MeasureWithin(self.measure, Bound(self.measured, True), Bound(self.measured, True), None)
        return not _both(self, here).is_empty


@dataclass(frozen=True, slots=True)
class Recovery:
    """A failed component must work again."""

    component: str

    def __str__(self) -> str:
        return f"component {self.component} must recover"


@dataclass(frozen=True, slots=True)
class Impossible:
    """Nothing that can happen at run time helps, and why."""

    reason: str

    def __str__(self) -> str:
        return self.reason


@dataclass(frozen=True, slots=True)
class AllOf:
    """Every part must come about."""

    parts: tuple[Remedy, ...]

    def __str__(self) -> str:
        return " and ".join(f"({part})" if isinstance(part, AnyOf) else str(part) for part in self.parts)


@dataclass(frozen=True, slots=True)
class AnyOf:
    """One of the parts must come about."""

    parts: tuple[Remedy, ...]

    def __str__(self) -> str:
        recoveries = [part.component for part in self.parts if isinstance(part, Recovery)]
        if len(recoveries) == len(self.parts) <= _MOST_SHOWN:
            return f"one of the components {', '.join(recoveries)} must recover"
        shown = [str(part) for part in self.parts[:_MOST_SHOWN]]
        more = len(self.parts) - _MOST_SHOWN
        if more > 0:
            shown.append(f"one of {more} more")
        return "either " + ", or ".join(shown)


Leaf = MeasureWithin | Recovery | Impossible
Remedy = Leaf | AllOf | AnyOf


def find_remedy(reasoner: Reasoner, node: Node) -> Remedy | None:
    """What must change for a node to be neither unfeasible nor failed.

    Args:
        reasoner: what the node is in.
        node: an element with a status.

    Returns:
        the remedy, as simple as it can be said; None if the node is neither.
    """
    if node.status not in (Status.UNFEASIBLE, Status.FAILURE):
        return None
    return _Finder(reasoner).of(node)


class _Finder:
    """Finds remedies; what several elements have in common is worked out once."""

    def __init__(self, reasoner: Reasoner) -> None:
        self._reasoner = reasoner
        self._known: dict[Node, Remedy] = {}

    def of(self, node: Node) -> Remedy:
        if node not in self._known:
            self._known[node] = all_of([*self._constraints(node), *_below(node, self)])
        return self._known[node]

    def bad(self, nodes: Iterable[Node]) -> list[Remedy]:
        """The remedies of those that are unfeasible or failed."""
        return [self.of(node) for node in nodes if node.status in (Status.UNFEASIBLE, Status.FAILURE)]

    def _constraints(self, node: Node) -> list[Remedy]:
        """The violated constraints, and the satisfied ones that must not be violated by fixing them."""
        constraints = self._reasoner.constraints_on.get(node, [])
        measures = {c.measure for c in constraints if c.status is Status.VIOLATED}
        return [_within(c) for c in constraints if c.measure in measures and c.constraint.value is not None]


@singledispatch
def _below(node: Node, _finder: _Finder) -> list[Remedy]:
    """What is wrong with the elements that the node depends on."""
    raise TypeError(f"no rule makes a {type(node).__name__} feasible")


@_below.register
def _configuration(_node: ConfigurationNode, _finder: _Finder) -> list[Remedy]:
    return []


@_below.register
def _component(node: ComponentNode, finder: _Finder) -> list[Remedy]:
    remedies: list[Remedy] = [Recovery(node.name)] if node.failed_since is not None else []
    if node.options and all(option.status is Status.UNFEASIBLE for option in node.options):
        remedies.append(any_of(finder.bad(node.options)))
    return remedies


@_below.register
def _design(node: DesignNode, finder: _Finder) -> list[Remedy]:
    return finder.bad(node.members)


@_below.register
def _function(node: FunctionNode, finder: _Finder) -> list[Remedy]:
    if not node.options:
        return [Impossible(f"no design solves function {node.name}: the model needs one")]
    return [any_of(finder.bad(node.options))]


@_below.register
def _action(node: ActionNode, finder: _Finder) -> list[Remedy]:
    return finder.bad(node.members)


def _within(node: ConstraintNode) -> MeasureWithin:
    compare, value = node.constraint.operator, node.constraint.value
    if value is None:
        raise ValueError(f"{node.name} has no value, so that nothing violates it")
    reached = compare in (ConstraintOperator.GREATER_OR_EQUAL, ConstraintOperator.LESS_OR_EQUAL)
    bound = Bound(value, reached)
    if compare in (ConstraintOperator.GREATER, ConstraintOperator.GREATER_OR_EQUAL):
        return MeasureWithin(node.measure.name, bound, None, node.measure.value)
    return MeasureWithin(node.measure.name, None, bound, node.measure.value)


def _both(one: MeasureWithin, other: MeasureWithin) -> MeasureWithin:
    lows = [bound for bound in (one.least, other.least) if bound]
    highs = [bound for bound in (one.most, other.most) if bound]
    return MeasureWithin(
        one.measure,
        max(lows, key=lambda bound: (bound.value, not bound.reached), default=None),
        min(highs, key=lambda bound: (bound.value, bound.reached), default=None),
        one.measured,
    )


def _plain(number: float) -> str:
    """As short as it can be without reading as another number: 0.2499999 below a limit of 0.25 is not 0.25."""
    short = f"{number:g}"
    return short if float(short) == number else repr(number)


# -- simplifying --


def all_of(parts: Iterable[Remedy]) -> Remedy:
    """All of them, as simply as it can be said."""
    ranges: dict[str, MeasureWithin] = {}
    leaves: dict[Remedy, None] = {}
    choices: dict[AnyOf, None] = {}
    for part in _flat(parts, AllOf):
        if isinstance(part, MeasureWithin):
            known = ranges.get(part.measure)
            ranges[part.measure] = part if known is None else _both(known, part)
        elif isinstance(part, AnyOf):
            choices[part] = None
        else:
            leaves[part] = None
    for part in (*ranges.values(), *leaves):
        if isinstance(part, Impossible):
            return part
        if isinstance(part, MeasureWithin) and part.is_empty:
            return Impossible(f"constraints contradict each other: {part}")
    needed: list[Remedy] = [part for part in ranges.values() if not part.is_met]
    needed.extend(leaves)
    certain = [*ranges.values(), *leaves]
    for choice in choices:
        left = any_of(_without(option, certain) for option in choice.parts)
        if isinstance(left, Impossible):
            return left
        if not isinstance(left, AnyOf):
            # Only one way is left, which is certain now, and may settle other choices.
            return all_of([*certain, *_parts(left), *(other for other in choices if other != choice)])
        needed.append(left)
    return needed[0] if len(needed) == 1 else AllOf(tuple(needed))


def any_of(parts: Iterable[Remedy]) -> Remedy:
    """One of them, without those that ask for more than another does."""
    options = list(dict.fromkeys(_flat(parts, AnyOf)))
    possible = [option for option in options if not isinstance(option, Impossible)]
    if not possible:
        return options[0]
    least = [
        option
        for place, option in enumerate(possible)
        if not any(
            _implies(option, other) and (not _implies(other, option) or index < place)
            for index, other in enumerate(possible)
            if index != place
        )
    ]
    return least[0] if len(least) == 1 else AnyOf(tuple(least))


def _flat(parts: Iterable[Remedy], of: type[AllOf] | type[AnyOf]) -> Iterable[Remedy]:
    for part in parts:
        if isinstance(part, of):
            yield from part.parts
        else:
            yield part


def _parts(remedy: Remedy) -> tuple[Remedy, ...]:
    return remedy.parts if isinstance(remedy, AllOf) else (remedy,)


def _implies(one: Remedy, other: Remedy) -> bool:
    """Whether with the one the other has come about too, as far as their parts show."""
    return all(any(_brings(mine, theirs) for mine in _parts(one)) for theirs in _parts(other))


def _brings(one: Remedy, other: Remedy) -> bool:
    if isinstance(one, MeasureWithin) and isinstance(other, MeasureWithin):
        return one.measure == other.measure and _both(one, other) == one
    if isinstance(other, AnyOf):
        return one == other or any(_implies(one, part) for part in other.parts)
    return one == other


def _without(option: Remedy, certain: list[Remedy]) -> Remedy:
    """What is left of an option when other changes come about in any case."""
    left: list[Remedy] = []
    for part in _parts(option):
        if isinstance(part, MeasureWithin):
            same = [c for c in certain if isinstance(c, MeasureWithin) and c.measure == part.measure]
            joined = _both(same[0], part) if same else part
            if joined.is_empty:
                return Impossible(f"constraints contradict each other: {joined}")
            if same and joined == same[0]:
                continue
            left.append(joined)
        elif not any(_brings(one, part) for one in certain):
            left.append(part)
    return left[0] if len(left) == 1 else AllOf(tuple(left))
