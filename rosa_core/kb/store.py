"""What holds the run-time state and keeps it whole: transactions, the journal, subscribers, locks."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from os import PathLike
from types import TracebackType
from typing import TYPE_CHECKING, Self

from rosa_core.clock import Clock, WallClock
from rosa_core.errors import (
    KnowledgeBaseClosedError,
    KnowledgeBaseError,
)
from rosa_core.inference.network import (
    ActionNode,
    ComponentNode,
    ConfigurationNode,
    DesignNode,
    FunctionNode,
    MeasureNode,
    Node,
)
from rosa_core.inference.reasoner import Reasoner
from rosa_core.journal.options import JournalOptions
from rosa_core.kb.dispatcher import (
    Dispatcher,
    DispatchName,
    ErrorHandler,
    Subscriber,
    log_subscriber_error,
    make_dispatcher,
)
from rosa_core.kb.events import Event, StatusesChanged
from rosa_core.kb.history import History
from rosa_core.kb.lookup import find, kind_of
from rosa_core.kb.state import RuntimeState
from rosa_core.kb.transaction import BEGINNING, Savepoint, Transaction
from rosa_core.model.elements import ElementKind
from rosa_core.model.knowledge_model import KnowledgeModel

if TYPE_CHECKING:
    from rosa_core.journal.journal import Journal


class KnowledgeStore:
    """The state of a knowledge base, and how it is written and read by several threads.

    :class:`~rosa_core.kb.knowledge_base.KnowledgeBase` is what people use.
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
            from rosa_core.kb.restoring import open_journal

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

    def __enter__(self) -> Self:
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

    def transaction(self) -> AbstractContextManager[object]:
        """Several writes as one: all of them happen and are announced together, or, if the block raises, none.

        A transaction within a transaction that raises takes back only what it did itself.
        """
        return _Scope(self, can_be_taken_back=True)

    def _write(self) -> AbstractContextManager[Transaction]:
        """One write: inside the transaction that is open, or one of its own. Validate before changing anything."""
        return _Scope(self, can_be_taken_back=False)

    def _begin(self) -> Transaction:
        if self._closed or (self._closing and not self._dispatcher.is_delivering()):
            raise KnowledgeBaseClosedError("the knowledge base is closed: nothing is written to it any more")
        self._open_transaction = transaction = Transaction()
        self._transaction_is_open = True
        return transaction

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

    # -- finding nodes --

    def _node(self, kind: ElementKind | str, name: str) -> Node:
        known = kind_of(kind)
        return find(self._reasoner.of_kind(known), known, name)

    def _measure(self, name: str) -> MeasureNode:
        return find(self._reasoner.measures, ElementKind.MEASURE, name)

    def _action(self, name: str) -> ActionNode:
        return find(self._reasoner.actions, ElementKind.ACTION, name)

    def _function(self, name: str) -> FunctionNode:
        return find(self._reasoner.functions, ElementKind.FUNCTION, name)

    def _component(self, name: str) -> ComponentNode:
        return find(self._reasoner.components, ElementKind.COMPONENT, name)

    def _design(self, name: str) -> DesignNode:
        return find(self._reasoner.designs, ElementKind.FUNCTION_DESIGN, name)

    def _configuration(self, name: str) -> ConfigurationNode:
        return find(self._reasoner.configurations, ElementKind.COMPONENT_CONFIGURATION, name)


class _Scope:
    """A transaction, or a part of the one that is open.

    Args:
        store: what is written to.
        can_be_taken_back: by itself, when it is part of another and raises; that costs a savepoint.
    """

    # Not a generator with @contextmanager: every measurement goes through here.
    __slots__ = ("_can_be_taken_back", "_is_outermost", "_savepoint", "_store")

    def __init__(self, store: KnowledgeStore, *, can_be_taken_back: bool) -> None:
        self._store = store
        self._can_be_taken_back = can_be_taken_back
        self._savepoint: Savepoint | None = None
        self._is_outermost = False

    def __enter__(self) -> Transaction:
        store = self._store
        store._lock.acquire()
        try:
            if not store._transaction_is_open:
                transaction = store._begin()
                self._is_outermost = True
                self._savepoint = BEGINNING
                return transaction
            if self._can_be_taken_back:
                self._savepoint = store._open_transaction.savepoint()
            return store._open_transaction
        except BaseException:
            store._lock.release()
            raise

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        store = self._store
        try:
            self._end(store._open_transaction, succeeded=kind is None)
        finally:
            if self._is_outermost:
                store._transaction_is_open = False
            store._lock.release()
        if self._is_outermost and kind is None:
            store._dispatcher.deliver()

    def _end(self, transaction: Transaction, *, succeeded: bool) -> None:
        store = self._store
        try:
            if succeeded:
                store._reasoner.infer()
                if self._is_outermost:
                    store._commit(transaction)
        except BaseException:
            if self._is_outermost:
                store._state.roll_back(transaction, BEGINNING)
            raise
        if not succeeded and self._savepoint is not None:
            store._state.roll_back(transaction, self._savepoint)
