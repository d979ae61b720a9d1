"""Plan: which designs and configurations are the best for what is required now (ROSA paper, section 6.2.3)."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Iterable, Mapping

from rosa_core.choice import Alternatives, CompleteConfiguration, best_configuration
from rosa_core.kb.events import ActionUpdate, ComponentActivity, Event, KnowledgeChanged, StatusesChanged
from rosa_core.kb.knowledge_base import KnowledgeBase
from rosa_core.model.elements import ElementKind
from rosa_core.model.records import ReconfigurationPlan, RequiredAction
from rosa_core.model.status import Status
from rosa_core.model.utility import Utility

logger = logging.getLogger(__name__)


class ConfigurationPlanner:
    """Selects, for everything adaptable, the best that is selectable.

    For a required action with a preference or a utility, the best is decided for all its functions together, by the
    estimations (:func:`~rosa_core.choice.complete_configurations` says what is better). What is solved
    already and does not always improve is kept, and counts. If nothing meets the limits, priorities decide, and the
    log and the action's explanation say so. If several actions share functions or components, the action that was
    requested first with a preference or utility decides on these. For all else the lowest priority number is the best.

    What is solved already changes only for something better. The planner keeps no state of its own and talks only to
    the knowledge base.

    It plans when something has changed that a choice follows from, and that is not itself a choice:

    ==========================  ===================================================================
    event                       what has changed
    ==========================  ===================================================================
    :class:`StatusesChanged`    a constraint's status, or a component has failed or works again
    :class:`ActionUpdate`       what is required, and by which preference or utility it is chosen
    :class:`ComponentActivity`  what runs, and not as it is selected (a plan carried out is no reason)
    :class:`KnowledgeChanged`   what there is to choose from
    ==========================  ===================================================================

    All other statuses follow from these and from what is selected. So a measurement that passes no limit makes nobody
    plan, and neither does a selection, be it the planner's own or somebody else's: that one stands until there is a
    reason to choose anew. A plan that somebody else ends is made again then, or by
    :meth:`~rosa_core.kb.KnowledgeBase.replan`.

    Args:
        kb: the knowledge base.

    Example:
        >>> from rosa_core import KnowledgeBase, KnowledgeModel
        >>> from rosa_core.model.elements import Action, Component, Function, FunctionalRequirement, FunctionDesign
        >>> kb = KnowledgeBase(
        ...     KnowledgeModel(
        ...         actions=(Action("fly"),),
        ...         functions=(Function("lift"),),
        ...         components=(Component("rotors"),),
        ...         requirements=(FunctionalRequirement("fly", ("lift",)),),
        ...         function_designs=(FunctionDesign("by rotors", "lift", ("rotors",)),),
        ...     )
        ... )
        >>> planner = ConfigurationPlanner(kb)
        >>> end = kb.subscribe(planner.on_event, ConfigurationPlanner.EVENTS)
        >>> action = kb.request_action("fly")
        >>> kb.selected_function_design("lift")
        'by rotors'
        >>> kb.pending_reconfiguration_plan().activate
        ('rotors',)
    """

    EVENTS = (StatusesChanged, ActionUpdate, ComponentActivity, KnowledgeChanged)
    """The types of event that :meth:`on_event` is to hear."""

    def __init__(self, kb: KnowledgeBase) -> None:
        self._kb = kb

    def on_event(self, event: Event) -> None:
        """Plan, if the event says that something has changed which choices follow from.

        Args:
            event: what was written; subscribe this method to :data:`EVENTS`.
        """
        if self._is_reason_to_plan(event):
            self.plan()

    def plan(self) -> ReconfigurationPlan | None:
        """Select what is best now.

        Returns:
            the reconfiguration plan that brings it about, which is in the knowledge base; None if there is nothing to
            reconfigure.
        """
        with self._kb.transaction():  # nobody writes between reading and selecting
            return self._plan()

    def _is_reason_to_plan(self, event: Event) -> bool:
        if isinstance(event, StatusesChanged):
            return _has_root_change(event)
        if isinstance(event, ComponentActivity):
            return bool(self._kb.components_to_reconfigure((*event.activated, *event.deactivated)))
        return True

    def _plan(self) -> ReconfigurationPlan | None:
        kb = self._kb
        designs: dict[str, str] = {}
        configurations: dict[str, str] = {}
        required = kb.required_actions()
        if any(action.decided_by is not None for action in required):
            known = {action.action: kb.alternatives(action.action) for action in required}
            for action in required:
                decision = _Decision(kb, known, designs, configurations)
                if action.decided_by is not None:
                    decision.decide(action, action.decided_by)
        for function in kb.adaptable_functions():
            if function not in designs:
                current = _current_design(kb, function)
                best = _best(kb.selectable_function_designs(function), kb.function_design_priority, current)
                if best is not None:
                    designs[function] = best
        still_required = frozenset(kb.required_components(designs.values()))
        for component in kb.adaptable_components(designs.values()):
            if component in still_required and component not in configurations:
                current = _current_configuration(kb, component)
                options = kb.selectable_component_configurations(component)
                best = _best(options, kb.component_configuration_priority, current)
                if best is not None:
                    configurations[component] = best
        return kb.select_configuration(designs.values(), configurations.values())


def _has_root_change(event: StatusesChanged) -> bool:
    """Whether a measurement or a failure is among what changed the statuses: a selection changes none of these."""
    for kind, _, old, new in event.changes:
        if kind is ElementKind.CONSTRAINT or old is Status.FAILURE or new is Status.FAILURE:
            return True
    return False


class _Decision:
    """Decides on one action's functions by its utility, within what other actions have decided or keep running.

    Args:
        kb: the knowledge base.
        known: the alternatives of all required actions.
        designs: what is decided already, by function; what is decided here is added.
        configurations: the same, by component.
    """

    def __init__(
        self,
        kb: KnowledgeBase,
        known: Mapping[str, Alternatives],
        designs: dict[str, str],
        configurations: dict[str, str],
    ) -> None:
        self._kb = kb
        self._known = known
        self._designs = designs
        self._configurations = configurations

    def decide(self, action: RequiredAction, utility: Utility) -> None:
        """Choose for the functions and components of the action that are open; nothing, if none are."""
        kb, alternatives = self._kb, self._known[action.action].solvable()
        adaptable = frozenset(kb.adaptable_functions())
        adaptable_components = frozenset(kb.adaptable_components())
        open_functions = {f for f in alternatives.functions if f in adaptable and f not in self._designs}
        kept = self._kept_designs(open_functions)
        running = self._running(kept)
        keep_running = running - adaptable_components
        reconfigured = {c for f in alternatives.functions if f in kept for c in self._parts(f, kept[f])}
        if not open_functions and not (reconfigured & adaptable_components) - self._configurations.keys():
            return
        settings = {c: name for c in keep_running if (name := kb.selected_component_configuration(c)) is not None}
        options = alternatives.keeping(kept, {**settings, **self._configurations}).preferring(
            filter(None, (_current_design(kb, function) for function in alternatives.functions)),
            filter(None, (_current_configuration(kb, component) for component in alternatives.components)),
        )
        best = self._choose(action, options, utility)
        if best is None:
            return
        self._designs.update({f: name for f, name in best.function_designs.items() if f in open_functions})
        # Those that are kept too: else a design that is new to their component would have them chosen by priority.
        self._configurations.update(best.component_configurations)

    def _choose(
        self, action: RequiredAction, alternatives: Alternatives, utility: Utility
    ) -> CompleteConfiguration | None:
        best = best_configuration(alternatives, utility)
        if best is None and utility.limits:
            best = best_configuration(alternatives)
            if best is not None:
                limits = " and ".join(map(str, utility.limits))
                logger.warning("nothing feasible for '%s' meets %s: priorities decide", action.action, limits)
        return best

    def _kept_designs(self, open_functions: set[str]) -> dict[str, str]:
        """By function, the designs that are decided, or selected and not to be decided on here."""
        adaptable = frozenset(self._kb.adaptable_functions())
        kept: dict[str, str] = {}
        for alternatives in self._known.values():
            for function in alternatives.functions:
                selected = self._kb.selected_function_design(function)
                if function not in open_functions and function not in adaptable and selected is not None:
                    kept[function] = selected
        return {**kept, **self._designs}

    def _running(self, kept: Mapping[str, str]) -> set[str]:
        """The components of the designs that are kept."""
        return {component for function, design in kept.items() for component in self._parts(function, design)}

    def _parts(self, function: str, design: str) -> tuple[str, ...]:
        for alternatives in self._known.values():
            for option in alternatives.functions.get(function, ()):
                if option.name == design:
                    return option.components
        return ()


def _current_design(kb: KnowledgeBase, function: str) -> str | None:
    """The design that solves the function now."""
    solved = kb.status(ElementKind.FUNCTION, function) is Status.SOLVED
    return kb.selected_function_design(function) if solved else None


def _current_configuration(kb: KnowledgeBase, component: str) -> str | None:
    """The configuration that the component, which is solved, runs with now."""
    solved = kb.status(ElementKind.COMPONENT, component) is Status.SOLVED
    return kb.selected_component_configuration(component) if solved else None


def _best(candidates: Iterable[str], priority: Callable[[str], float | None], current: str | None) -> str | None:
    """The candidate with the lowest priority number; ties go to the current choice, then by declaration."""

    def rank(name: str) -> tuple[float, bool]:
        number = priority(name)
        return (math.inf if number is None else number, name != current)

    return min(candidates, key=rank, default=None)
