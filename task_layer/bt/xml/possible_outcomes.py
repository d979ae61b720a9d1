"""The outcomes that nodes can have, as far as they follow from their types."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from task_layer.bt.engine.outcome import FAILURE, OUTCOMES_BY_NAME, RUNNING, SKIPPED, SUCCESS, Outcome
from task_layer.bt.ports.bound_ports import Literal
from task_layer.bt.xml.node_specs import NodeSpec

Outcomes = frozenset[Outcome]
"""The outcomes with which a node can end; none for a node that never ends."""

_ANY: Outcomes = frozenset((SUCCESS, FAILURE))
_SEQUENCES = ("Sequence", "AsyncSequence", "SequenceWithMemory", "ReactiveSequence")
_FALLBACKS = ("Fallback", "AsyncFallback", "ReactiveFallback")
_CONTINUE_ON: Mapping[str, Outcome] = dict.fromkeys(_SEQUENCES, SUCCESS) | dict.fromkeys(_FALLBACKS, FAILURE)
_LEAVES: Mapping[str, Outcomes] = {
    "AlwaysFailure": frozenset((FAILURE,)),
    **dict.fromkeys(("AlwaysSuccess", "SetBlackboard", "UnsetBlackboard", "Sleep", "Script"), frozenset((SUCCESS,))),
}
_VERBS: Mapping[Outcome, str] = {SUCCESS: "succeeds", FAILURE: "fails"}


class PossibleOutcomes:
    """The outcomes with which the nodes of some trees can end.

    Args:
        specs: the trees, by ID; none contains itself.
    """

    def __init__(self, specs: Mapping[str, NodeSpec]) -> None:
        self._specs = specs
        self._known: dict[int, Outcomes] = {}

    def of(self, spec: NodeSpec) -> Outcomes:
        """The outcomes of a node, those of its pre-conditions included."""
        known = self._known.get(id(spec))
        if known is None:
            known = self._known[id(spec)] = self._ticked(spec) | _without_tick(spec)
        return known

    def unreachable(self, spec: NodeSpec) -> Iterator[tuple[NodeSpec, NodeSpec, str]]:
        """The first child that is never ticked, the child before it, and what that one never does."""
        continue_on = None if spec.type is None else _CONTINUE_ON.get(spec.type.tag)
        if continue_on is None:
            return
        for before, child in zip(spec.children, spec.children[1:], strict=False):
            if not self.of(before) & {continue_on, SKIPPED}:
                yield child, before, _VERBS[continue_on]
                return

    def _ticked(self, spec: NodeSpec) -> Outcomes:
        if spec.type is None:
            return self.of(self._specs[spec.subtree])
        tag = spec.type.tag
        if tag in _CONTINUE_ON:
            return self._sequential(spec, _CONTINUE_ON[tag])
        decorated = _DECORATORS.get(tag)
        if decorated is not None:
            return decorated(spec, self.of(spec.children[0]))
        return _LEAVES.get(tag, _ANY)

    def _sequential(self, spec: NodeSpec, continue_on: Outcome) -> Outcomes:
        found: set[Outcome] = set()
        may_skip = True
        for child in spec.children:
            outcomes = self.of(child)
            found |= outcomes - {continue_on, SKIPPED}
            may_skip = may_skip and SKIPPED in outcomes
            if not outcomes & {continue_on, SKIPPED}:
                return frozenset(found)
        return frozenset(found | {continue_on} | ({SKIPPED} if may_skip else set()))


def _without_tick(spec: NodeSpec) -> Outcomes:
    by_condition: Mapping[str, Outcome] = {
        "failure_if": FAILURE,
        "success_if": SUCCESS,
        "skip_if": SKIPPED,
        "while_true": SKIPPED,
    }
    return frozenset(outcome for name, outcome in by_condition.items() if name in spec.conditions)


def _is_endless(spec: NodeSpec, port: str) -> bool:
    value = spec.values.get(port)
    return isinstance(value, Literal) and value.value == -1


def _mapped(outcomes: Outcomes, mapping: Mapping[Outcome, Outcome]) -> Outcomes:
    return frozenset(mapping.get(outcome, outcome) for outcome in outcomes)


def _retry(spec: NodeSpec, child: Outcomes) -> Outcomes:
    return child - {FAILURE} if _is_endless(spec, "num_attempts") else child


def _repeat(spec: NodeSpec, child: Outcomes) -> Outcomes:
    return child - {SUCCESS} if _is_endless(spec, "num_cycles") else child


def _loop(spec: NodeSpec, child: Outcomes) -> Outcomes:
    value = spec.values.get("if_empty")
    at_the_end = OUTCOMES_BY_NAME.get(value.value) if isinstance(value, Literal) else None
    return child & {FAILURE} | (_ANY | {SKIPPED} if at_the_end is None else {at_the_end} - {RUNNING})


_DECORATORS: Mapping[str, Callable[[NodeSpec, Outcomes], Outcomes]] = {
    "Inverter": lambda _, child: _mapped(child, {SUCCESS: FAILURE, FAILURE: SUCCESS}),
    "ForceSuccess": lambda _, child: _mapped(child, {FAILURE: SUCCESS}),
    "ForceFailure": lambda _, child: _mapped(child, {SUCCESS: FAILURE}),
    "KeepRunningUntilFailure": lambda _, child: child - {SUCCESS},
    "RetryUntilSuccessful": _retry,
    "Repeat": _repeat,
    "Timeout": lambda _, child: child | {FAILURE},
    "Delay": lambda _, child: child,
    "RunOnce": lambda _, child: child | {SKIPPED},
    "SkipUnlessUpdated": lambda _, child: child | {SKIPPED},
    "WaitValueUpdate": lambda _, child: child,
    **dict.fromkeys(("LoopInt", "LoopDouble", "LoopBool", "LoopString"), _loop),
}
