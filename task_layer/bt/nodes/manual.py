"""The control node of BehaviorTree.CPP v4 whose child a person chooses, as a py_trees composite."""

from __future__ import annotations

import sys
from collections.abc import Callable
from collections.abc import Sequence as Children
from typing import Any

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from task_layer.bt.engine.node import Flow, Node
from task_layer.bt.engine.outcome import FAILURE, RUNNING, SUCCESS
from task_layer.bt.ports.parameter import Parameter, value_of

Choose = Callable[[Children[str]], int | Status]
"""Takes the children's names; returns the number of one, from 0, or the status that the node is to have instead."""

_STATUS_BY_KEY = {"s": SUCCESS, "f": FAILURE, "r": RUNNING}


class ManualSelector(Node, composites.Composite):
    """Ticks the child that a person chooses at every tick, or has the status that is chosen instead.

    ``setup(choose=...)`` says how it is chosen; by default it is asked in the terminal.

    Args:
        name: the node's name in the tree.
        children: the children.
        repeat_last_selection: whether to ask only once, and keep to that choice.
    """

    def __init__(
        self,
        name: str,
        children: Children[Behaviour] | None = None,
        repeat_last_selection: Parameter[bool] = False,
    ) -> None:
        super().__init__(name, children)
        self.repeat_last_selection = repeat_last_selection
        self._choose: Choose = choose_in_terminal
        self._last: int | None = None

    def setup(self, **kwargs: Any) -> None:
        """Keep what the runner passes, and how a child is chosen."""
        super().setup(**kwargs)
        self._choose = kwargs.get("choose") or choose_in_terminal

    def flow(self) -> Flow:
        """Ask, halt the child that was running if another is chosen, and tick."""
        if self._last is None or not value_of(self.repeat_last_selection):
            self.status = RUNNING
            chosen = self._choose([child.name for child in self.children])
            if isinstance(chosen, Status):
                if chosen is not RUNNING:
                    self.halt_children()
                return chosen
            self._last = chosen
        child = self.children[self._last]
        for other in self.children:
            if other is not child:
                self.halt_child(other)
        outcome = yield child
        if outcome is SUCCESS or outcome is FAILURE:
            self.halt_children()
        return outcome


def choose_in_terminal(names: Children[str]) -> int | Status:
    """Ask in the terminal for the number of a child, from 1, or for S, F or R.

    Args:
        names: the children's names.

    Returns:
        the number of the child, from 0, or SUCCESS, FAILURE or RUNNING.

    Raises:
        RuntimeError: if there is no terminal, or the answer ends.
    """
    if not sys.stdin.isatty():
        raise RuntimeError("a child must be chosen, but there is no terminal to ask in (setup(choose=...))")
    sys.stderr.writelines(f"{number:3}. {name}\n" for number, name in enumerate(names, start=1))
    while True:
        sys.stderr.write("number of the child, or S, F, R for SUCCESS, FAILURE, RUNNING: ")
        sys.stderr.flush()
        line = sys.stdin.readline()
        if not line:
            raise RuntimeError("a child must be chosen, but the terminal was closed")
        answer = line.strip().lower()
        if answer in _STATUS_BY_KEY:
            return _STATUS_BY_KEY[answer]
        if answer.isascii() and answer.isdigit() and 1 <= int(answer) <= len(names):
            return int(answer) - 1
