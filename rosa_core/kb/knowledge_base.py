"""The knowledge base: the model, what is happening now, and what follows from both (ROSA paper, sections 5 and 6.2.1).

Its methods are the services of the paper's table 5. Every write is a transaction: validated, applied, inferred, then
announced. A write that is refused raises a :class:`~rosa_core.errors.KnowledgeBaseError` and changes nothing.

The parts are one for each concern: the *state* (the facts and the inference network), the *lookup* of its nodes by
name, the *history*, the *dispatcher* of events, the *journal*, and the *store*, which makes of writes transactions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import replace
from os import PathLike
from types import TracebackType
from typing import Any, Self

from rosa_core.choice import Alternatives, CompleteConfiguration, complete_configurations
from rosa_core.clock import Clock, WallClock
from rosa_core.errors import InvalidValueError, RequestRefusedError
from rosa_core.inference.explanation import Explanation, explain
from rosa_core.inference.remedies import find_remedy
from rosa_core.inference.rules import is_selectable
from rosa_core.journal.options import JournalOptions
from rosa_core.kb import growth, reconfiguration
from rosa_core.kb.action_alternatives import alternatives_of, decision_notes
from rosa_core.kb.dispatcher import (
    Dispatcher,
    DispatchName,
    ErrorHandler,
    Subscriber,
    log_subscriber_error,
    make_dispatcher,
)
from rosa_core.kb.events import Event
from rosa_core.kb.history import History
from rosa_core.kb.lookup import Lookup, kind_of, names_of, result_of
from rosa_core.kb.query_port import answer
from rosa_core.kb.situation import Situation, assert_situation
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.store import Store
from rosa_core.model.changes import Element
from rosa_core.model.elements import ComponentType, Constraint, ElementKind, ElementRef, ParameterValue
from rosa_core.model.knowledge_model import KnowledgeModel
from rosa_core.model.numbers import finite
from rosa_core.model.records import HistoryEntry, Measurement, ReconfigurationPlan, RequiredAction
from rosa_core.model.status import Result, Status
from rosa_core.model.utility import Utility


class KnowledgeBase:
    """What a robot knows at run time.

    Any thread may read and write. Writes happen one after the other, and a reader sees none of them by half: it waits
    while another thread is in a transaction. Close it at the end, or use it as a context manager.

    Unless it says otherwise, a method that takes the name of an element raises an ``UnknownElementError``, with the
    nearest name known, if there is no such element. Times are in seconds of the clock.

    Args:
        model: the design-time knowledge.
        clock: where times come from; by default the wall clock (seconds since the epoch).
        journal: a file in which every write is durable before it is announced; made if it is not there. If it is, the
            knowledge base goes on where the one that wrote it ended.
        journal_options: how to keep the journal.
        dispatch: how subscribers are called: ``synchronous``, in the thread that wrote, before the write returns;
            ``threads``, each in a thread of its own; or a dispatcher.
        history_length: how many entries of each topic :meth:`history` keeps in memory.
        on_subscriber_error: called when a subscriber raises; by default that is logged.

    Raises:
        JournalError: if the journal is none, damaged, of another model, or in use.

    Example:
        >>> from rosa_core import KnowledgeBase, KnowledgeModel, SimulationClock
        >>> from rosa_core.model import Action, Constraint, ElementKind, ElementRef, Measure
        >>> enough_charge = Constraint("battery", ElementRef(ElementKind.ACTION, "fly"), value=0.2)
        >>> model = KnowledgeModel((Measure("battery"),), (Action("fly"),), constraints=(enough_charge,))
        >>> kb = KnowledgeBase(model, SimulationClock())
        >>> kb.is_action_feasible("fly")
        True
        >>> kb.add_measurement("battery", 0.1)
        >>> kb.status("action", "fly")
        <Status.UNFEASIBLE: 'unfeasible'>
        >>> kb.why("action", "fly")
        'fly is unfeasible: battery 0.1 (measured at 0.0 s) violates >= 0.2'
    """

    def __init__(
        self,
        model: KnowledgeModel,
        clock: Clock | None = None,
        journal: str | PathLike[str] | None = None,
        *,
        journal_options: JournalOptions | None = None,
        dispatch: DispatchName | Dispatcher = "synchronous",
        history_length: int = 10_000,
        on_subscriber_error: ErrorHandler = log_subscriber_error,
    ) -> None:
        self.clock: Clock = WallClock() if clock is None else clock
        self._history = History(history_length)
        self._dispatcher = make_dispatcher(dispatch, on_subscriber_error)
        self._journal, self._state, revision = None, RuntimeState(model, self.clock), 0
        if journal is not None:
            # Not needed without a journal, and SQLite is slow to import.
            from rosa_core.kb.restoring import open_journal

            options = JournalOptions() if journal_options is None else journal_options
            self._journal, self._state, revision = open_journal(journal, model, options, self.clock, self._history)
        self._lookup = Lookup(self._state)
        self._store = Store(self._state, self.clock, self._dispatcher, self._history, self._journal, revision)
        self._lock = self._store.lock

    def close(self, timeout: float = 10.0) -> None:
        """Deliver what has been announced, and end: from now on writes are refused, and what is known can be read.

        Closing it again does nothing. Until everything is delivered, subscribers may still write: what they do about
        the last writes belongs to those.

        Args:
            timeout: how long to wait for subscribers (seconds); after that, what they have not received is dropped.

        Raises:
            KnowledgeBaseError: within a transaction.
        """
        self._store.close(timeout)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    # -- transactions and events --

    @property
    def model(self) -> KnowledgeModel:
        """The model as it is now, with everything added and removed at run time."""
        with self._lock:
            return self._state.model

    @property
    def revision(self) -> int:
        """How many writes have changed something."""
        with self._lock:
            return self._store.revision

    def subscribe(self, callback: Subscriber, event_types: Iterable[type[Event]] | None = None) -> Callable[[], None]:
        """Call a function with every event after it was written (``~/events``).

        Args:
            callback: called with one event at a time, in the order of the writes. It may read and write.
            event_types: only events of exactly these types; by default all.

        Returns:
            a function that ends the subscription.
        """
        return self._dispatcher.subscribe(callback, event_types)

    def transaction(self) -> AbstractContextManager[object]:
        """Several writes as one: all of them happen and are announced together, or, if the block raises, none.

        A transaction within a transaction that raises takes back only what it did itself.
        """
        return self._store.transaction()

    # -- monitoring --

    def add_measurement(self, measure: str, value: float, time: float | None = None) -> None:
        """A measure was measured. The latest measurement counts; one that was taken earlier goes into the history.

        Args:
            measure: its name.
            value: in the measure's unit.
            time: when it was taken, in seconds; now by default.

        Raises:
            UnknownElementError: if there is no such measure.
            InvalidValueError: if the value or time is not a finite number.
        """
        taken = self.clock.now() if time is None else time
        with self._store.write() as tx:
            node = self._lookup.measure(measure)
            value = finite(value, f"a measurement of {measure}")
            self._state.measure(tx, node, value, finite(taken, "the time of a measurement"))

    def set_component_failure(self, name: str, time: float | None = None) -> None:
        """A component failed. That does not stop it from being active.

        Args:
            name: the component.
            time: since when, in seconds; now by default.

        Raises:
            UnknownElementError: if there is no such component.
            InvalidValueError: if the time is not a finite number.
        """
        since = self.clock.now() if time is None else time
        with self._store.write() as tx:
            component = self._lookup.component(name)
            self._state.set_failure(tx, component, finite(since, "the time of a failure"))

    def clear_component_failure(self, name: str) -> None:
        """A component works again."""
        with self._store.write() as tx:
            self._state.set_failure(tx, self._lookup.component(name), None)

    def measurement(self, measure: str) -> Measurement | None:
        """The latest measurement of a measure, None before the first."""
        with self._lock:
            node = self._lookup.measure(measure)
            if node.value is None or node.time is None:
                return None
            return Measurement(measure, node.value, node.time)

    # -- task layer --

    def request_action(
        self, name: str, preference: str | None = None, utility: Utility | None = None
    ) -> RequiredAction:
        """The action is to be performed (``~/action/request``). If it already is, nothing changes.

        Args:
            name: the action.
            preference: the measure of which the estimated configuration is to have as much as possible.
            utility: weights and limits on estimated measures, instead of a preference.

        Returns:
            the action with the time from which it is required.

        Raises:
            UnknownElementError: if there is no such action or measure.
            InvalidValueError: if both a preference and a utility are given.
            RequestRefusedError: if the action is unfeasible; the message says why.
        """
        if preference is not None and utility is not None:
            raise InvalidValueError("give a preference or a utility: a preference is the utility with weight 1 on it")
        with self._store.write() as tx:
            action = self._lookup.action(name)
            for measure in (preference,) if preference is not None else utility.measures if utility else ():
                self._lookup.measure(measure)
            if not action.required and action.status is Status.UNFEASIBLE:
                why = explain(self._state.reasoner, action).summary
                raise RequestRefusedError(f"the request is refused: {why}")
            return self._state.require(tx, action, preference, utility)

    def cancel_action(self, name: str) -> RequiredAction | None:
        """The action is no longer to be performed.

        Returns:
            the required action with its end and the result ``abandoned``; None if it was not required.

        Raises:
            UnknownElementError: if there is no such action.
        """
        with self._store.write() as tx:
            return self._state.end_action(tx, self._lookup.action(name), Result.ABANDONED)

    def finish_action(self, name: str, result: Result | str = Result.COMPLETED) -> RequiredAction | None:
        """The action has ended by itself.

        Args:
            name: the action.
            result: ``completed`` or ``failed``.

        Returns:
            the required action with its end and result; None if it was not required.

        Raises:
            UnknownElementError: if there is no such action.
            InvalidValueError: if there is no such result.
        """
        with self._store.write() as tx:
            return self._state.end_action(tx, self._lookup.action(name), result_of(result))

    def required_actions(self) -> list[RequiredAction]:
        """The actions that are to be performed now, in order of request."""
        with self._lock:
            return list(self._state.required.values())

    def selectable_actions(self) -> list[str]:
        """The actions that may be chosen: those not unfeasible (``~/action/selectable``)."""
        with self._lock:
            return [node.name for node in self._state.reasoner.actions.values() if is_selectable(node.status)]

    def is_action_feasible(self, name: str) -> bool:
        """Whether the action may be chosen (true unless it is unfeasible)."""
        with self._lock:
            return self._lookup.action(name).status is not Status.UNFEASIBLE

    # -- statuses, reasons, history --

    def status(self, kind: ElementKind | str, name: str) -> Status:
        """The status of an element (ROSA paper, figure 3).

        Args:
            kind: ``action``, ``function``, ``component``, ``function_design`` or ``component_configuration``.
            name: names are unique only within a kind.

        Raises:
            InvalidValueError: if there is no such kind.
            UnknownElementError: if there is no such element.
        """
        with self._lock:
            return self._lookup.node(kind, name).status

    def statuses(self, kind: ElementKind | str) -> dict[str, Status]:
        """The statuses of all elements of a kind, in order of declaration."""
        with self._lock:
            return {name: node.status for name, node in self._state.reasoner.of_kind(kind_of(kind)).items()}

    def constraints(self) -> list[tuple[Constraint, Status]]:
        """All constraints, in order of declaration, with their statuses."""
        with self._lock:
            return [(node.constraint, node.status) for node in self._state.reasoner.constraints]

    def explain(self, kind: ElementKind | str, name: str) -> Explanation:
        """Why an element has its status, down to measurements and their times; print it for a short tree.

        Args:
            kind: as in :meth:`status`.
            name: the element.

        Returns:
            the rule that applied and the facts that it applied to. For what is unfeasible or failed, ``remedies`` say
            what would have to change.

        Raises:
            InvalidValueError, UnknownElementError: as in :meth:`status`.
        """
        with self._lock:
            reasoner, node = self._state.reasoner, self._lookup.node(kind, name)
            required = self._state.required.get(name)
            notes = decision_notes(required.decided_by if required else None, node, reasoner.estimations_of)
            return replace(explain(reasoner, node), notes=notes, remedy=find_remedy(reasoner, node))

    def why(self, kind: ElementKind | str, name: str) -> str:
        """The summary of :meth:`explain` alone, at a part of its cost: for conditions that ask at every tick.

        Args:
            kind: as in :meth:`status`.
            name: the element.
        """
        with self._lock:
            return explain(self._state.reasoner, self._lookup.node(kind, name)).summary

    def history(self, topic: str, name: str | None = None, *, limit: int | None = None) -> tuple[HistoryEntry, ...]:
        """What happened, oldest first.

        Args:
            topic: ``measurements``, ``statuses``, ``required_actions`` (those that ended) or
                ``reconfiguration_plans`` (those that ended).
            name: only what concerns this measure, element or action; nothing, if it is unknown.
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

        The package ``rosa_typeql`` answers, and says what can be asked and what a row looks like.

        Raises:
            QueryError: if the query cannot be read, writes, asks for what is not known, or would take too long; or if
                ``rosa_typeql`` is not there.
        """
        return answer(text, self._state, self._history, self._lock)

    # -- configuration planning --

    def select_configuration(
        self, function_designs: Iterable[str], component_configurations: Iterable[str]
    ) -> ReconfigurationPlan | None:
        """Select designs and configurations, and plan how to get there (``~/select_configuration``).

        Others of the same functions and components are unselected, and so are those that nothing requires any more.
        A plan that is still pending is abandoned, unless the new one would do just the same. The work of a plan that
        failed is not planned again before a failure is cleared or something else is to be done.

        Args:
            function_designs: names, at most one design of each function.
            component_configurations: names, at most one configuration of each component.

        Returns:
            the pending plan, or None if there is nothing to reconfigure.

        Raises:
            UnknownElementError, InvalidValueError: for unknown names, or two choices for one function or component.
        """
        with self._store.write() as tx:
            designs = [self._lookup.design(name) for name in dict.fromkeys(function_designs)]
            configurations = [self._lookup.configuration(name) for name in dict.fromkeys(component_configurations)]
            reconfiguration.check_one_each(designs, configurations)
            return self._state.select(tx, designs, configurations)

    def replan(self) -> ReconfigurationPlan | None:
        """Make the reconfiguration plan again, from what is selected and how the robot runs now.

        What nothing requires any more is unselected; else the selection stays. As with :meth:`select_configuration`, a
        pending plan that would do just the same stays, and what failed is not planned again for now.

        Returns:
            the pending plan, or None if there is nothing to reconfigure.
        """
        with self._store.write() as tx:
            return self._state.select(tx, [], [])

    def adaptable_functions(self) -> list[str]:
        """The functions whose design is to be chosen again (``~/function/adaptable``)."""
        with self._lock:
            return names_of(self._state.reasoner.adaptable_functions)

    def adaptable_components(self, selected_designs: Iterable[str] = ()) -> list[str]:
        """The components whose configuration is to be chosen again, and those of designs about to be selected."""
        with self._lock:
            nodes = set(self._state.reasoner.adaptable_components)
            for name in selected_designs:
                nodes.update(self._lookup.design(name).members)
            return names_of(nodes)

    def required_components(self, selected_designs: Iterable[str] = ()) -> list[str]:
        """The components that are required once these designs are selected instead of others of their functions."""
        with self._lock:
            designs = [self._lookup.design(name) for name in selected_designs]
            displaced = reconfiguration.displaced_designs(self._state.reasoner, designs)
            kept = self._state.reasoner.selected_designs.difference(displaced).union(designs)
            return names_of({member for design in kept for member in design.members})

    def components_to_reconfigure(self, names: Iterable[str]) -> list[str]:
        """Those of these components that a selected design needs and that do not run, or the other way round.

        Names that the model has no longer are left out.
        """
        with self._lock:
            components = self._state.reasoner.components
            nodes = [components[name] for name in names if name in components]
            return [n.name for n in nodes if (not n.active if n.required_by else n.active and bool(n.designs))]

    def selectable_function_designs(self, function: str) -> list[str]:
        """The designs of a function that may be chosen (``~/function_designs/selectable``)."""
        with self._lock:
            return [option.name for option in self._lookup.function(function).options if is_selectable(option.status)]

    def function_design_priority(self, name: str) -> float | None:
        """A design's priority (``~/function_designs/priority``); the lowest number is preferred, None comes last."""
        with self._lock:
            return self._lookup.design(name).element.priority

    def selectable_component_configurations(self, component: str) -> list[str]:
        """The configurations of a component that may be chosen (``~/component_configuration/selectable``)."""
        with self._lock:
            return [option.name for option in self._lookup.component(component).options if is_selectable(option.status)]

    def component_configuration_priority(self, name: str) -> float | None:
        """A configuration's priority (``~/component_configuration/priority``); lowest preferred, None comes last."""
        with self._lock:
            return self._lookup.configuration(name).element.priority

    def selected_function_design(self, function: str) -> str | None:
        """The design that solves a function now, if one is selected."""
        with self._lock:
            return next((option.name for option in self._lookup.function(function).options if option.selected), None)

    def selected_component_configuration(self, component: str) -> str | None:
        """The configuration that a component is to run with now, if one is selected."""
        with self._lock:
            return next((option.name for option in self._lookup.component(component).options if option.selected), None)

    def alternatives(self, action: str) -> Alternatives:
        """What can be chosen for an action now: feasible designs, feasible configurations, and their estimations."""
        with self._lock:
            return alternatives_of(self._lookup.action(action), self._state.reasoner.estimations_of)

    def configurations(self, action: str, utility: Utility | None = None) -> Iterator[CompleteConfiguration]:
        """The complete feasible configurations of an action as it is now, best first, found as they are asked for.

        The order is by utility, then by priorities and declaration (see :func:`complete_configurations`); without a
        utility, by the latter two. Those that do not meet the utility's limits are left out. An action that is
        unfeasible has none.

        Args:
            action: its name.
            utility: weights and limits; by default priorities decide.

        Raises:
            UnknownElementError: if there is no such action or measure.
        """
        with self._lock:
            for measure in utility.measures if utility else ():
                self._lookup.measure(measure)
            alternatives = self.alternatives(action) if self.is_action_feasible(action) else None
        return iter(()) if alternatives is None else complete_configurations(alternatives, utility)

    # -- execution --

    def pending_reconfiguration_plan(self) -> ReconfigurationPlan | None:
        """The latest plan, if it has no result yet (``~/reconfiguration_plan/get_latest``)."""
        with self._lock:
            return self._state.pending_plan

    def set_reconfiguration_result(self, plan: ReconfigurationPlan, result: Result | str) -> bool:
        """How a plan ended (``~/reconfiguration_plan/result/set``).

        Args:
            plan: the plan that was carried out.
            result: ``completed``, ``failed`` or ``abandoned``.

        Returns:
            False if it had already ended, such as by a newer plan; then nothing changes.

        Raises:
            InvalidValueError: if there is no such result.
        """
        ended = result_of(result)
        with self._store.write() as tx:
            pending = self._state.pending_plan
            if pending is None or plan.id != pending.id:
                return False
            adapted = plan.parameter_adaptations if ended is Result.COMPLETED else ()
            self._state.end_plan(tx, ended, [self._lookup.configuration(name) for name in adapted])
            return True

    def set_component_active(self, name: str, active: bool) -> None:
        """The component runs now, or no longer (``~/component/active/set``).

        Args:
            name: the component.
            active: whether it runs.

        Raises:
            UnknownElementError: if there is no such component.
        """
        with self._store.write() as tx:
            self._state.set_active(tx, self._lookup.component(name), active)

    def is_component_active(self, name: str) -> bool:
        """Whether the component runs, as far as is known."""
        with self._lock:
            return self._lookup.component(name).active

    def component_type(self, name: str) -> ComponentType:
        """What kind of part a component is: only nodes can be started and stopped."""
        with self._lock:
            return self._lookup.component(name).element.type

    def configured_component(self, configuration: str) -> str:
        """The component that a configuration is for."""
        with self._lock:
            return self._lookup.configuration(configuration).component.name

    def component_parameters(self, configuration: str) -> dict[str, ParameterValue]:
        """The parameters of a configuration by key (``~/component_parameters/get``); empty if it has none."""
        with self._lock:
            return {p.key: p.value for p in self._lookup.configuration(configuration).element.parameters}

    # -- what if --

    def suppose(self, situation: Situation) -> None:
        """Assert raw facts, for asking what would follow from them; requests are not refused.

        Raises:
            UnknownElementError, InvalidValueError: as the single writes do.
        """
        with self._store.write() as tx:
            assert_situation(situation, self._state, tx, self._lookup)

    @contextmanager
    def supposing(self, situation: Situation) -> Iterator[None]:
        """Inside the block, questions are answered as if these facts held; then everything is as it was.

        Nothing of it is announced, journalled or kept in the history, and neither is what the block itself writes.
        Other threads wait meanwhile.

        Raises:
            UnknownElementError, InvalidValueError: as the single writes do.
        """
        try:
            with self.transaction():
                self.suppose(situation)
                yield
                raise _TakeBackError
        except _TakeBackError:
            pass

    # -- knowledge that grows --

    def add_elements(self, *elements: Element) -> None:
        """Add elements and relations to the model, behind those that it has.

        The cost is that of the change, not of the model.

        Raises:
            KnowledgeChangeRefusedError: for dangling or double names, and whatever else makes a model file refused.
        """
        with self._store.write() as tx:
            growth.add_elements(self._state, tx, elements)

    def remove_elements(self, *elements: Element | ElementRef) -> None:
        """Remove elements and relations from the model; those that have a name may be given by reference.

        A selected design or configuration is unselected by it, a pending plan that names something removed abandoned,
        and the measurements and failures of what is removed are dropped. To change an element, remove it and add it
        again in one transaction. The cost is that of the change, not of the model.

        Raises:
            KnowledgeChangeRefusedError: if there is no such element, if one that stays refers to it, or if it is a
                required action, its preference, or an active component.
        """
        with self._store.write() as tx:
            growth.remove_elements(self._state, tx, elements)


class _TakeBackError(Exception):
    """Takes back what was only supposed."""
