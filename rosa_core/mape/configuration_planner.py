"""Plan: which designs and configurations are the best for what is required now (ROSA paper, section 6.2.3)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from rosa_core.kb.events import ActionUpdate, Event, KnowledgeChanged, MonitoringData, ReconfigurationPlan
from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.kb.status import Status
from rosa_core.model.elements import ElementKind


class ConfigurationPlanner:
    """Selects, for everything adaptable, the best that is selectable: the lowest priority number.

    What is solved already changes only for something better. The planner keeps no state of its own and talks only to
    the knowledge base. It plans when monitoring data was written, when the required actions changed, and when
    knowledge was added or removed.
    """

    EVENTS = (MonitoringData, ActionUpdate, KnowledgeChanged)

    def __init__(self, kb: KnowledgeBase) -> None:
        self._kb = kb

    def on_event(self, _event: Event) -> None:
        """Plan anew; subscribe this to :data:`EVENTS`."""
        self.plan()

    def plan(self) -> ReconfigurationPlan | None:
        """Select what is best now; the plan that comes of it is in the knowledge base."""
        kb = self._kb
        designs = []
        for function in kb.adaptable_functions():
            solved = kb.status(ElementKind.FUNCTION, function) is Status.SOLVED
            current = kb.selected_function_design(function) if solved else None
            best = _best(kb.selectable_function_designs(function), kb.function_design_priority, current)
            if best is not None:
                designs.append(best)
        configurations = []
        for component in kb.adaptable_components(designs):
            solved = kb.status(ElementKind.COMPONENT, component) is Status.SOLVED
            current = kb.selected_component_configuration(component) if solved else None
            options = kb.selectable_component_configurations(component)
            best = _best(options, kb.component_configuration_priority, current)
            if best is not None:
                configurations.append(best)
        return kb.select_configuration(designs, configurations)


def _best(candidates: Iterable[str], priority: Callable[[str], float | None], current: str | None) -> str | None:
    """The candidate with the lowest priority number; ties go to the current choice, then by declaration."""

    def rank(name: str) -> tuple[float, bool]:
        number = priority(name)
        return (math.inf if number is None else number, name != current)

    return min(candidates, key=rank, default=None)
