"""What can be asked of a knowledge base; nothing here changes it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

from rosa_core.choice.action_alternatives import alternatives_of, decision_notes
from rosa_core.choice.configurations import Alternatives, CompleteConfiguration, complete_configurations
from rosa_core.choice.utility import Utility
from rosa_core.inference.explanation import Explanation, explain
from rosa_core.inference.remedies import find_remedy
from rosa_core.inference.rules import is_selectable
from rosa_core.inference.status import Status
from rosa_core.kb import reconfiguration
from rosa_core.kb.events import Measurement, ReconfigurationPlan, RequiredAction
from rosa_core.kb.history import HistoryEntry
from rosa_core.kb.lookup import kind_of, names_of
from rosa_core.kb.store import KnowledgeStore
from rosa_core.model.elements import ComponentType, Constraint, ElementKind, ParameterValue


class KnowledgeQuestions(KnowledgeStore):
    """The reading half of a knowledge base."""

    # -- what is so --

    def measurement(self, measure: str) -> Measurement | None:
        """The latest measurement of a measure, None before the first."""
        with self._lock:
            node = self._measure(measure)
            if node.value is None or node.time is None:
                return None
            return Measurement(measure, node.value, node.time)

    def is_component_active(self, name: str) -> bool:
        """Whether the component runs, as far as is known."""
        with self._lock:
            return self._component(name).active

    def component_type(self, name: str) -> ComponentType:
        """What kind of thing a component is."""
        with self._lock:
            return self._component(name).element.type

    def configured_component(self, configuration: str) -> str:
        """The component that a configuration is for."""
        with self._lock:
            return self._configuration(configuration).component.name

    def component_parameters(self, configuration: str) -> dict[str, ParameterValue]:
        """The parameters of a configuration by key (``~/component_parameters/get``); empty if it has none."""
        with self._lock:
            return {p.key: p.value for p in self._configuration(configuration).element.parameters}

    # -- task layer --

    def selectable_actions(self) -> list[str]:
        """The actions that may be chosen: those not unfeasible (``~/action/selectable``)."""
        with self._lock:
            return [node.name for node in self._reasoner.actions.values() if is_selectable(node.status)]

    def is_action_feasible(self, name: str) -> bool:
        """Whether the action may be chosen (true unless it is unfeasible)."""
        with self._lock:
            return self._action(name).status is not Status.UNFEASIBLE

    def required_actions(self) -> list[RequiredAction]:
        """The actions that are to be performed now, in order of request."""
        with self._lock:
            return list(self._state.required.values())

    # -- elements --

    # -- questions --

    def status(self, kind: ElementKind | str, name: str) -> Status:
        """The status of an action, function, component, function design or component configuration."""
        with self._lock:
            return self._node(kind, name).status

    def statuses(self, kind: ElementKind | str) -> dict[str, Status]:
        """The statuses of all elements of a kind, in order of declaration."""
        with self._lock:
            return {name: node.status for name, node in self._reasoner.of_kind(kind_of(kind)).items()}

    def constraints(self) -> list[tuple[Constraint, Status]]:
        """All constraints, in order of declaration, with their statuses."""
        with self._lock:
            return [(node.constraint, node.status) for node in self._reasoner.constraints]

    def explain(self, kind: ElementKind | str, name: str) -> Explanation:
        """Why an element has its status, down to measurements and their times; print it for a short tree.

        For what is unfeasible or failed, ``remedies`` say what would have to change.
        """
        with self._lock:
            node = self._node(kind, name)
            notes = decision_notes(self._state.required.get(name), node, self._reasoner.estimations_of)
            return replace(explain(self._reasoner, node), notes=notes, remedy=find_remedy(self._reasoner, node))

    def why(self, kind: ElementKind | str, name: str) -> str:
        """The summary of :meth:`explain` alone, at a part of its cost: for whoever asks at every tick."""
        with self._lock:
            return explain(self._reasoner, self._node(kind, name)).summary

    def history(self, topic: str, name: str | None = None, *, limit: int | None = None) -> tuple[HistoryEntry, ...]:
        """What happened, oldest first.

        Args:
            topic: ``measurements``, ``statuses``, ``required_actions`` (those that ended) or
                ``reconfiguration_plans`` (those that ended).
            name: only what concerns this measure, element or action.
            limit: the latest so many; what is older than memory holds is read from the journal, if there is one. By
                default, all that memory holds.

        Raises:
            InvalidValueError: if there is no such topic, or the limit is negative.
            JournalError: if the journal has been damaged or removed.
        """
        with self._lock:
            entries = self._history.of(topic, name, limit)
        if limit is None or len(entries) == limit or self._journal is None:
            return entries
        older = self._journal.entries(topic, name, limit)
        return tuple(older) if len(older) > len(entries) else entries

    def query(self, text: str) -> list[dict[str, Any]]:
        """What a TypeQL read query finds among stored and inferred facts (``~/query``); rows are plain dictionaries.

        :mod:`rosa_typeql.query` says what can be asked, and what a row looks like.

        Raises:
            QueryError: if the query cannot be read, writes, asks for what is not known, or would take too long.
        """
        # The parser generator takes time to import, which only queries should cost.
        from rosa_typeql.query import PreparedQuery
        from rosa_typeql.run_time_view import snapshot

        prepared = PreparedQuery(text)
        with self._lock:
            facts = snapshot(self.model, self._state, self._history, prepared.types)
        return prepared.rows(facts)

    # -- configuration planning and execution --

    def pending_reconfiguration_plan(self) -> ReconfigurationPlan | None:
        """The latest plan, if it has no result yet (``~/reconfiguration_plan/get_latest``)."""
        with self._lock:
            return self._state.pending_plan

    def adaptable_functions(self) -> list[str]:
        """The functions whose design is to be chosen anew (``~/function/adaptable``)."""
        with self._lock:
            return names_of(self._reasoner.adaptable_functions)

    def adaptable_components(self, selected_designs: Iterable[str] = ()) -> list[str]:
        """The components whose configuration is to be chosen anew, and those of designs about to be selected."""
        with self._lock:
            nodes = set(self._reasoner.adaptable_components)
            for name in selected_designs:
                nodes.update(self._design(name).members)
            return names_of(nodes)

    def required_components(self, selected_designs: Iterable[str] = ()) -> list[str]:
        """The components that are required once these designs are selected instead of others of their functions."""
        with self._lock:
            designs = [self._design(name) for name in selected_designs]
            gone = reconfiguration.displaced_designs(self._reasoner, designs)
            kept = self._reasoner.selected_designs.difference(gone).union(designs)
            return names_of({member for design in kept for member in design.members})

    def components_to_reconfigure(self, names: Iterable[str]) -> list[str]:
        """Those of these components that a selected design needs and that do not run, or the other way round.

        Names that the model has no longer are left out.
        """
        with self._lock:
            components = self._reasoner.components
            nodes = [components[name] for name in names if name in components]
            return [n.name for n in nodes if (not n.active if n.required_by else n.active and bool(n.designs))]

    def selectable_function_designs(self, function: str) -> list[str]:
        """The designs of a function that may be chosen (``~/function_designs/selectable``)."""
        with self._lock:
            return [option.name for option in self._function(function).options if is_selectable(option.status)]

    def function_design_priority(self, name: str) -> float | None:
        """A design's priority; the lowest number is preferred, None comes last."""
        with self._lock:
            return self._design(name).element.priority

    def selectable_component_configurations(self, component: str) -> list[str]:
        """The configurations of a component that may be chosen (``~/component_configuration/selectable``)."""
        with self._lock:
            return [option.name for option in self._component(component).options if is_selectable(option.status)]

    def component_configuration_priority(self, name: str) -> float | None:
        """A configuration's priority; the lowest number is preferred, None comes last."""
        with self._lock:
            return self._configuration(name).element.priority

    def selected_function_design(self, function: str) -> str | None:
        """The design that solves a function now, if one is selected."""
        with self._lock:
            return next((option.name for option in self._function(function).options if option.selected), None)

    def selected_component_configuration(self, component: str) -> str | None:
        """The configuration that a component is to run with now, if one is selected."""
        with self._lock:
            return next((option.name for option in self._component(component).options if option.selected), None)

    def alternatives(self, action: str) -> Alternatives:
        """What can be chosen for an action now: feasible designs, feasible configurations, and their estimations."""
        with self._lock:
            return alternatives_of(self._action(action), self._reasoner.estimations_of)

    def configurations(self, action: str, utility: Utility | None = None) -> Iterator[CompleteConfiguration]:
        """The complete feasible configurations of an action as it is now, best first, found as they are asked for.

        The order is by utility, then by priorities and declaration (see :func:`complete_configurations`); without a
        utility, by the latter two. Those that do not meet the utility's limits are left out. An action that is
        unfeasible has none.

        Raises:
            UnknownElementError: if there is no such action or measure.
        """
        with self._lock:
            for measure in utility.measures if utility else ():
                self._measure(measure)
            alternatives = self.alternatives(action) if self.is_action_feasible(action) else None
        return iter(()) if alternatives is None else complete_configurations(alternatives, utility)
