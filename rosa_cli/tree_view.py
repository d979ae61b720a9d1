"""Shows a running behaviour tree in the terminal."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from rich.text import Text

from task_layer.bt.display.description import port_texts, printable, source_or_guess
from task_layer.bt.engine.status_changes import watch_statuses
from task_layer.bt.types.node_source import NodeKind

STYLES = {"IDLE": "dim", "RUNNING": "bold yellow", "SUCCESS": "green", "FAILURE": "red", "SKIPPED": "dim"}
"""The style of each status of BehaviorTree.CPP."""

_MARKS = {
    None: ("\u00b7", "-", STYLES["IDLE"]),
    Status.RUNNING: ("\u25b6", "*", STYLES["RUNNING"]),
    Status.SUCCESS: ("\u2713", "+", STYLES["SUCCESS"]),
    Status.FAILURE: ("\u2717", "x", STYLES["FAILURE"]),
}
"""The mark of a status in Unicode and in ASCII, and its style."""


@dataclass(frozen=True, slots=True)
class _Row:
    """The constant part of a node's line: ``size`` is the number of nodes below it, itself included."""

    node: Behaviour
    depth: int
    size: int
    name: str
    about: str


@dataclass(frozen=True, slots=True)
class _NodeState:
    """A node's state after a tick: ``status`` is None if it took no part in it."""

    status: Status | None
    is_idle: bool
    feedback: str


class TreeView:
    """Shows a tree as it was after the last tick; any thread may ask for the lines during the next tick.

    A node that ended in that tick and was set idle again, as most conditions are, has its last status, but dim.

    Args:
        root: the top of the tree; nodes that are added to it later are not shown.
        unicode: whether the terminal has more than ASCII.
    """

    def __init__(self, root: Behaviour, *, unicode: bool = True) -> None:
        self._rows = list(_rows(root))
        self._mark = 0 if unicode else 1
        self._ended: dict[Behaviour, Status] = {}
        self.close = watch_statuses(root, self._changed)
        self.update()

    def update(self) -> None:
        """Keep the state of every node; to be called after each tick."""
        self._states = [self._state_of(row.node) for row in self._rows]
        self._ended.clear()

    def lines(self, most: int | None = None) -> list[Text]:
        """A line for each node: its status, its name, and its feedback message if it took part in the tick.

        Args:
            most: the largest number of lines. If there are more nodes, those below idle nodes are left out first,
                and then the last ones.
        """
        states = self._states
        places = range(len(self._rows))
        if most is None or len(places) <= most:
            return [self._line(place, states[place]) for place in places]
        shown = list(self._below_active(states))[: max(most - 1, 0)]
        left_out = Text(f"  and {len(places) - len(shown)} more", "dim")
        return [*(self._line(place, states[place]) for place in shown), left_out]

    def _changed(self, behaviour: Behaviour, old: Status, new: Status) -> None:
        if new is Status.INVALID:
            self._ended[behaviour] = old

    def _state_of(self, node: Behaviour) -> _NodeState:
        is_idle = node.status is Status.INVALID
        return _NodeState(self._ended.get(node) if is_idle else node.status, is_idle, node.feedback_message)

    def _below_active(self, states: list[_NodeState]) -> Iterator[int]:
        place = 0
        while place < len(self._rows):
            yield place
            place += self._rows[place].size if states[place].status is None else 1

    def _line(self, place: int, state: _NodeState) -> Text:
        row, mark = self._rows[place], _MARKS[state.status]
        style = f"{mark[2]} not bold dim" if state.is_idle else mark[2]
        line = Text(f"{'  ' * row.depth}{mark[self._mark]} ", style, no_wrap=True, overflow="ellipsis")
        line.append(row.name, style)
        if row.about:
            line.append(f"  {row.about}", "not bold dim")
        if state.feedback and state.status is not None:
            line.append(f"  {printable(state.feedback)}", "not bold italic")
        return line


def _rows(root: Behaviour) -> Iterator[_Row]:
    sizes: dict[int, int] = {}
    for node in root.iterate():
        sizes[id(node)] = 1 + sum(sizes[id(child)] for child in node.children)
    to_do = [(root, 0)]
    while to_do:
        node, depth = to_do.pop()
        yield _Row(node, depth, sizes[id(node)], printable(node.name), _about(node))
        to_do.extend((child, depth + 1) for child in reversed(node.children))


def _about(node: Behaviour) -> str:
    """The type of a control node or decorator, unless that is its name, and the ports."""
    source = source_or_guess(node)
    is_inner = source.kind in (NodeKind.CONTROL, NodeKind.DECORATOR) and source.tag != node.name
    return " ".join([*([source.tag] if is_inner else []), *port_texts(source)])
