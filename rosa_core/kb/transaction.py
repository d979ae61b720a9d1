"""One write to the knowledge base: everything in it happens, or nothing does."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from copy import copy
from dataclasses import dataclass
from typing import Any, TypeVar

from rosa_core.inference.network import Node
from rosa_core.inference.reasoner import Reasoner
from rosa_core.kb.events import (
    ActionUpdate,
    ComponentActivity,
    ConfigurationSelected,
    Event,
    KnowledgeChanged,
    MonitoringData,
    ReconfigurationPlanCreated,
    ReconfigurationPlanEnded,
    StatusesChanged,
)
from rosa_core.model.changes import Element
from rosa_core.model.elements import ElementKind
from rosa_core.model.facts import Fact
from rosa_core.model.records import Measurement, ReconfigurationPlan, RequiredAction, StatusChange
from rosa_core.model.status import Result, Status

NodeKey = tuple[ElementKind, object]
"""What stands for a node even when the model has changed and it is another object: its kind, and its name or itself."""
Undo = Callable[[], None]


@dataclass(frozen=True, slots=True)
class Savepoint:
    """How many steps can be taken back, and what was to be announced, at some point of a transaction."""

    steps: int
    kept: Mapping[str, Any]


BEGINNING = Savepoint(0, {})
"""Where nothing has been done; what was to be announced is of no interest any more."""


class Transaction:
    """What a write has done: how to take it back, and what to announce when it stands.

    Announcements are net: what is done and undone within one transaction is not announced. ``facts`` are everything
    that changed, in order; applied again in that order, they give the same state. ``statuses_before`` are those that
    removed nodes had before the write, in case they are added again; ``last_order_before`` says which nodes it found
    (-1: none has been added or removed).
    """

    __slots__ = (
        "activated",
        "added",
        "created_plans",
        "deactivated",
        "ended_actions",
        "ended_plans",
        "facts",
        "failures",
        "last_order_before",
        "measurements",
        "recoveries",
        "removed",
        "requested_actions",
        "selected",
        "statuses_before",
        "undo",
        "unselected",
    )

    def __init__(self) -> None:
        self.undo: list[Undo] = []
        self.facts: list[Fact] = []
        self.added: dict[Element, None] = {}
        self.removed: dict[Element, None] = {}
        self.last_order_before = -1
        self.statuses_before: dict[NodeKey, Status] = {}
        self.measurements: list[Measurement] = []
        self.failures: dict[str, None] = {}
        self.recoveries: dict[str, None] = {}
        self.requested_actions: dict[str, RequiredAction] = {}
        self.ended_actions: list[RequiredAction] = []
        self.activated: dict[str, None] = {}
        self.deactivated: dict[str, None] = {}
        self.selected: dict[NodeKey, None] = {}
        self.unselected: dict[NodeKey, None] = {}
        self.created_plans: list[ReconfigurationPlan] = []
        self.ended_plans: list[tuple[ReconfigurationPlan, Result]] = []

    def savepoint(self) -> Savepoint:
        """What has been done up to now, to come back to."""
        kept = {name: copy(getattr(self, name)) for name in self.__slots__ if name != "undo"}
        return Savepoint(len(self.undo), kept)

    def restore(self, savepoint: Savepoint) -> None:
        """Take back what was done since the savepoint, latest first, and announce nothing of it."""
        while len(self.undo) > savepoint.steps:
            self.undo.pop()()
        for name, value in savepoint.kept.items():
            setattr(self, name, value)

    def select(self, node: Node, selected: bool) -> None:
        """A design or configuration became selected, or unselected.

        Args:
            node: of the design or configuration.
            selected: what it became.
        """
        now, before = (self.selected, self.unselected) if selected else (self.unselected, self.selected)
        toggle(now, before, (node.kind, node.name))

    def events(self, revision: int, time: float, reasoner: Reasoner) -> Iterator[Event]:
        """What to announce, in the order in which it matters to the adaptation loop.

        Args:
            revision: the number of this write.
            time: of this write, in seconds.
            reasoner: its changes of statuses are taken out, and announced with their net effect.

        Returns:
            no event of a kind of which nothing happened.
        """
        if self.added or self.removed:
            yield KnowledgeChanged(revision, time, tuple(self.added), tuple(self.removed))
        if self.measurements or self.failures or self.recoveries:
            yield MonitoringData(revision, time, tuple(self.measurements), tuple(self.failures), tuple(self.recoveries))
        if self.requested_actions or self.ended_actions:
            yield ActionUpdate(revision, time, tuple(self.requested_actions.values()), tuple(self.ended_actions))
        if self.selected or self.unselected:
            yield self._selection(revision, time)
        if self.activated or self.deactivated:
            yield ComponentActivity(revision, time, tuple(self.activated), tuple(self.deactivated))
        if reasoner.changes:
            changed = [pair for pair in reasoner.changes.items() if pair[0].status is not pair[1]]
            changed.sort(key=_position)
            changes = tuple([StatusChange(node.kind, node.name, old, node.status) for node, old in changed])
            reasoner.changes.clear()
            if changes:
                yield StatusesChanged(revision, time, changes)
        for plan, result in self.ended_plans:
            yield ReconfigurationPlanEnded(revision, time, plan, result)
        for plan in self.created_plans:
            yield ReconfigurationPlanCreated(revision, time, plan)

    def _selection(self, revision: int, time: float) -> ConfigurationSelected:
        def names(keys: dict[NodeKey, None], designs: bool) -> tuple[str, ...]:
            return tuple(str(name) for kind, name in keys if (kind is ElementKind.FUNCTION_DESIGN) is designs)

        return ConfigurationSelected(
            revision,
            time,
            names(self.selected, True),
            names(self.selected, False),
            names(self.unselected, True),
            names(self.unselected, False),
        )


_T = TypeVar("_T")


def toggle(now: dict[_T, None], before: dict[_T, None], item: _T) -> None:
    """Record that ``item`` changed to ``now``; if it had changed away from there before, nothing has changed.

    Args:
        now: the items that have come to be so in this write.
        before: those that have come to be the opposite.
        item: which changed.

    Example:
        >>> activated, deactivated = {}, {"sonar": None}
        >>> toggle(activated, deactivated, "sonar")
        >>> toggle(activated, deactivated, "camera")
        >>> activated, deactivated
        ({'camera': None}, {})
    """
    if item in before:
        del before[item]
    else:
        now[item] = None


def _position(change: tuple[Node, Status]) -> tuple[int, int]:
    """From constraints up to actions, and by declaration: the same whatever the order of the writes in between."""
    node = change[0]
    return (node.level, node.order)
