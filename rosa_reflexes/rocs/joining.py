"""Blocks that are what the framework has already: the knowledge base, a mission, the command gate.

A skill of the task layer needs no adapter: it is an :class:`~rosa_reflexes.rocs.actions.Activity`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from rosa_core import ElementKind, KnowledgeBase, Status
from rosa_reflexes.commands import Command
from rosa_reflexes.gate import CommandGate
from rosa_reflexes.rocs.actions import Activity
from rosa_reflexes.rocs.blocks import Analyze, Plan
from rosa_reflexes.rocs.touchpoints import Actuator

ActionStatuses = Mapping[str, Status]
"""The status of each action of a knowledge base."""


class KnowledgeBaseAnalyze(Analyze[Mapping[str, float], ActionStatuses]):
    """Monitors publish measurements by measure; the knowledge base infers what that means for the robot's actions.

    Args:
        name: unique in its robot.
        kb: the knowledge base.
    """

    def __init__(self, name: str, kb: KnowledgeBase) -> None:
        super().__init__(name)
        self._kb = kb
        self._written: dict[str, float] = {}

    def process(self, values: Mapping[str, Mapping[str, float]]) -> ActionStatuses:
        """Write what is new, and look what follows from it."""
        for measured in values.values():
            for measure, value in measured.items():
                if self._written.get(measure) != value:
                    self._kb.add_measurement(measure, value)
                    self._written[measure] = value
        return dict(self._kb.statuses(ElementKind.ACTION))


class MissionPlan(Plan[ActionStatuses]):
    """A mission as the block Plan: it is woken by what changes, and its own skills carry out its actions.

    Args:
        wake: lets the mission's runner look at once what is to be done.
        period: every how many seconds it is woken while nothing changes.
    """

    def __init__(self, wake: Callable[[], object], *, period: float = 0.5) -> None:
        super().__init__("mission", period=period)
        self._wake = wake

    def run(self, _changes: Mapping[str, ActionStatuses]) -> Iterable[Activity]:
        """Wake the mission."""
        self._wake()
        return ()


class GateActuator(Actuator[Command]):
    """All channels of a command gate as one actuator: reflexes can take the command from what Execute carries out.

    Args:
        name: unique in its robot.
        gate: the gate; a command belongs to the epoch in which it is given.
    """

    def __init__(self, name: str, gate: CommandGate) -> None:
        super().__init__(name)
        self._gate = gate

    def actuate(self, command: Command) -> None:
        """Submit the command; the gate counts it if it is refused."""
        self._gate.submit(command, self._gate.epoch)
