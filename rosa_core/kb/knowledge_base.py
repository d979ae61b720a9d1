"""The knowledge base: the model, what is happening now, and what follows from both (ROSA paper, sections 5 and 6.2.1).

Its methods are the services of the paper's table 5. Every write is a transaction: validated, applied, inferred, then
announced. A write that is refused raises a :class:`~rosa_core.errors.KnowledgeBaseError` and changes nothing.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from os import PathLike
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from rosa_core.clock import Clock, WallClock
from rosa_core.errors import (
    InvalidValueError,
    KnowledgeBaseClosedError,
    KnowledgeBaseError,
    RequestRefusedError,
    UnknownElementError,
    nearest,
)
from rosa_core.kb import growth, reconfiguration
from rosa_core.kb.action_alternatives import alternatives_of, decision_notes
from rosa_core.kb.configurations import Alternatives, CompleteConfiguration, complete_configurations
from rosa_core.kb.dispatcher import (
    Dispatcher,
    DispatchName,
    ErrorHandler,
    Subscriber,
    log_subscriber_error,
    make_dispatcher,
)
from rosa_core.kb.events import Event, Measurement, ReconfigurationPlan, RequiredAction, StatusesChanged
from rosa_core.kb.explanation import Explanation, explain
from rosa_core.kb.history import History, HistoryEntry
from rosa_core.kb.journal_options import JournalOptions
from rosa_core.kb.network import (
    ActionNode,
    ComponentNode,
    ConfigurationNode,
    DesignNode,
    FunctionNode,
    MeasureNode,
    Node,
)
from rosa_core.kb.reasoner import Reasoner
from rosa_core.kb.remedies import find_remedy
from rosa_core.kb.rules import is_selectable
from rosa_core.kb.situation import Situation
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.status import Result, Status
from rosa_core.kb.transaction import BEGINNING, Transaction
from rosa_core.kb.utility import Utility
from rosa_core.model.elements import ComponentType, Constraint, ElementKind, ElementRef, ParameterValue
from rosa_core.model.growth import Element
from rosa_core.model.knowledge_model import KnowledgeModel

if TYPE_CHECKING:
    from rosa_core.kb.journal import Journal


class KnowledgeBase:
    """What a robot knows at run time.

    Any thread may read and write. Writes happen one after the other, and a reader sees none of them by half: it waits
    while another thread is in a transaction. Close it at the end, or use it as a context manager.

    Args:
        model: the design-time knowledge.
        clock: where times come from; by default the wall clock (seconds since the epoch).
        journal: a file in which every write is durable before it is announced; made if it is not there. If it is, the
            knowledge base goes on where the one that wrote it ended.
        journal_options: how to keep the journal.
        dispatch: how subscribers are called: ``synchronous``, in the thread that wrote, before the write returns;
            ``threads``, each in a thread of its own; or a dispatcher.
        history_length: how many entries of each topic :meth:`history` remembers.
        on_subscriber_error: called when a subscriber raises; by default that is logged.

    Raises:
        JournalError: if the journal is none, damaged, of another model, or in use.
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
        self._open_transaction = Transaction()
        self._transaction_is_open = False
        self._closing = self._closed = False
        self._lock = threading.RLock()
        self._journal: Journal | None = None
        if journal is None:
            self._state, self._revision = RuntimeState(model, self.clock), 0
        else:
            # Not needed without a journal, and SQLite takes its time to import.
            from rosa_core.kb.journal import open_journal

            options = JournalOptions() if journal_options is None else journal_options
            opened = open_journal(journal, model, options, self.clock, self._history)
            self._journal, self._state, self._revision = opened

    @property
    def model(self) -> KnowledgeModel:
        """The model as it is now, with everything added and removed at run time."""
        with self._lock:
            return self._state.model

    @property
    def _reasoner(self) -> Reasoner:
        return self._state.reasoner

    def close(self, timeout: float = 10.0) -> None:
        """Deliver what has been announced, and end: from now on writes are refused, and what is known can be read.

        Closing it again does nothing. Until everything is delivered, subscribers may still write: what they do about
        the last writes belongs to those.

        Args:
            timeout: how long to wait for subscribers (seconds); after that, what they have not heard is dropped.

        Raises:
            KnowledgeBaseError: within a transaction.
        """
        with self._lock:
            if self._transaction_is_open:
                raise KnowledgeBaseError(
                    "the knowledge base cannot be closed within a transaction; close it after that"
                )
            if self._closed:
                return
            self._closing = True
        self._dispatcher.drain(timeout)
        with self._lock:
            if not self._closed and self._journal is not None:
                self._journal.close(self._state, self._revision, self.clock.now())
            self._closed = True
        self._dispatcher.close(timeout)

    def __enter__(self) -> KnowledgeBase:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    # -- transactions and events --

    @property
    def revision(self) -> int:
        """How many writes have changed something."""
        with self._lock:
            return self._revision

    def subscribe(self, callback: Subscriber, event_types: Iterable[type[Event]] | None = None) -> Callable[[], None]:
        """Call ``callback`` with every event after it was written, or with those of some types (``~/events``).

        Returns:
            a function that ends the subscription.
        """
        return self._dispatcher.subscribe(callback, event_types)

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """Several writes as one: all of them happen and are announced together, or, if the block raises, none.

        A transaction within a transaction that raises takes back only what it did itself.
        """
        with self._lock:
            if self._transaction_is_open:
                savepoint = self._open_transaction.savepoint()
                try:
                    yield
                except BaseException:
                    self._state.roll_back(self._open_transaction, savepoint)
                    raise
                return
            if self._closed or (self._closing and not self._dispatcher.is_delivering()):
                raise KnowledgeBaseClosedError("the knowledge base is closed: nothing is written to it any more")
            self._open_transaction = transaction = Transaction()
            self._transaction_is_open = True
            try:
                yield
                self._commit(transaction)
            except BaseException:
                self._state.roll_back(transaction, BEGINNING)
                raise
            finally:
                self._transaction_is_open = False
        self._dispatcher.deliver()

    def _commit(self, transaction: Transaction) -> None:
        now = self.clock.now()
        events = list(transaction.events(self._revision + 1, now, self._reasoner))
        revision = self._revision + 1 if events else self._revision
        if self._journal is not None and transaction.facts:
            changes = next((event.changes for event in events if isinstance(event, StatusesChanged)), ())
            self._journal.append(revision, now, transaction.facts, changes)
        # From here on the write stands, whatever happens.
        transaction.undo.clear()
        self._revision = revision
        self._history.record(events)
        self._dispatcher.announce(events)
        if self._journal is not None:
            self._journal.keep_up(self._state, revision, now)

    @contextmanager
    def _write(self) -> Iterator[Transaction]:
        """One write: inside the transaction that is open, or one of its own."""
        with self._lock:
            if self._transaction_is_open:
                yield self._open_transaction
                self._reasoner.infer()
                return
        with self.transaction():
            yield self._open_transaction
            self._reasoner.infer()

    # -- monitoring --

    def add_measurement(self, measure: str, value: float, time: float | None = None) -> None:
        """A measure was measured at a time (seconds; now by default). The latest measurement counts.

        Raises:
            UnknownElementError: if there is no such measure.
            InvalidValueError: if the value or time is not a finite number.
        """
        taken = self.clock.now() if time is None else time
        with self._write() as tx:
            node = self._measure(measure)
            value = _finite(value, f"a measurement of {measure}")
            self._state.measure(tx, node, value, _finite(taken, "the time of a measurement"))

    def measurement(self, measure: str) -> Measurement | None:
        """The latest measurement of a measure, None before the first."""
        with self._lock:
            node = self._measure(measure)
            if node.value is None or node.time is None:
                return None
            return Measurement(measure, node.value, node.time)

    def set_component_failure(self, name: str, time: float | None = None) -> None:
        """A component failed (at a time in seconds; now by default). A failure does not stop it from being active."""
        since = self.clock.now() if time is None else time
        with self._write() as tx:
            component = self._component(name)
            self._state.set_failure(tx, component, _finite(since, "the time of a failure"))

    def clear_component_failure(self, name: str) -> None:
        """A component works again."""
        with self._write() as tx:
            self._state.set_failure(tx, self._component(name), None)

    # -- task layer --

    def request_action(
        self, name: str, preference: str | None = None, utility: Utility | None = None
    ) -> RequiredAction:
        """The action is to be performed (``~/action/request``). If it already is, nothing changes.

        Args:
            name: the action.
            preference: the measure of which the estimated configuration is to have as much as possible.
            utility: weights and limits on estimated measures, instead of a preference.

        Raises:
            UnknownElementError: if there is no such action or measure.
            InvalidValueError: if both a preference and a utility are given.
            RequestRefusedError: if the action is unfeasible; the message says why.
        """
        if preference is not None and utility is not None:
            raise InvalidValueError("give a preference or a utility: a preference is the utility with weight 1 on it")
        with self._write() as tx:
            action = self._action(name)
            for measure in (preference,) if preference is not None else utility.measures if utility else ():
                self._measure(measure)
            if not action.required and action.status is Status.UNFEASIBLE:
                why = explain(self._reasoner, action).summary
                raise RequestRefusedError(f"the request is refused: {why}")
            return self._state.require(tx, action, preference, utility)

    def cancel_action(self, name: str) -> RequiredAction | None:
        """The action is no longer to be performed; its result is ``abandoned``. None if it was not required."""
        with self._write() as tx:
            return self._state.end_action(tx, self._action(name), Result.ABANDONED)

    def finish_action(self, name: str, result: Result | str = Result.COMPLETED) -> RequiredAction | None:
        """The action was ``completed`` or has ``failed``. None if it was not required."""
        with self._write() as tx:
            return self._state.end_action(tx, self._action(name), _result(result))

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

    # -- configuration planning --

    def adaptable_functions(self) -> list[str]:
        """The functions whose design is to be chosen anew (``~/function/adaptable``)."""
        with self._lock:
            return _names(self._reasoner.adaptable_functions)

    def adaptable_components(self, selected_designs: Iterable[str] = ()) -> list[str]:
        """The components whose configuration is to be chosen anew, and those of designs about to be selected."""
        with self._lock:
            nodes = set(self._reasoner.adaptable_components)
            for name in selected_designs:
                nodes.update(self._design(name).members)
            return _names(nodes)

    def required_components(self, selected_designs: Iterable[str] = ()) -> list[str]:
        """The components that are required once these designs are selected instead of others of their functions."""
        with self._lock:
            designs = [self._design(name) for name in selected_designs]
            gone = reconfiguration.displaced_designs(self._reasoner, designs)
            kept = self._reasoner.selected_designs.difference(gone).union(designs)
            return _names({member for design in kept for member in design.members})

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
            return alternatives_of(self._action(action), self.model)

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

    def select_configuration(
        self, function_designs: Iterable[str], component_configurations: Iterable[str]
    ) -> ReconfigurationPlan | None:
        """Select designs and configurations, and plan how to get there (``~/select_configuration``).

        Others of the same functions and components are unselected, and so are those that nothing requires any more.
        A plan that is still pending is abandoned, unless the new one would do just the same. The work of a plan that
        failed is not planned again before a failure is cleared or something else is to be done.

        Returns:
            the pending plan, or None if there is nothing to reconfigure.

        Raises:
            UnknownElementError, InvalidValueError: for unknown names, or two choices for one function or component.
        """
        with self._write() as tx:
            designs = [self._design(name) for name in dict.fromkeys(function_designs)]
            configurations = [self._configuration(name) for name in dict.fromkeys(component_configurations)]
            reconfiguration.check_one_each(designs, configurations)
            return self._state.select(tx, designs, configurations)

    # -- execution --

    def pending_reconfiguration_plan(self) -> ReconfigurationPlan | None:
        """The latest plan, if it has no result yet (``~/reconfiguration_plan/get_latest``)."""
        with self._lock:
            return self._state.pending_plan

    def set_reconfiguration_result(self, plan: ReconfigurationPlan, result: Result | str) -> bool:
        """How the plan ended (``~/reconfiguration_plan/result/set``). False if it had already ended."""
        ended = _result(result)
        with self._write() as tx:
            pending = self._state.pending_plan
            if pending is None or plan.id != pending.id:
                return False
            adapted = plan.parameter_adaptations if ended is Result.COMPLETED else ()
            self._state.end_plan(tx, ended, [self._configuration(name) for name in adapted])
            return True

    def set_component_active(self, name: str, active: bool) -> None:
        """The component runs now, or no longer (``~/component/active/set``)."""
        with self._write() as tx:
            self._state.set_active(tx, self._component(name), active)

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

    # -- questions --

    def status(self, kind: ElementKind | str, name: str) -> Status:
        """The status of an action, function, component, function design or component configuration."""
        with self._lock:
            return self._node(kind, name).status

    def statuses(self, kind: ElementKind | str) -> dict[str, Status]:
        """The statuses of all elements of a kind, in order of declaration."""
        with self._lock:
            return {name: node.status for name, node in self._reasoner.of_kind(_kind(kind)).items()}

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
            notes = decision_notes(self._state.required.get(name), node, self.model)
            return replace(explain(self._reasoner, node), notes=notes, remedy=find_remedy(self._reasoner, node))

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

        :mod:`rosa_core.kb.typeql_query` says what can be asked, and what a row looks like.

        Raises:
            QueryError: if the query cannot be read, writes, asks for what is not known, or would take too long.
        """
        # The parser generator takes time to import, which only queries should cost.
        from rosa_core.kb.fact_view import snapshot
        from rosa_core.kb.typeql_query import PreparedQuery

        prepared = PreparedQuery(text)
        with self._lock:
            facts = snapshot(self.model, self._state, self._history, prepared.types)
        return prepared.rows(facts)

    def suppose(self, situation: Situation) -> None:
        """Assert raw facts, for asking what would follow from them; requests are not refused.

        Raises:
            UnknownElementError, InvalidValueError: as the single writes do.
        """
        with self._write() as tx:
            now = self.clock.now()
            actions = [self._action(name) for name in situation.required_actions]
            designs = [self._design(name) for name in situation.selected_designs]
            configurations = [self._configuration(name) for name in situation.selected_configurations]
            active = [self._component(name) for name in situation.active_components]
            failed = [self._component(name) for name in situation.failed_components]
            measured = [
                (self._measure(name), _finite(value, f"a measurement of {name}"))
                for name, value in situation.measurements.items()
            ]
            for action in actions:
                self._state.require(tx, action)
            for design in designs:
                self._state.select_design(tx, design, True)
            for configuration in configurations:
                self._state.select_configuration(tx, configuration, True)
            for component in active:
                self._state.set_active(tx, component, True)
            for component in failed:
                self._state.set_failure(tx, component, now)
            for measure, value in measured:
                self._state.measure(tx, measure, value, now)

    # -- knowledge that grows --

    def add_elements(self, *elements: Element) -> None:
        """Add elements and relations to the model, behind those that it has.

        The cost is that of loading the model, whatever the number of elements: add those that belong together at once.

        Raises:
            KnowledgeChangeRefusedError: for dangling or double names, and whatever else makes a model file refused.
        """
        with self._write() as tx:
            growth.add_elements(self._state, tx, elements)

    def remove_elements(self, *elements: Element | ElementRef) -> None:
        """Remove elements and relations from the model; those that have a name may be given by reference.

        A selected design or configuration is unselected by it, a pending plan that names something removed abandoned,
        and the measurements and failures of what is removed are forgotten. To change an element, remove it and add it
        anew in one transaction. The cost is that of loading the model.

        Raises:
            KnowledgeChangeRefusedError: if there is no such element, if one that stays refers to it, or if it is a
                required action, its preference, or an active component.
        """
        with self._write() as tx:
            growth.remove_elements(self._state, tx, elements)

    # -- inside --

    def _node(self, kind: ElementKind | str, name: str) -> Node:
        known = _kind(kind)
        return _find(self._reasoner.of_kind(known), known, name)

    def _measure(self, name: str) -> MeasureNode:
        return _find(self._reasoner.measures, ElementKind.MEASURE, name)

    def _action(self, name: str) -> ActionNode:
        return _find(self._reasoner.actions, ElementKind.ACTION, name)

    def _function(self, name: str) -> FunctionNode:
        return _find(self._reasoner.functions, ElementKind.FUNCTION, name)

    def _component(self, name: str) -> ComponentNode:
        return _find(self._reasoner.components, ElementKind.COMPONENT, name)

    def _design(self, name: str) -> DesignNode:
        return _find(self._reasoner.designs, ElementKind.FUNCTION_DESIGN, name)

    def _configuration(self, name: str) -> ConfigurationNode:
        return _find(self._reasoner.configurations, ElementKind.COMPONENT_CONFIGURATION, name)


_N = TypeVar("_N")


def _find(group: Mapping[str, _N], kind: ElementKind, name: str) -> _N:
    """The node of that name, or the error that names the nearest one known."""
    try:
        return group[name]
    except (KeyError, TypeError):
        words = kind.value.replace("_", " ")
        mend = nearest(str(name), group)
        raise UnknownElementError(f"there is no {words} '{name}'" + (f"; {mend}" if mend else "")) from None


_STATUS_KINDS = tuple(kind for kind in ElementKind if kind not in (ElementKind.MEASURE, ElementKind.CONSTRAINT))


def _kind(kind: ElementKind | str) -> ElementKind:
    for known in _STATUS_KINDS:
        if kind == known:
            return known
    raise InvalidValueError(f"'{kind}' is not one of: {', '.join(_STATUS_KINDS)}")


def _finite(value: float, what: str) -> float:
    try:
        number = math.nan if isinstance(value, bool | str) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise InvalidValueError(f"{what} must be a finite number, not {_shown(value)}")
    return number


def _shown(value: object) -> str:
    try:
        return repr(value)[:60]
    except ValueError:  # an integer of thousands of digits
        return f"a {type(value).__name__} too large to print"


def _result(result: Result | str) -> Result:
    try:
        return Result(result)
    except ValueError:
        raise InvalidValueError(f"'{result}' is not one of: {', '.join(Result)}") from None


def _names(nodes: Iterable[Node]) -> list[str]:
    return [node.name for node in reconfiguration.declared_order(nodes)]
