"""Why an element has its status: which rule applied, from which facts, down to the measurement and its time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
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
from rosa_core.inference.remedies import AllOf, Remedy
from rosa_core.model.elements import ElementKind, shown_number
from rosa_core.model.status import Status


@dataclass(frozen=True, slots=True)
class Explanation:
    """An element's status, the reason in words, and the explanations of the elements that the reason names.

    Args:
        kind: of the element.
        name: of the element; for a constraint the constraint in words.
        status: its present one.
        reason: which rule applied, in words.
        because: the explanations of what the rule applied to.
        notes: on how the configuration is chosen; only on the explanation that was asked for, not on those below.
        remedy: what must change for what is unfeasible or failed; likewise.
    """

    kind: ElementKind
    name: str
    status: Status
    reason: str
    because: tuple[Explanation, ...] = ()
    notes: tuple[str, ...] = ()
    remedy: Remedy | None = None

    @property
    def remedies(self) -> tuple[str, ...]:
        """What must change for the element to be feasible again, all of it; empty when it is."""
        if self.remedy is None:
            return ()
        return tuple(map(str, self.remedy.parts if isinstance(self.remedy, AllOf) else (self.remedy,)))

    @property
    def summary(self) -> str:
        """One line: the element, its status, and the facts at the bottom of the chain."""
        facts = list(dict.fromkeys(self._facts()))
        shown = "; ".join(facts[:3]) + (f"; and {len(facts) - 3} more" if len(facts) > 3 else "")
        return f"{self.name} is {self.status}: {shown}"

    def __str__(self) -> str:
        return "\n".join(self._lines("", ""))

    def _facts(self) -> Iterator[str]:
        if not self.because:
            subject = "" if self.kind is ElementKind.CONSTRAINT else f"{self.name}: "
            yield f"{subject}{self.reason}"
        for cause in self.because:
            yield from cause._facts()

    def _lines(self, first: str, rest: str) -> Iterator[str]:
        words = self.kind.value.replace("_", " ")
        if self.kind is ElementKind.CONSTRAINT:
            yield f"{first}{self.reason}"
        else:
            yield f"{first}{words} '{self.name}' is {self.status}: {self.reason}"
        for index, cause in enumerate(self.because):
            last = index == len(self.because) - 1
            yield from cause._lines(rest + ("└─ " if last else "├─ "), rest + ("   " if last else "│  "))


def explain(reasoner: Reasoner, node: Node) -> Explanation:
    """The explanation of a node's present status.

    Args:
        reasoner: what the node is in.
        node: an element or constraint.
    """
    reason, causes = _reason(node, reasoner)
    because = tuple(explain(reasoner, cause) for cause in causes)
    return Explanation(node.kind, node.name, node.status, reason, because)


_Reason = tuple[str, Iterable[Node]]
_BAD = (Status.UNFEASIBLE, Status.FAILURE)


@singledispatch
def _reason(node: Node, _reasoner: Reasoner) -> _Reason:
    raise TypeError(f"no rule explains a {type(node).__name__}")


def _with(nodes: Iterable[Node], *statuses: Status) -> list[Node]:
    return [node for node in nodes if node.status in statuses]


def _violated(reasoner: Reasoner, node: Node) -> list[Node]:
    return _with(reasoner.constraints_on.get(node, ()), Status.VIOLATED)


@_reason.register
def _constraint(node: ConstraintNode, _reasoner: Reasoner) -> _Reason:
    constraint, measure = node.constraint, node.measure
    if constraint.value is None:
        return f"the constraint on {measure.name} has no value, so it is not evaluated", ()
    wanted = f"{constraint.operator} {shown_number(constraint.value)}"
    if measure.value is None or measure.time is None:
        return f"{measure.name} has not been measured, so {wanted} is not evaluated", ()
    verb = "violates" if node.status is Status.VIOLATED else "satisfies"
    value = _shown_beside(measure.value, constraint.value)
    return f"{measure.name} {value} (measured at {measure.time:.1f} s) {verb} {wanted}", ()


def _shown_beside(value: float, limit: float) -> str:
    """A value in few digits, but enough to see on which side of the limit it is."""
    for digits in (6, 9, 12):
        text = f"{value:.{digits}g}"
        if (float(text) < limit) == (value < limit) and (float(text) > limit) == (value > limit):
            return text
    return repr(value)


@_reason.register
def _configuration(node: ConfigurationNode, reasoner: Reasoner) -> _Reason:
    if node.status is Status.UNFEASIBLE:
        return "a constraint on it is violated", _violated(reasoner, node)
    return _nothing_against(reasoner, node, "no constraint on it is violated")


@_reason.register
def _component(node: ComponentNode, reasoner: Reasoner) -> _Reason:
    if node.status is Status.FAILURE:
        return f"a failure was reported at {node.failed_since:.1f} s", ()
    if node.status is Status.UNFEASIBLE:
        if violated := _violated(reasoner, node):
            return "a constraint on it is violated", violated
        return "all its configurations are unfeasible", node.options
    if node.status is Status.CONFIGURATION_ERROR:
        selected = [option for option in node.options if option.selected]
        return "its selected configuration is unfeasible", _with(selected, Status.UNFEASIBLE)
    if node.status is Status.UNSOLVED:
        return ("no configuration is selected" if node.active else "it is required and not active"), ()
    if node.status is Status.SOLVED:
        return "it is required and active", [option for option in node.options if option.selected]
    return _nothing_against(reasoner, node, "nothing is against it, and it is not required")


@_reason.register
def _design(node: DesignNode, reasoner: Reasoner) -> _Reason:
    if node.status is Status.UNFEASIBLE:
        if violated := _violated(reasoner, node):
            return "a constraint on it is violated", violated
        return "a component of it cannot be used", _with(node.members, *_BAD)
    if node.status is Status.IMPLICIT_CONFIGURATION_ERROR:
        return "a component of it is wrongly configured", _with(node.members, Status.CONFIGURATION_ERROR)
    if node.status is Status.UNSOLVED:
        unsolved = [member for member in node.members if member.status is not Status.SOLVED]
        return "it is selected, and a component of it is not ready", unsolved
    if node.status is Status.SOLVED:
        return "it is selected, and all its components are solved", node.members
    return _nothing_against(reasoner, node, "all its components can be used, and it is not selected")


@_reason.register
def _function(node: FunctionNode, _reasoner: Reasoner) -> _Reason:
    selected = [option for option in node.options if option.selected]
    if node.status is Status.UNFEASIBLE:
        if not node.options:
            return "no design solves it", ()
        return "all its designs are unfeasible", node.options
    if node.status is Status.CONFIGURATION_ERROR:
        return "its selected design is unfeasible", _with(selected, Status.UNFEASIBLE)
    if node.status is Status.IMPLICIT_CONFIGURATION_ERROR:
        return "its selected design is in error", _with(selected, Status.IMPLICIT_CONFIGURATION_ERROR)
    if node.status is Status.UNSOLVED:
        return ("its selected design is not solved yet" if selected else "no design is selected"), selected
    if node.status is Status.SOLVED:
        return "its selected design is solved", selected
    return "a design of it can be used, and no required action needs it", ()


@_reason.register
def _action(node: ActionNode, reasoner: Reasoner) -> _Reason:
    if node.status is Status.UNFEASIBLE:
        causes = [*_violated(reasoner, node), *_with(node.members, Status.UNFEASIBLE)]
        what = "a constraint on it is violated" if _violated(reasoner, node) else "a function of it is unfeasible"
        return what, causes
    if node.status is Status.IMPLICIT_CONFIGURATION_ERROR:
        wrong = _with(node.members, Status.CONFIGURATION_ERROR, Status.IMPLICIT_CONFIGURATION_ERROR)
        return "a function of it is wrongly configured", wrong
    if node.status is Status.UNSOLVED:
        return "it is required, and a function of it is not solved yet", _with(node.members, Status.UNSOLVED)
    if node.status is Status.SOLVED:
        return "it is required, and all its functions are solved", node.members
    return _nothing_against(reasoner, node, "all its functions can be provided, and it is not required")


def _nothing_against(reasoner: Reasoner, node: Node, reason: str) -> _Reason:
    return reason, reasoner.constraints_on.get(node, ())
