"""Facts that are known because they are seen, not because an action's effect says so."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from rosa_core import InputError, KnowledgeBase, Status
from rosa_core.errors import Problem, nearest
from rosa_core.inference.rules import constraint_status
from rosa_core.model.utility import Limit
from task_layer.mission_part import OnRaise, log_raised
from task_layer.pddl.grounding.ground_task import GroundTask, State

Sensor: TypeAlias = Callable[..., bool | None] | Limit
"""A function of the fact's objects that says whether it holds (None: not known), or a limit to a measure's value."""

NO_SENSORS: Mapping[str, Sensor] = {}


@dataclass(frozen=True, slots=True)
class _SensedFact:
    name: str
    bit: int
    read: Callable[[], bool | None]


class SensedFacts:
    """Reads facts from the world. What a sensor that raises should have seen is not known.

    Args:
        task: the planning task; load it with the sensed predicates named.
        sensors: for each predicate, or single fact such as ``(pipeline_found p1)``, how it is sensed. A predicate's
            function gets the names of the objects, a single fact's none.
        kb: where measures are.
        on_raise: hears of a sensor that begins to raise, by the fact.

    Raises:
        InputError: if the task has no such facts.
        UnknownElementError: if the knowledge base has no such measure.
    """

    def __init__(
        self, task: GroundTask, sensors: Mapping[str, Sensor], kb: KnowledgeBase, on_raise: OnRaise = log_raised
    ) -> None:
        self._kb = kb
        self._on_raise = on_raise
        self._facts: list[_SensedFact] = []
        self._raising = 0
        self.measures = frozenset(sensor.measure for sensor in sensors.values() if isinstance(sensor, Limit))
        """The measures on which facts depend."""
        self.mask = 0
        """The facts that are sensed, as a mask."""
        for name, sensor in sensors.items():
            facts = _facts_of(task, name)
            for index in facts:
                objects = task.facts[index].strip("()").split()[1:]
                read = self._reader(sensor, () if name.startswith("(") else objects)
                self._facts.append(_SensedFact(task.facts[index], 1 << index, read))
                self.mask |= 1 << index

    def seen(self, believed: State) -> State:
        """The believed state, corrected by what is sensed."""
        for fact in self._facts:
            holds = self._read(fact)
            if holds is not None:
                believed = believed | fact.bit if holds else believed & ~fact.bit
        return believed

    def _read(self, fact: _SensedFact) -> bool | None:
        try:
            holds = fact.read()
        except Exception as error:
            if not self._raising & fact.bit:
                self._raising |= fact.bit
                self._on_raise(fact, error)
            return None
        self._raising &= ~fact.bit
        return holds

    def _reader(self, sensor: Sensor, objects: Collection[str]) -> Callable[[], bool | None]:
        if isinstance(sensor, Limit):
            self._kb.measurement(sensor.measure)
            return lambda: self._within(sensor)
        return lambda: sensor(*objects)

    def _within(self, limit: Limit) -> bool | None:
        """Whether the latest measurement satisfies a limit; None if there is none."""
        measured = self._kb.measurement(limit.measure)
        if measured is None:
            return None
        return constraint_status(limit.operator, limit.value, measured.value) is Status.SATISFIED


def _facts_of(task: GroundTask, name: str) -> list[int]:
    wanted = name.lower()
    facts = [fact.lower() for fact in task.facts]
    found = [i for i, fact in enumerate(facts) if fact == wanted or fact.strip("()").split()[0] == wanted]
    if not found:
        known = {fact.strip("()").split()[0] for fact in facts} | (set(facts) if wanted.startswith("(") else set())
        hint = nearest(wanted, sorted(known)) or "name the predicate in sensed=... when loading the task"
        raise InputError(Problem(f"'{name}' cannot be sensed: it is no fact that can change", hint=hint))
    return found
