"""Random trees over all node types, with random leaves and conditions, and random things done with them."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

from tests.task_layer.oracle.description import LEAVES, VARIABLES, WORD, Assignment, Case, Check, NodeDescription, Step

SEVERAL = (
    "Sequence",
    "SequenceWithMemory",
    "ReactiveSequence",
    "Fallback",
    "ReactiveFallback",
    "Parallel",
    "ParallelAll",
    "AsyncSequence",
    "AsyncFallback",
    "IfThenElse",
    "WhileDoElse",
    "Switch",
)
ONE = (
    "RetryUntilSuccessful",
    "Repeat",
    "Inverter",
    "ForceSuccess",
    "ForceFailure",
    "KeepRunningUntilFailure",
    "RunOnce",
    "SubTree",
)
_ASYNC = ("AsyncSequence", "AsyncFallback")
WORDS = ("x", "y", "1", "1.0", "2")
CHECKS = ("_failureIf", "_successIf", "_skipIf", "_while")
ASSIGNMENTS = ("_onSuccess", "_onFailure", "_onHalted", "_post")


def random_case(random: Random) -> Case:
    """A tree of up to some thirty nodes, and up to sixteen things done with it."""
    conditioned, changing = random.choice((0.1, 0.5)), random.choice((0.1, 0.5))
    root = _Trees(random, conditioned, changing).inner(random.randint(0, 3))
    ways = random.choice((("executeTick",), ("tickOnce", "tickExactlyOnce")))
    return Case(root, tuple(_step(random, ways) for _ in range(random.randint(1, 16))))


def _step(random: Random, ways_to_tick: tuple[str, ...]) -> Step:
    chance = random.random()
    if chance < 0.65:
        return Step(random.choice(ways_to_tick))
    if chance < 0.78:
        return Step("set", _assignment(random))
    if chance < 0.85:
        return Step("set", word=random.choice(WORDS))
    return Step("halt")


def _check(random: Random) -> Check:
    other = random.choice((0, 1, *VARIABLES))
    return Check(random.choice(VARIABLES), random.random() < 0.5, other)


def _assignment(random: Random) -> Assignment:
    return Assignment(random.choice(VARIABLES), random.choice((0, 1, "other", *VARIABLES)))


@dataclass(slots=True)
class _Trees:
    random: Random
    conditioned: float
    changing: float
    count: int = 0

    def inner(self, depth: int) -> NodeDescription:
        """A control node or decorator, with so many levels of them below it at most."""
        random = self.random
        kind = random.choice(SEVERAL if random.random() < 0.65 else ONE)
        number = self._number()
        children = tuple(self._any(depth - 1) for _ in range(self._how_many(kind)))
        ports = self._ports(kind, len(children))
        if kind == "ReactiveSequence" and sum(child.kind in _ASYNC for child in children) > 1:
            kind = "Sequence"  # BehaviorTree.CPP refuses such a ReactiveSequence
        if kind == "Switch":
            kind = f"Switch{len(children) - 1}"
        return NodeDescription(kind, number, children, ports, *self._conditions())

    def _how_many(self, kind: str) -> int:
        if kind in ("IfThenElse", "WhileDoElse"):
            return self.random.randint(2, 3)
        if kind == "Switch":
            return self.random.choice((3, 3, 3, 4, 5, 6, 7))
        return self.random.randint(1, 4) if kind in SEVERAL else 1

    def _any(self, depth: int) -> NodeDescription:
        if depth >= 0 and self.count < 25 and self.random.random() < 0.6:
            return self.inner(depth)
        return self._leaf()

    def _leaf(self) -> NodeDescription:
        random, number = self.random, self._number()
        if random.random() < 0.05:
            kind = random.choice(("AlwaysSuccess", "AlwaysFailure"))
            return NodeDescription(kind, number, (), {}, *self._conditions())
        kind = random.choice(LEAVES)
        letters = "RSF" if kind == "stateful" else "SF"
        script = "".join(random.choice(letters) for _ in range(random.randint(1, 5)))
        sets = _assignment(random) if random.random() < self.changing else None
        return NodeDescription(kind, number, (), {}, *self._conditions(), script, sets)

    def _ports(self, kind: str, children: int) -> dict[str, int | str | bool]:
        random = self.random
        match kind:
            case "Parallel":
                return {port: self._threshold(children) for port in ("success_count", "failure_count")}
            case "ParallelAll":
                return {"max_failures": self._threshold(children)}
            case "RetryUntilSuccessful":
                return {"num_attempts": self._times()}
            case "Repeat":
                return {"num_cycles": self._times()}
            case "RunOnce":
                return {"then_skip": random.random() < 0.5}
            case "Switch":
                cases = {f"case_{n}": random.choice(WORDS) for n in range(1, children)}
                return {"variable": random.choice((f"{{{WORD}}}",) * 4 + ("{nowhere}", *WORDS)), **cases}
        return {}

    def _threshold(self, children: int) -> int:
        return self.random.randint(-children - 1, children)

    def _times(self) -> int | str:
        chance = self.random.random()
        if chance < 0.15:
            return f"{{{self.random.choice(VARIABLES)}}}"
        return -1 if chance < 0.4 else self.random.randint(0, 4)

    def _conditions(self) -> tuple[dict[str, Check], dict[str, Assignment]]:
        random = self.random
        if random.random() > self.conditioned:
            return {}, {}
        checks = {random.choice(CHECKS): _check(random) for _ in range(random.randint(0, 2))}
        return checks, {random.choice(ASSIGNMENTS): _assignment(random) for _ in range(random.randint(0, 2))}

    def _number(self) -> int:
        self.count += 1
        return self.count
