"""One write to the knowledge base: everything in it happens, or nothing does."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from rosa_core.kb.events import (
    ActionUpdate,
    ComponentActivity,
    ConfigurationSelected,
    Event,
    Measurement,
    MonitoringData,
    ReconfigurationPlan,
    ReconfigurationPlanCreated,
    ReconfigurationPlanEnded,
    RequiredAction,
    StatusChange,
    StatusesChanged,
)
from rosa_core.kb.network import Node
from rosa_core.kb.reasoner import Reasoner
from rosa_core.kb.status import Result
from rosa_core.model.elements import ElementKind

Undo = Callable[[], None]


class Transaction:
    """What a write has done so far: how to take it back, and what to announce when it stands.

    Announcements are net: what is done and undone within one transaction is not heard of.
    """

    __slots__ = (
        "activated",
        "created_plans",
        "deactivated",
        "ended_actions",
        "ended_plans",
        "failures",
        "measurements",
        "recoveries",
        "requested_actions",
        "selected",
        "undo",
        "unselected",
    )

    def __init__(self) -> None:
        self.undo: list[Undo] = []
        self.measurements: list[Measurement] = []
        self.failures: dict[str, None] = {}
        self.recoveries: dict[str, None] = {}
        self.requested_actions: dict[str, RequiredAction] = {}
        self.ended_actions: list[RequiredAction] = []
        self.activated: dict[str, None] = {}
        self.deactivated: dict[str, None] = {}
        self.selected: dict[Node, None] = {}
        self.unselected: dict[Node, None] = {}
        self.created_plans: list[ReconfigurationPlan] = []
        self.ended_plans: list[tuple[ReconfigurationPlan, Result]] = []

    def select(self, node: Node, selected: bool) -> None:
        """A design or configuration became selected, or unselected."""
        now, before = (self.selected, self.unselected) if selected else (self.unselected, self.selected)
        if node in before:
            del before[node]
        else:
            now[node] = None

    def roll_back(self, reasoner: Reasoner) -> None:
        """Take everything back, latest first; statuses follow from the facts again."""
        for undo in reversed(self.undo):
            undo()
        reasoner.infer()
        reasoner.changes.clear()

    def events(self, revision: int, time: float, reasoner: Reasoner) -> Iterator[Event]:
        """What to announce, in the order in which it matters to the adaptation loop."""
        if self.measurements or self.failures or self.recoveries:
            yield MonitoringData(revision, time, tuple(self.measurements), tuple(self.failures), tuple(self.recoveries))
        if self.requested_actions or self.ended_actions:
            yield ActionUpdate(revision, time, tuple(self.requested_actions.values()), tuple(self.ended_actions))
        if self.selected or self.unselected:
            yield self._selection(revision, time)
        if self.activated or self.deactivated:
            yield ComponentActivity(revision, time, tuple(self.activated), tuple(self.deactivated))
        if reasoner.changes:
            changes = tuple(
                StatusChange(node.kind, node.name, old, node.status)
                for node, old in reasoner.changes.items()
                if node.status is not old
            )
            reasoner.changes.clear()
            if changes:
                yield StatusesChanged(revision, time, changes)
        for plan, result in self.ended_plans:
            yield ReconfigurationPlanEnded(revision, time, plan, result)
        for plan in self.created_plans:
            yield ReconfigurationPlanCreated(revision, time, plan)

    def _selection(self, revision: int, time: float) -> ConfigurationSelected:
        def names(nodes: dict[Node, None], designs: bool) -> tuple[str, ...]:
            return tuple(node.name for node in nodes if (node.kind is ElementKind.FUNCTION_DESIGN) is designs)

        return ConfigurationSelected(
            revision,
            time,
            names(self.selected, True),
            names(self.selected, False),
            names(self.unselected, True),
            names(self.unselected, False),
        )


def toggle(now: dict[str, None], before: dict[str, None], name: str) -> None:
    """Record that ``name`` changed to ``now``; if it had changed away from there before, nothing has changed."""
    if name in before:
        del before[name]
    else:
        now[name] = None
