"""Facts that are so because they are seen, not because an action's effect says so."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from typing import TypeAlias

from rosa_core import InputError, KnowledgeBase, Status
from rosa_core.errors import Problem, nearest
from rosa_core.kb.rules import constraint_status
from rosa_core.kb.utility import Limit
from task_layer.pddl.ground import GroundTask, State

Sensor: TypeAlias = Callable[..., bool | None] | Limit
"""A function of the fact's objects that says whether it holds (None: not known), or a limit to a measure's value."""

NO_SENSORS: Mapping[str, Sensor] = {}


class SensedFacts:
    """Reads facts from the world.

    Args:
        task: the planning task; load it with the sensed predicates named.
        sensors: for each predicate, or single fact such as ``(pipeline_found p1)``, how it is sensed. A predicate's
            function gets the names of the objects, a single fact's none.
        kb: where measures are.

    Raises:
        InputError: if the task has no such facts.
        UnknownElementError: if the knowledge base has no such measure.
    """

    def __init__(self, task: GroundTask, sensors: Mapping[str, Sensor], kb: KnowledgeBase) -> None:
        self._kb = kb
        self._read: list[tuple[int, Callable[[], bool | None]]] = []
        self.measures = frozenset(sensor.measure for sensor in sensors.values() if isinstance(sensor, Limit))
        """The measures on which facts depend."""
        self.mask = 0
        """The facts that are sensed, as a mask."""
        for name, sensor in sensors.items():
            facts = _facts_of(task, name)
            for index in facts:
                objects = task.facts[index].strip("()").split()[1:]
                self._read.append((1 << index, self._reader(sensor, () if name.startswith("(") else objects)))
                self.mask |= 1 << index

    def seen(self, believed: State) -> State:
        """The believed state, corrected by what is sensed."""
        for bit, read in self._read:
            holds = read()
            if holds is not None:
                believed = believed | bit if holds else believed & ~bit
        return believed

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
        mend = nearest(wanted, sorted(known)) or "name the predicate in sensed=... when loading the task"
        raise InputError(Problem(f"'{name}' cannot be sensed: it is no fact that can change", mend=mend))
    return found
