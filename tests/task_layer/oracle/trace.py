"""The results of steps, which are compared, in words."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from tests.task_layer.oracle.description import Board, NodeDescription

IDLE = "IDLE"


@dataclass(slots=True)
class ScriptedCalls:
    """What the leaves of one of the trees do, and a record of what is done with them.

    Attributes:
        assign: does an assignment to the tree's blackboard.
        calls: since the last step.
    """

    assign: Callable[[NodeDescription], None]
    calls: list[str] = field(default_factory=list)
    _done: dict[str, int] = field(default_factory=dict)

    def called(self, leaf: NodeDescription, how: str) -> str:
        """The leaf is called: what does it come to (S, F or R)?"""
        done = self._done.get(leaf.name, 0)
        self._done[leaf.name] = done + 1
        self.calls.append(f"{how} {leaf.name}")
        if leaf.sets is not None:
            self.assign(leaf)
        return leaf.script[min(done, len(leaf.script) - 1)]

    def halted(self, leaf: NodeDescription) -> None:
        """The leaf is halted."""
        self.calls.append(f"halt {leaf.name}")

    def take(self) -> list[str]:
        """The calls since this was asked last."""
        calls, self.calls = self.calls, []
        return calls


@dataclass(frozen=True, slots=True)
class StepResult:
    """The result of a step."""

    step: str
    root: str
    calls: tuple[str, ...]
    leaves: Mapping[str, str]
    board: Board

    def __str__(self) -> str:
        leaves = ", ".join(f"{name} {status}" for name, status in sorted(self.leaves.items()) if status != IDLE)
        board = " ".join(f"{name}={value}" for name, value in self.board.items())
        return f"{self.step} -> {self.root}; {', '.join(self.calls) or 'no calls'}; {leaves or 'all idle'}; {board}"
