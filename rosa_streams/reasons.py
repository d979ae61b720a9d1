"""Why a target has its stream, or has none."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from rosa_streams.environment import Environment, Target
from rosa_streams.runtime.instance import LostUnit


@dataclass(frozen=True, slots=True)
class TargetReason:
    """The reason of a target's state.

    Attributes:
        qid: which target.
        satisfied: whether it has its stream.
        reasons: lines, each deeper one indented by two spaces.
        remedies: what would help.
    """

    qid: str
    satisfied: bool
    reasons: tuple[str, ...]
    remedies: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "\n".join((*self.reasons, *(f"  to help: {remedy}" for remedy in self.remedies)))


def reason_of(
    environment: Environment,
    target: Target,
    unsatisfied: str | None,
    losses: Mapping[str, Sequence[LostUnit]],
    set_aside: Mapping[str, float],
    remedies: tuple[str, ...],
) -> TargetReason:
    """Put together what is known about a target.

    Args:
        environment: as it is.
        target: which.
        unsatisfied: why it has no stream, if it has none.
        losses: recent losses by transformation.
        set_aside: transformations that are not used until a time, since their units were lost again and again.
        remedies: what would help.
    """
    if unsatisfied is None:
        head = f"{target.qid} is satisfied: {target.tag} is on {target.channel}"
        return TargetReason(target.qid, True, (head, *_pipeline(environment, target.channel, 1, set())))
    lines = [line for line in unsatisfied.splitlines() if not line.strip().startswith("to help:")]
    advice = list(remedies)
    for tid, until in sorted(set_aside.items()):
        last = losses[tid][-1] if losses.get(tid) else None
        why = f": {last.cid}, {last.reason}" if last else ""
        lines.append(f"  {tid} is set aside until {until:g} s, its units were lost again and again{why}")
        advice.append(f"fix the implementation of {tid}, or register another one")
    return TargetReason(target.qid, False, tuple(lines), tuple(advice))


def _pipeline(environment: Environment, channel: str, depth: int, seen: set[str]) -> Iterator[str]:
    for unit, port in environment.writers().get(channel, ()):
        name = f"{'  ' * depth}from {unit.cid}.{port}"
        if unit.cid in seen:
            yield f"{name}, as above"
            continue
        seen.add(unit.cid)
        yield name
        for _, fed in unit.inputs:
            if fed is not None:
                yield from _pipeline(environment, fed, depth + 1, seen)
